"""People who come over time, where there is room."""

import numpy as np
import pytest
from shapely import LineString, box

from mesa_mobility import Exit, FloorPlan, Gate, Source
from mesa_mobility.distributions import Uniform
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.results import Trajectories, check_safety
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import advance, corridor, model_of, put, same_rows, statues

WEST = box(0.5, 0.5, 3.0, 3.5)


def first_seen(model) -> list[float]:
    """Seconds at which each person has its first row, in order of rows."""
    rows = model.recorder.arrays()
    people = np.unique(rows["person"])
    return [float(rows["frame"][rows["person"] == p].min()) / 30 for p in people]


def test_scheduled_arrivals_come_in_the_first_frame_after_their_time():
    model = model_of(corridor(length=60.0), strider())
    inflow = model.add_source(Source(area=WEST, times=[2.0, 0.0, 0.51, 2.0]))
    assert model.sources.expecting
    advance(model, 90)
    assert first_seen(model) == pytest.approx([0.0, 16 / 30, 2.0, 2.0])
    assert (inflow.arrived, inflow.entered, inflow.waiting) == (4, 4, 0)
    assert inflow.finished
    assert same_rows(model)


def test_where_they_appear_they_are_recorded_before_they_move():
    model = model_of(corridor(length=60.0), strider())
    model.add_source(Source(area=LineString([(1.0, 1.0), (1.0, 3.0)]), times=[0.0, 1.0, 2.0]))
    advance(model, 90)
    rows = model.recorder.arrays()
    for person, frame in ((0, 0), (1, 30), (2, 60)):
        (at,) = np.flatnonzero((rows["person"] == person) & (rows["frame"] == frame))
        assert rows["x"][at] == pytest.approx(1.0)
        assert 1.0 <= rows["y"][at] <= 3.0


def test_a_rate_is_a_poisson_process():
    model = model_of(
        corridor(length=30.0, width=8.0),
        strider(),
        rng=4,
        record=False,
        preset="paper",
        frames_per_step=30,
    )
    inflow = model.add_source(Source(area=box(1, 1, 6, 7), rate=2.0))
    counts = []
    for _ in range(300):
        before = inflow.arrived
        model.step()
        counts.append(inflow.arrived - before)
    # 600 expected, give or take four times their root; variance equal to the mean.
    assert sum(counts) == pytest.approx(600, abs=98)
    assert np.var(counts) / np.mean(counts) == pytest.approx(1.0, abs=0.3)


def test_people_from_the_two_ends_of_a_line_alike():
    model = model_of(corridor(width=8.0), strider(), rng=1, preset="paper")
    model.add_source(Source(area=LineString([(1.0, 0.0), (1.0, 8.0)]), times=np.zeros(400)))
    advance(model, 1)
    rows = model.recorder.arrays()
    y = rows["y"][rows["frame"] == 0]
    assert len(y) == 400
    # A body keeps clear of the walls at 0 and 8 m.
    assert 0.15 < y.min() < 0.4
    assert 7.6 < y.max() < 7.85
    assert y.mean() == pytest.approx(4.0, abs=0.5)


def test_held_back_in_order_until_there_is_room():
    model = model_of(corridor(), [strider(), statues()])
    # Room for one body at a time: those before have to walk away first.
    spot = box(1.0, 1.0, 1.02, 1.02)
    inflow = model.add_source(Source(area=spot, times=[0.0, 0.0, 0.0], preferred_speeds=1.25))
    advance(model, 1)
    assert (inflow.arrived, inflow.entered, inflow.waiting) == (3, 1, 2)
    assert not inflow.finished
    # 0.3 m at 1.25 m/s are 7.2 frames.
    advance(model, 9)
    assert inflow.waiting == 1
    blocked = model.add_source(Source(area=box(9.98, 1.98, 10.0, 2.0), times=[0.0], type_index=0))
    put(model, 10.0, 2.0, type_index=1)
    advance(model, 120)
    assert blocked.waiting == 1
    assert inflow.finished


def test_stops_at_a_number_or_at_a_time():
    model = model_of(corridor(length=60.0, width=6.0), strider(), rng=2, preset="paper")
    ten = model.add_source(Source(area=WEST, rate=5.0, number=10))
    early = model.add_source(Source(area=WEST, rate=5.0, start=1.0, until=3.0))
    none = model.add_source(Source(area=WEST, rate=5.0, number=0))
    listed = model.add_source(Source(area=WEST, times=[0.5, 1.5, 2.5], until=2.0))
    advance(model, 29)
    assert early.arrived == 0
    advance(model, 300)
    assert (ten.arrived, none.arrived, listed.arrived) == (10, 0, 2)
    assert early.arrived == pytest.approx(10, abs=9)
    assert early.arrived > 0
    assert all(inflow.finished for inflow in model.sources)


