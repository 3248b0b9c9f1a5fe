"""People who visit places before they leave."""

import copy

import numpy as np
import pytest
from shapely import Polygon, box

from mesa_mobility import Exit, FloorPlan, Gate, PedestrianModel, Source, Visit
from mesa_mobility.dashboard.session.decision import described
from mesa_mobility.distributions import Uniform
from mesa_mobility.errors import FloorPlanError, ModelError
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import overlaps
from tests.fixtures.scenes import core_of, model_of, put


def shop():
    """Two rooms 10 m by 8 m with a door 2 m wide between them; the exit is in the left one."""
    floor = box(0, 0, 20, 8) - box(9.9, 0, 10.1, 3) - box(9.9, 5, 10.1, 8)
    assert isinstance(floor, Polygon)
    return FloorPlan(
        floor, exits=[Exit("street", (0, 3), (0, 5))], gates=[Gate("door", (10, 3), (10, 5))]
    )


def walk(model, person, seconds=90.0):
    """Times, and (n, 2) positions, of somebody until it has left."""
    times, places = [], []
    while model.crowd.active[person.row] and model.elapsed < seconds:
        model.step()
        times.append(model.elapsed)
        places.append([model.crowd.x[person.row], model.crowd.y[person.row]])
    return np.array(times), np.array(places)


def test_a_point_behind_a_corner_is_visited_for_as_long_as_said_then_the_exit():
    model = model_of(shop(), shipped_map(), rng=1, frames_per_step=3)
    person = put(model, 2.0, 4.0, route=[Visit((14.0, 1.5), stay=8.0)])
    assert person.next_stop == Visit((14.0, 1.5), stay=8.0)
    # From (2, 4) round the jamb at (10, 3): a little more than two straight lines.
    length = np.hypot(8.0, 1.0) + np.hypot(4.0, 1.5)
    assert length < model.crowd.route[person.row] < length + 0.5
    times, places = walk(model, person)
    assert model.inside == 0
    near = np.hypot(*(places - (14.0, 1.5)).T) < 0.6
    # 8 s of standing, and half a metre of walking to and from, slowly before it.
    assert 8.0 <= np.ptp(times[near]) <= 12.5
    assert 0.1 * near.sum() < 10.5
    still = np.hypot(*np.diff(places, axis=0).T)[near[1:]] < 0.01
    assert 0.1 * still.sum() == pytest.approx(8.0, abs=0.3)


def test_gates_and_places_in_the_order_given():
    model = model_of(shop(), shipped_map(), rng=2, frames_per_step=3)
    route = [Visit((5.0, 1.0)), "door", Visit((15.0, 6.0), 2.0), Visit("POINT (3 7)", 1.0)]
    person = put(model, 2.0, 4.0, route=route)
    assert person.route == tuple(route)
    seen = []
    while model.inside and model.elapsed < 90.0:
        if not seen or seen[-1] != person.next_stop:
            seen.append(person.next_stop)
        model.step()
    assert seen == [*route, None]
    assert model.inside == 0
    assert person.gates_crossed == 4


def test_everybody_has_a_spot_of_its_own_in_an_area_and_around_a_point():
    area = box(14, 2, 18, 6)
    for place, far in ((area, 0.0), ((16.0, 4.0), 1.6)):
        model = model_of(shop(), shipped_map(), rng=3, frames_per_step=3)
        starts = [(x, y) for x in (2.0, 3.0, 4.0) for y in (2.0, 3.0, 4.0, 5.0)]
        people = model.add_pedestrians(starts, route=[Visit(place, 60.0)])
        model.run(max_seconds=40)
        where = np.array([person.position for person in people])
        assert all(person.waiting for person in people)
        if far:
            # Twelve at 0.31 m2 each would fill a disc of 1.1 m radius.
            assert np.hypot(*(where - place).T).max() < far
        else:
            assert all(area.buffer(0.31).contains_properly(p) for p in _points(where))
        gaps = np.hypot(*(where[:, None] - where).T) + 9.0 * np.eye(len(where))
        # Spots are 0.6 m apart, and people stop within 0.3 m of theirs: two may all but touch.
        assert gaps.min() > 0.28
        assert gaps.min(axis=0).mean() > 0.45
        model.run(max_seconds=200)
        assert model.inside == 0
        assert overlaps(model.recorder.arrays(), core_of(model)) == 0


def _points(places):
    from shapely import points

    return list(points(places))


def test_others_pass_those_who_stay():
    plan = FloorPlan(box(0, 0, 12, 2.4), exits=[Exit("east", (12, 0), (12, 2.4))])
    model = model_of(plan, shipped_map(), rng=4, frames_per_step=3)
    model.add_pedestrians([(5.0, 1.2)], route=[Visit((6.0, 1.2), 60.0)])
    model.run(max_seconds=6)
    model.add_pedestrians([(1.0, 0.6), (1.0, 1.8), (2.0, 1.2)])
    model.run(max_seconds=30)
    assert model.inside == 1
    assert not model.stalled


