"""People follow a guide: at its speed, along its trail, and out by its exit."""

import numpy as np
import pytest
from mesa_mobility.behaviors import Following
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Visit
from mesa_mobility.errors import ModelError
from tests.fixtures.checkpoints import check_going_on
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import overlaps, wall_crossings
from tests.fixtures.scenes import advance, core_of, corridor, model_of, put


def led(plan, following, **keywords):
    model = model_of(plan, shipped_map(), frames_per_step=3, **keywords)
    model.add_tactic(following)
    return model


def rooms():
    """Rooms with a wall between them that leaves 3 m at its upper end; doors at both far ends."""
    return FloorPlan(
        box(0, 0, 16, 8) - box(8, 0, 8.5, 5),
        exits=[Exit("near", (0, 1), (0, 3)), Exit("far", (16, 1), (16, 3))],
    )


@pytest.mark.parametrize("speed", [0.7, 1.0, 1.4])
def test_a_follower_matches_the_speed_of_its_leader(speed):
    # Rio, Rhea and Warren (2014): followers match their leader's speed.
    following = Following(distance=1.5)
    model = led(corridor(80.0), following)
    leader = put(model, 3.0, 2.0, preferred_speeds=speed)
    follower = put(model, 1.0, 2.2, preferred_speeds=1.6)
    following.follow([follower], leader)
    model.run(max_seconds=10)
    before, gaps = follower.position[0], []
    while model.elapsed < 39.99:
        model.step()
        gaps.append(leader.position[0] - follower.position[0])
    # Over 30 s: the distance between the two swings by half a metre, which is 0.05 m/s over 10 s.
    assert (follower.position[0] - before) / 30.0 == pytest.approx(speed, abs=0.05)
    assert min(gaps) > 1.0
    assert max(gaps) < 2.5


def test_nobody_hurries_after_a_leader():
    following = Following()
    model = led(corridor(40.0), following)
    leader = put(model, 3.0, 2.0, preferred_speeds=1.6)
    follower = put(model, 1.0, 2.2, preferred_speeds=0.8)
    following.follow([follower], leader)
    model.run(max_seconds=5)
    before = follower.position[0]
    model.run(max_seconds=15)
    assert (follower.position[0] - before) / 10.0 == pytest.approx(0.8, abs=0.04)


def test_a_bunch_follows_round_a_wall_stands_and_leaves_by_the_leaders_exit():
    following = Following()
    plan = rooms()
    model = led(plan, following, rng=1)
    guide = put(
        model, 5.0, 4.0, route=[Visit((12.0, 4.0), stay=16.0)], exits=["far"], preferred_speeds=1.0
    )
    people = model.add_pedestrians([(1 + 0.8 * i, 2 + k) for i in range(2) for k in range(5)])
    following.follow(people, guide)
    model.run(max_seconds=22)
    assert guide.waiting
    away = sorted(np.hypot(*(person.position - guide.position)) for person in people)
    # A half circle of r metres holds 1.57 r2 people at 1 person/m2: 2.5 m for ten.
    assert away[4] < 2.5
    # Two at the edge may have no room to come as near as they should, and still look for a way.
    assert sorted(person.speed for person in people)[-3] < 0.1
    model.run(max_seconds=60)
    assert model.inside == 0
    assert (model.crowd.x[[person.row for person in people]] > 15.0).all()
    rows = model.recorder.arrays()
    assert overlaps(rows, core_of(model)) == 0
    assert wall_crossings(rows, plan.walls) == 0


def test_the_unled_take_the_nearest_exit():
    model = led(rooms(), Following(), rng=1)
    person = put(model, 3.0, 4.0)
    model.run(max_seconds=20)
    assert model.crowd.x[person.row] < 1.0


def test_whoever_follows_nobody_any_more_goes_its_way():
    following = Following()
    model = model_of(corridor(both_ends=True), strider())
    model.add_tactic(following)
    leader = put(model, 12.0, 2.0, exits=["east"])
    person = put(model, 8.0, 2.0, exits=["west"])
    following.follow([person], leader)
    advance(model, 46)
    assert person.target[0] > 8.0
    following.follow([person], None)
    advance(model, 46)
    assert person.target[0] <= 0.0


def test_those_whose_leader_is_taken_out_go_their_way():
    following = Following()
    model = model_of(corridor(both_ends=True), strider())
    model.add_tactic(following)
    leader = put(model, 12.0, 2.0, exits=["east"])
    person = put(model, 8.0, 2.0, exits=["west"])
    following.follow([person], leader)
    advance(model, 10)
    leader.remove()
    advance(model, 91)
    assert person.target[0] <= 0.0


def test_it_goes_on_from_a_checkpoint(tmp_path):
    class Street(PedestrianModel):
        def __init__(self, rng=None):
            super().__init__(corridor(), mobility_map=shipped_map(), record=True, rng=rng)
            self.following = Following()
            self.add_tactic(self.following)
            leader, *others = self.add_pedestrians([(4.0, 2.0), (2.0, 2.0), (1.0, 3.0)])
            self.following.follow(others, leader)

    check_going_on(Street(rng=1), tmp_path, saved_at=3, until=6)


@pytest.mark.parametrize(
    ("leaders", "trails", "text"),
    [
        ({1: 0}, {0: np.empty((0, 2))}, r"_trails\[0\]: has no numbers, expected some"),
        ({1: 1}, {}, "_leaders: pedestrian 1 would follow themselves"),
        ({2: 0, 0: 1, 1: 2}, {}, "_leaders: pedestrian [012] would follow themselves"),
    ],
)
def test_what_a_checkpoint_must_not_say(tmp_path, leaders, trails, text):
    following = Following()
    model = PedestrianModel(corridor(), mobility_map=strider(), rng=1)
    model.add_tactic(following)
    model.add_pedestrians([(2.0, 1.0), (3.0, 1.0), (4.0, 1.0)])
    following._leaders, following._trails = leaders, trails
    model.save(tmp_path / "saved")
    with pytest.raises(ModelError, match=text) as caught:
        PedestrianModel.load(tmp_path / "saved", mobility_map=strider(), plugins=[Following()])
    assert "\n" not in str(caught.value)


def test_what_is_refused():
    with pytest.raises(ModelError, match=r"following: distance 0.0, expected more than 0 m"):
        Following(distance=0.0)
    following = Following()
    model = model_of(corridor(), strider())
    a, b, c = model.add_pedestrians([(2.0, 1.0), (3.0, 1.0), (4.0, 1.0)])
    following.follow([b], a)
    following.follow([c], b)
    with pytest.raises(ModelError, match="pedestrian 0 would follow themselves"):
        following.follow([a], c)
