"""Some of those who pass a shop window stop to look."""

import pytest
from mesa_mobility.behaviors import Attraction, Attractions
from shapely import Point, box

from mesa_mobility import PedestrianModel, Visit
from mesa_mobility.errors import FloorPlanError, ModelError
from tests.fixtures.checkpoints import check_going_on
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import corridor, model_of, put

WINDOW = box(9, 0.2, 12, 1.2)


def passing(attraction, people=60, *, seconds=12, rng=1):
    """The tactic and the model after people have come past a window."""
    tactic = Attractions([attraction])
    model = model_of(corridor(24.0, 6.0), strider(), rng=rng)
    model.add_tactic(tactic)
    places = [(0.5 + 0.6 * (k // 8), 0.5 + 0.7 * (k % 8)) for k in range(people)]
    model.add_pedestrians(places)
    model.run(max_seconds=seconds)
    return tactic, model


def test_chances_are_those_that_were_measured():
    # Milgram, Bickman and Berkowitz (1969): 4 % stop beside one person, 40 % beside 15.
    crowd = Attraction((1.0, 1.0), stay=60.0, influence=1.0 / 24.0)
    assert crowd.chance(0) == 0.0
    assert crowd.chance(1) == pytest.approx(0.04)
    assert crowd.chance(15) == pytest.approx(0.40, abs=0.02)
    assert Attraction((1.0, 1.0), stay=1.0, share=1.0).chance(3) == 1.0


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_the_share_that_is_asked_for_stops(share):
    window = Attraction(WINDOW, stay=5.0, share=share, distance=8.0)
    stopped, passed = 0, 0
    for rng in (1, 2, 3):
        tactic, _ = passing(window, rng=rng)
        stopped += len(tactic.stopped(window))
        passed += len(tactic.passed(window))
    assert passed > 100
    deviation = (share * (1.0 - share) * passed) ** 0.5
    assert abs(stopped - share * passed) <= 3.0 * deviation


def test_more_stop_where_others_look():
    counts = []
    for influence in (0.0, 1.0):
        window = Attraction(WINDOW, stay=30.0, share=0.1, influence=influence, distance=4.0)
        tactic = Attractions([window])
        model = model_of(corridor(24.0, 6.0), shipped_map(), frames_per_step=3)
        model.add_tactic(tactic)
        model.add_pedestrians(
            [(9.5 + 0.7 * k, 0.7) for k in range(4)], route=[Visit(WINDOW, stay=60.0)]
        )
        model.run(max_seconds=8)
        assert tactic.looking(window) == 4
        model.add_pedestrians([(0.5 + 0.6 * i, 1.0 + 0.7 * k) for i in range(5) for k in range(6)])
        model.run(max_seconds=18)
        counts.append(len(tactic.stopped(window)))
    # Chances of 10 % and, with four people at 1 each, of 80 %, for 30 people.
    assert counts[0] < 10 < 18 < counts[1]


def test_those_who_stop_look_for_the_time_given_and_go_on():
    window = Attraction(WINDOW, stay=5.0, share=1.0)
    tactic = Attractions([window])
    model = model_of(corridor(24.0, 6.0), shipped_map(), frames_per_step=3)
    model.add_tactic(tactic)
    person = put(model, 3.0, 3.0, preferred_speeds=1.3)
    waited = 0.0
    while model.inside and model.elapsed < 60.0:
        model.step()
        if person in model.agents and person.waiting:
            assert WINDOW.distance(Point(person.position)) < 0.4
            waited += 0.1
    assert waited == pytest.approx(5.0, abs=0.3)
    assert model.inside == 0


def test_who_does_not_see_it_passes():
    window = Attraction(box(9, 4.5, 12, 5.5), stay=5.0, share=1.0)
    tactic = Attractions([window])
    model = model_of(corridor(24.0, 6.0, obstacles=[box(2, 4.0, 20, 4.2)]), strider())
    model.add_tactic(tactic)
    put(model, 6.0, 2.0)
    model.run(max_seconds=8)
    assert tactic.stopped(window) == []


def test_it_goes_on_from_a_checkpoint(tmp_path):
    class Mall(PedestrianModel):
        def __init__(self, rng=None):
            super().__init__(corridor(), mobility_map=shipped_map(), record=True, rng=rng)
            self.add_tactic(Attractions([Attraction((10.0, 1.0), stay=4.0, share=0.6)]))
            self.add_pedestrians([(3.0 + k, 2.0) for k in range(4)])

    check_going_on(Mall(rng=1), tmp_path, saved_at=4, until=10)


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        ({"share": 1.1}, "attraction: share 1.1, expected 0 to 1"),
        ({"influence": -1.0}, "attraction: influence -1.0, expected 0 or more"),
        ({"distance": 0.0}, "attraction: distance 0.0, expected more than 0 m"),
        ({"stay": -2.0}, "visit: stay -2.0"),
    ],
)
def test_numbers_out_of_range_are_refused(wrong, text):
    with pytest.raises(ModelError, match=text):
        Attraction(**{"place": (1.0, 1.0), "stay": 1.0, **wrong})


def test_a_place_that_is_none_is_refused():
    with pytest.raises(FloorPlanError, match="expected a point"):
        Attraction((1.0, 2.0, 3.0), stay=1.0)