def test_a_run_is_not_over_while_somebody_is_to_come():
    model = model_of(corridor(length=8.0), strider(), frames_per_step=3)
    model.add_source(Source(area=WEST, times=[5.0, 100.0], preferred_speeds=1.25))
    model.run(max_seconds=50)
    assert model.inside == 0
    assert model.sources.expecting
    assert model.running
    assert model.summary()["egress_s"] is None
    model.run()
    assert not model.running
    assert not model.stalled
    assert 100.0 + 4.0 < model.summary()["egress_s"] < 100.0 + 9.0


def test_people_of_a_source_get_what_added_people_get():
    model = model_of(corridor(both_ends=True), strider(), rng=3)
    model.add_source(
        Source(
            area=WEST,
            times=[0.0, 0.0],
            exits=["east"],
            group="tour",
            preferred_speeds=Uniform(0.8, 1.0),
            pre_movement=2.0,
        )
    )
    advance(model, 1)
    for person in model.agents:
        assert 0.8 <= person.preferred_speed <= 1.0
        assert person.start_time == pytest.approx(2.0)
        assert person.target[0] > 20.0
        assert person.group == "tour"


def test_trajectories_do_not_depend_on_the_length_of_a_step():
    found = []
    for frames_per_step in (1, 3, 7):
        model = model_of(
            corridor(length=8.0), shipped_map(), rng=6, frames_per_step=frames_per_step
        )
        model.add_source(Source(area=box(0.5, 0.5, 2.0, 3.5), rate=4.0, until=9.0))
        while model.frame < 336:
            model.step()
        rows = model.recorder.arrays()
        keep = rows["frame"] <= 330
        found.append({name: column[keep] for name, column in rows.items()})
        assert len(found[-1]["x"]) > 2000
    for other in found[1:]:
        for name, column in found[0].items():
            np.testing.assert_array_equal(column, other[name])


def test_a_stream_through_a_corridor_is_safe():
    model = model_of(corridor(length=12.0, width=2.0), shipped_map(), rng=8, frames_per_step=3)
    inflow = model.add_source(Source(area=box(0.3, 0.3, 2.5, 1.7), rate=3.0, until=25.0))
    model.run(max_seconds=90)
    assert model.inside == 0
    assert inflow.entered == inflow.arrived > 50
    report = check_safety(Trajectories.of(model), model.floor_plan.walls)
    assert (report.overlaps, report.wall_crossings) == (0, 0)


def test_nobody_appears_where_no_way_leads_out():
    """Past the end of a wall 0.3 m from another, no adult passes."""
    model = model_of(corridor(obstacles=[box(12, 0, 12.2, 3.7)]), strider())
    model.add_source(Source(area=box(8, 0.2, 16, 3.8), times=[0.0] * 60))
    advance(model, 2)
    rows = model.recorder.arrays()
    assert len(np.unique(rows["person"])) > 20
    assert rows["x"].min() > 12.2


def test_nobody_appears_where_there_is_no_room_any_more():
    plan = FloorPlan(
        box(0, 0, 20, 4),
        exits=[Exit("east", (20, 0), (20, 4))],
        gates=[Gate("door", (2.0, 0.0), (2.0, 4.0))],
    )
    model = model_of(plan, strider())
    model.add_source(Source(area=box(1.0, 0.5, 3.0, 3.5), rate=20.0, number=60))
    plan.add_obstacle(box(2.5, 0.0, 3.5, 2.0))
    plan.close_gate("door")
    advance(model, 60)
    rows = model.recorder.arrays()
    started = np.unique(rows["person"], return_index=True)[1]
    assert len(started) >= 5
    x, y = rows["x"][started], rows["y"][started]
    assert (abs(x - 2.0) >= 0.12).all()
    assert ((x <= 2.5 - 0.12) | (y >= 2.0 + 0.12)).all()


def test_nobody_appears_beside_a_person_crossing_the_exit():
    # 1.98 m at 1.25 m/s are 47.5 frames: in frame 48 it is 0.02 m beyond the exit at 12 m, and
    # 0.22 m from the spot, where two bodies take 0.28 m: it is free two frames later.
    model = model_of(corridor(length=12.0), strider())
    put(model, 10.02, 2.0, preferred_speeds=1.25)
    model.add_source(Source(area=box(11.8, 1.99, 11.81, 2.01), times=[48 / 30]))
    advance(model, 60)
    rows = model.recorder.arrays()
    assert rows["frame"][rows["person"] == 0].max() == 48
    assert first_seen(model) == pytest.approx([0.0, 50 / 30])
    assert check_safety(Trajectories.of(model), model.floor_plan.walls).overlaps == 0


