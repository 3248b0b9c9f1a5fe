"""Routes chosen by time, by signs and by what people know."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import BlockedWays, CongestionRouting, FamiliarRoutes, Sign, Signs
from shapely import Polygon, box

from mesa_mobility import Exit, FloorPlan, Gate
from mesa_mobility.errors import FloorPlanError, ModelError
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import advance, model_of, put, statues


def two_corridors(exit_from=3.0):
    """A hall, corridors 2 m wide at y = 1 and y = 7, and a hall with an exit 2 m wide."""
    floor = box(0, 0, 20, 8) - box(6, 2, 14, 6)
    assert isinstance(floor, Polygon)
    return FloorPlan(
        floor,
        exits=[Exit("east", (20, exit_from), (20, exit_from + 2))],
        gates=[Gate("low", (10, 0), (10, 2)), Gate("high", (10, 6), (10, 8))],
    )


def crowd_places(n):
    return [(0.5 + 0.5 * (k // 14), 0.6 + 0.5 * (k % 14)) for k in range(n)]


# -- the least time ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    # Round the block's corners the lower way to an exit from y = 0 to 2 is 3.6 + 14 m, the upper
    # one 3.6 + 8 + 7.2 m: some 1.2 s more. 2 m pass 4.305 people a second: 20 take 4.6 s.
    ("queue", "expected"),
    [(0, "low"), (20, "high")],
)
def test_walk_and_queue_are_weighed(queue, expected):
    model = model_of(two_corridors(0.0), [strider(), statues()], target_choice=CongestionRouting())
    model.add_pedestrians(
        [(6.5 + 0.45 * (k // 4), 0.4 + 0.4 * (k % 4)) for k in range(queue)],
        route=["low"],
        type_index=1,
    )
    person = put(model, 3.0, 4.0, preferred_speeds=[1.0])
    assert person.route == (expected,)


def test_as_many_take_either_of_two_equal_corridors():
    model = model_of(two_corridors(), strider(), target_choice=CongestionRouting())
    people = model.add_pedestrians(crowd_places(60), preferred_speeds=1.2)
    low = sum(person.route == ("low",) for person in people)
    # More start nearer to the lower one; each person more before a gate costs 0.23 s, 0.28 m.
    assert 24 <= low <= 36
    assert {person.route for person in people} == {("low",), ("high",)}


@pytest.mark.thorough
def test_people_think_again_and_go_through_without_turning_back():
    choice = CongestionRouting(interval=0.2)
    model = model_of(
        two_corridors(0.0),
        [shipped_map(), statues()],
        rng=3,
        frames_per_step=3,
        target_choice=choice,
    )
    people = model.add_pedestrians([(1.0, 1.0), (1.0, 2.0)], type_index=0)
    assert [person.route for person in people] == [("low",)] * 2
    model.add_pedestrians(
        [(6.5 + 0.45 * (k // 4), 0.4 + 0.4 * (k % 4)) for k in range(28)],
        route=["low"],
        type_index=1,
    )
    model.run(max_seconds=3)
    assert [person.route for person in people] == [("high",)] * 2
    model.run(max_seconds=40)
    assert model.inside == 28


def test_people_without_gates_go_the_shortest_way():
    plan = FloorPlan(box(0, 0, 10, 4), exits=[Exit("east", (10, 1), (10, 3))])
    model = model_of(plan, strider(), target_choice=CongestionRouting())
    assert put(model, 2.0, 2.0).route == ()
    with pytest.raises(ModelError, match=r"patience 1\.0, expected 0 or more and less than 1"):
        CongestionRouting(patience=1.0)


# -- signs -------------------------------------------------------------------------------------


def test_a_sign_is_legible_from_within_a_circle_that_touches_it():
    sign = Sign((0.0, 0.0), 0.0, ["high"], distance=10.0)
    polar = ((9.9, 0.0), (10.1, 0.0), (4.9, math.pi / 3), (5.1, math.pi / 3))
    at = [(away * math.cos(angle), away * math.sin(angle)) for away, angle in polar]
    assert sign.legible(np.array(at)).tolist() == [True, False, True, False]
    side = np.arange(-11.95, 12.0, 0.1)
    grid = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    # The area of a circle 5 m in radius.
    assert 0.01 * sign.legible(grid).sum() == pytest.approx(25.0 * math.pi, rel=0.01)


def following(heading=0.0, sign=None, **keywords):
    sign = sign or Sign((6.0, 4.0), math.pi, ["high"])
    count = 0
    for seed in (1, 2, 3):
        model = model_of(
            two_corridors(0.0),
            statues(),
            rng=seed,
            target_choice=Signs([sign], interval=0.01, **keywords),
        )
        people = model.add_pedestrians(crowd_places(140), headings=[heading] * 140)
        advance(model, 45)
        count += sum(person.route == ("high",) for person in people)
        assert {person.route for person in people} <= {("high",), ()}
    return count / 420


def test_the_measured_share_of_people_follows_a_sign():
    # 0.38 * 0.97, and three standard deviations of 420 draws.
    assert following() == pytest.approx(0.3686, abs=0.071)


def test_signs_are_seen_by_those_who_face_them_with_no_wall_between():
    assert following(noticed=1.0, followed=1.0) == 1.0
    assert following(heading=math.pi, noticed=1.0) == 0.0
    hidden = Sign((14.0, 4.0), math.pi, ["high"])
    assert following(sign=hidden, noticed=1.0) == 0.0


def test_signs_that_lead_nowhere_are_refused():
    with pytest.raises(FloorPlanError, match="no gate or exit 'middle'"):
        put(
            model_of(
                two_corridors(), strider(), target_choice=Signs([Sign((6, 4), 0.0, ["middle"])])
            ),
            2.0,
            2.0,
        )
    for wrong, text in (
        ({"gates": "low"}, "expected a list"),
        ({"facing": math.nan}, "facing nan, expected"),
        ({"distance": 0.0}, "distance 0.0"),
    ):
        with pytest.raises(ModelError, match=text):
            Sign(**{"position": (6, 4), "facing": 0.0, "gates": ["low"], **wrong})
    with pytest.raises(ModelError, match="noticed 2, expected 0 to 1"):
        Signs(noticed=2)


# -- what people know --------------------------------------------------------------------------


def test_a_share_of_people_leaves_as_it_came():
    model = model_of(
        two_corridors(0.0), statues(), target_choice=FamiliarRoutes(["high", "low"], share=0.75)
    )
    people = model.add_pedestrians(crowd_places(140))
    back = sum(person.route == ("low", "high") for person in people)
    # Three standard deviations of 140 draws.
    assert back / 140 == pytest.approx(0.75, abs=0.11)
    assert sum(person.route == () for person in people) == 140 - back


def test_some_know_another_way():
    choice = FamiliarRoutes(share=1.0)
    model = model_of(two_corridors(0.0), strider(), target_choice=choice)
    one, other = model.add_pedestrians([(1.0, 3.0), (1.0, 5.0)])
    choice.know([other], ["high"])
    advance(model, 46)
    assert one.route == ()
    assert other.route == ("high",)
    with pytest.raises(FloorPlanError, match="no gate or exit 'middle'"):
        choice.know([one], ["middle"])
    with pytest.raises(FloorPlanError, match="way in: exit 'east', expected names of gates"):
        choice.know([one], ["east", "high"])
    with pytest.raises(ModelError, match="expected a list of names"):
        choice.know([one], "high")


def test_people_wait_if_no_exit_is_open():
    plan = FloorPlan(box(0, 0, 8, 4), exits=[Exit("out", (8, 1), (8, 3))])
    model = model_of(plan, strider(), target_choice=CongestionRouting(interval=0.1))
    person = put(model, 1.0, 2.0)
    plan.close_gate("out")
    advance(model, 60)
    assert model.inside == 1
    plan.open_gate("out")
    advance(model, 240)
    assert person not in model.agents


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("choice", "start", "goes_up"),
    [
        # The lower corridor is round a corner from (1, 4), straight ahead of (1, 1).
        (None, (1.0, 4.0), True),
        (BlockedWays(), (1.0, 4.0), False),
        (BlockedWays(), (1.0, 1.0), True),
        (BlockedWays(sight=5.0), (1.0, 1.0), False),
    ],
)
def test_who_has_not_seen_that_a_way_is_closed_goes_there(choice, start, goes_up):
    model = model_of(
        two_corridors(0.0), shipped_map(), rng=4, frames_per_step=3, target_choice=choice
    )
    model.floor_plan.close_gate("low")
    person = put(model, *start, preferred_speeds=[1.2])
    # To the corner of the block above at (6, 6), or along the lower wall.
    assert (person.target[1] > start[1] + 0.2) == goes_up
    places = []
    while model.inside and model.elapsed < 60.0:
        model.step()
        places.append((model.crowd.x[person.row], model.crowd.y[person.row]))
    assert model.inside == 0
    # Nobody walks through the gate that is closed; it is seen from 5 m, beyond x = 5, or before.
    low = [x for x, y in places if y < 2.0 and x < 14.0]
    assert max(low, default=0.0) < 7.5
    assert any(y > 6.0 for x, y in places if 8.0 < x < 12.0)


def test_a_way_that_opens_again_is_known_to_all():
    choice = BlockedWays()
    model = model_of(two_corridors(0.0), strider(), target_choice=choice)
    model.floor_plan.close_gate("low")
    person = put(model, 1.0, 1.0)
    assert person.target[1] > 1.0
    model.floor_plan.open_gate("low")
    advance(model, 46)
    assert person.target[1] <= 1.5
    with pytest.raises(ModelError, match=r"sight 0.0, expected more than 0 m"):
        BlockedWays(sight=0.0)