def test_stays_are_drawn_and_a_route_may_be_given_or_ended_at_any_time():
    model = model_of(shop(), shipped_map(), rng=5, frames_per_step=3)
    person = put(model, 4.0, 4.0)
    model.run(max_seconds=0.5)
    person.route = [Visit((5.0, 5.0), Uniform(20.0, 40.0))]
    model.run(max_seconds=10)
    assert person.waiting
    left = model.crowd.agenda["waits_until"][person.row] / 30 - model.elapsed
    assert 10.0 < left < 40.0
    person.exits = ["street"]
    assert not person.waiting
    assert person.next_stop is None
    model.run(max_seconds=20)
    assert model.inside == 0


def test_a_source_and_a_loop():
    model = model_of(shop(), shipped_map(), rng=6, frames_per_step=3)
    one, other = Visit((3.0, 1.0), 1.0), Visit((17.0, 7.0), 1.0)
    rounds = put(model, 5.0, 4.0, route=[one, other], loop=True)
    model.add_source(
        Source(area="POLYGON ((1 5, 4 5, 4 7, 1 7, 1 5))", times=[1, 2], route=[Visit((7, 6), 2)])
    )
    model.run(max_seconds=60)
    assert model.inside == 1
    assert rounds.gates_crossed >= 2
    assert rounds.next_stop in (one, other)


def test_checkpoints_and_copies_go_on_to_the_same_bytes(tmp_path):
    model = model_of(shop(), shipped_map(), rng=7, frames_per_step=3)
    starts = [(x, y) for x in (2.0, 3.0) for y in (2.0, 3.0, 4.0)]
    area = Visit("POLYGON ((14 1, 18 1, 18 4, 14 4, 14 1))", Uniform(2.0, 9.0))
    model.add_pedestrians(starts, route=[Visit((6.0, 6.0), 1.5), area])
    model.run(max_seconds=17)
    stands = model.journeys.stays
    assert any(stands.stands(row) for row in range(6))
    model.save(tmp_path / "shop.zip")
    copied = copy.deepcopy(model)
    loaded = PedestrianModel.load(tmp_path / "shop.zip", pedestrian_types=model.pedestrian_types)
    for each in (model, copied, loaded):
        each.run(max_seconds=120)
        assert each.inside == 0
    for each in (copied, loaded):
        assert each.summary() == model.summary()
        for name in ("x", "y", "heading"):
            np.testing.assert_array_equal(getattr(each.crowd, name), getattr(model.crowd, name))


def test_the_explanation_says_where_somebody_goes():
    model = model_of(shop(), shipped_map(), rng=8, frames_per_step=3)
    person = put(model, 4.0, 4.0, route=[Visit((6.0, 4.0), 30.0), "door"])
    assert described(model.explain(person.row), model)["goes"] == (
        "They go to the point (6, 4), then to 1 more"
    )
    model.run(max_seconds=10)
    said = described(model.explain(person.row), model)["goes"]
    assert said.startswith("They stay at the point (6, 4) until 3")
    person.route = ["door"]
    assert described(model.explain(person.row), model)["goes"] == "They go to gate door"
    person.exits = None
    assert described(model.explain(person.row), model)["goes"] == "They go to street"


def test_places_that_cannot_be_visited_are_refused():
    model = model_of(shop(), strider())
    closed = box(30, 0, 34, 4)

    def route(*stops):
        put(model, 2.0, 2.0, route=list(stops))

    for place, text in (
        ((25.0, 1.0), r"visit: the point \(25, 1\) is off the floor"),
        ((0.05, 1.0), r"visit: the point \(0.05, 1\) is 0.050 m from a wall, expected 0.1"),
        (closed, r"visit: the area around \(32, 2\) has no place on the floor that is 0.1"),
    ):
        with pytest.raises(FloorPlanError, match=text):
            route(Visit(place))
    for wrong in ("nowhere", (1.0, 2.0, 3.0), (np.nan, 1.0), "LINESTRING (0 0, 1 1)", 3):
        with pytest.raises(FloorPlanError, match="visit: "):
            Visit(wrong)
    # The reader of the library ends the process where shapes nest this deeply.
    with pytest.raises(FloorPlanError, match=r"visit: .*expected POINT or POLYGON"):
        Visit("GEOMETRYCOLLECTION (" * 200_000)
    for stay in (-1.0, np.inf, "long"):
        with pytest.raises(ModelError, match="visit: stay"):
            Visit((1.0, 1.0), stay)
    with pytest.raises(ModelError, match="follows itself"):
        route(Visit((3, 3), 1), Visit((3, 3), 1))
    with pytest.raises(ModelError, match="expected a list of names of gates and visits"):
        model.add_pedestrians([(2.0, 2.0)], route=Visit((3, 3)))
    assert model.inside == 0
    # A room that nobody of this width can enter: 0.3 m between the jambs.
    narrow = FloorPlan(
        box(0, 0, 20, 8) - box(9.9, 0, 10.1, 3.85) - box(9.9, 4.15, 10.1, 8),
        exits=[Exit("street", (0, 3), (0, 5)), Exit("back", (20, 3), (20, 5))],
    )
    model = model_of(narrow, strider())
    with pytest.raises(FloorPlanError, match=r"1 of 1 people have no way to \(15.00, 4.00\)"):
        put(model, 2.0, 2.0, route=[Visit((15.0, 4.0))])
    with pytest.raises(FloorPlanError, match=r"no way from \(5.00, 4.00\) to \(15.00, 4.00\)"):
        put(model, 2.0, 2.0, route=[Visit((5.0, 4.0)), Visit((15.0, 4.0))])