@pytest.mark.parametrize(
    "keywords",
    [
        {},
        {"rate": 1.0, "times": [1.0]},
        {"rate": 0.0},
        {"rate": np.inf},
        {"times": [-1.0]},
        {"times": "soon"},
        {"times": [[1.0]]},
        {"rate": 1.0, "start": 5.0, "until": 4.0},
        {"rate": 1.0, "number": -1},
        {"rate": 1.0, "number": 1.5},
        {"rate": 1e300},
        {"rate": np.nan},
        {"rate": "many"},
        {"rate": 1.0, "number": 10**30},
        {"times": [1e300]},
        {"times": [np.nan]},
        {"rate": 1.0, "start": 1e300},
        {"rate": 1.0, "start": "now"},
        {"rate": 1.0, "until": np.nan},
        {"rate": 1.0, "preferred_speeds": 1e300},
        {"rate": 1.0, "preferred_speeds": -1.0},
        {"rate": 1.0, "preferred_speeds": [1.0]},
        {"rate": 1.0, "pre_movement": -1.0},
        {"rate": 1.0, "pre_movement": np.nan},
        {"rate": 1.0, "pre_movement": 1e300},
    ],
)
def test_sources_that_cannot_be(keywords):
    with pytest.raises(ModelError, match="source") as refused:
        Source(area=WEST, **keywords)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("keywords", "error", "match"),
    [
        ({"area": "POLYGON ((30 0, 40 0, 40 4, 30 0))"}, FloorPlanError, "no place"),
        ({"area": "POINT (1 1)"}, FloorPlanError, "found a Point"),
        ({"area": "POLYGON"}, FloorPlanError, "WKT"),
        # The reader of the library ends the process where shapes nest this deeply.
        ({"area": "GEOMETRYCOLLECTION (" * 200_000}, FloorPlanError, "POLYGON or LINESTRING"),
        ({"area": 5}, FloorPlanError, "found a int"),
        ({"area": WEST, "exits": ["north"]}, FloorPlanError, "'north'"),
        ({"area": WEST, "exits": "east"}, ModelError, "exits"),
        ({"area": WEST, "type_index": 3}, ModelError, "type_index"),
        ({"area": WEST, "type_index": 0.5}, ModelError, "type_index"),
        ({"area": WEST, "loop": True}, ModelError, "loop"),
    ],
)
def test_sources_that_do_not_fit_the_model(keywords, error, match):
    model = model_of(corridor(), strider())
    with pytest.raises(error, match=match):
        model.add_source(Source(times=[1.0], **keywords))
    assert not model.sources.expecting


def test_people_who_come_almost_for_ever_want_an_end_too():
    model = model_of(corridor(), strider())
    model.add_source(Source(area=WEST, rate=1.0, until=1e300))
    with pytest.raises(ModelError, match="max_seconds"):
        model.run()


def test_the_highest_rate_fills_what_room_there_is():
    model = model_of(corridor(), statues(), record=False)
    inflow = model.add_source(Source(area=WEST, rate=1000.0))
    advance(model, 30)
    assert inflow.entered + inflow.waiting == inflow.arrived
    # 1,000 expected, give or take four times their root; 2.5 m x 3 m hold no more than 140.
    assert inflow.arrived == pytest.approx(1000, abs=127)
    assert 30 < inflow.entered < 140


def test_a_hundred_thousand_in_one_place_are_refused_at_once():
    model = model_of(corridor(), strider())
    with pytest.raises(ModelError, match=r"pedestrian 1 at \[5.0, 2.0\]: too close to another"):
        model.add_pedestrians(np.tile((5.0, 2.0), (100_000, 1)))
    assert model.inside == 0


def test_people_who_come_for_ever_want_an_end():
    model = model_of(corridor(), strider())
    model.add_source(Source(area=WEST, rate=1.0))
    with pytest.raises(ModelError, match="max_seconds"):
        model.run()


@pytest.mark.parametrize("comes", [{"times": [1.0]}, {"rate": 1.0, "number": 2}])
def test_people_who_are_to_come_and_go_round_for_ever_want_an_end(comes):
    exits, gates = (
        [Exit("east", (20, 0), (20, 4))],
        [Gate("there", (10, 0), (10, 4)), Gate("back", (6, 0), (6, 4))],
    )
    model = model_of(FloorPlan(box(0, 0, 20, 4), exits=exits, gates=gates), strider())
    model.add_source(Source(area=WEST, route=["there", "back"], loop=True, **comes))
    with pytest.raises(ModelError, match="max_seconds"):
        model.run()
