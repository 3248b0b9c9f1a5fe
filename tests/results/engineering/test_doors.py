"""Doors of runs: figures of tracks made by hand, and those of a run counted in other ways."""

import numpy as np
import pedpy
import pytest

from mesa_mobility import Building, Exit, FloorPlan, Gate, Level
from mesa_mobility.errors import ResultsError
from mesa_mobility.results import (
    Trajectories,
    clogging,
    crossings_of_doors,
    doors,
    n_t,
    queue_lengths,
    queues,
    tables_by_type,
    waiting_times,
)
from tests.fixtures.buildings import RISE, two_storeys

COUNTED = ["people", "first_s", "last_s", "flow_per_s", "flow_per_m_s"]


@pytest.fixture
def hall():
    return FloorPlan(
        "POLYGON ((0 0, 10 0, 10 4, 0 4, 0 0))",
        exits=[Exit("east", (10, 1), (10, 3))],
        gates=[Gate("middle", (5, 0), (5, 4))],
    )


@pytest.fixture
def three(walk):
    """One frame a second: 0 goes out at x + 2 m/s, 1 over the gate and back, 2 stays."""
    return walk(
        {
            0: (0, [(3, 2), (5.5, 2), (7.5, 2), (9.5, 2), (10.5, 2)]),
            1: (0, [(4, 1), (4, 1), (6, 1), (4, 1), (6, 1), (6, 1)]),
            2: (0, [(1, 1)] * 6),
        },
        frame_rate=1.0,
        person_data={"type": np.array(["child", "adult", "adult"])},
    )


def test_figures_of_each_door(three, hall):
    table = doors(three, hall)
    assert table.index.tolist() == ["middle", "east"]
    assert table.kind.tolist() == ["gate", "exit"]
    assert table.width_m.tolist() == [4.0, 2.0]
    # Person 0 crosses x = 5 after 2 of 2.5 m, person 1 half-way from the first second to the next.
    np.testing.assert_allclose(
        table.loc["middle", COUNTED].tolist(), [2, 0.8, 1.5, 1 / 0.7, 1 / 2.8]
    )
    np.testing.assert_array_equal(
        table.loc["east", COUNTED].tolist(), [1, 3.5, 3.5, np.nan, np.nan]
    )


def test_n_t_counts_everybody_once(three, hall):
    rows = n_t(three, hall)
    assert rows.door.tolist() == ["middle", "middle", "east"]
    assert rows.time_s.tolist() == pytest.approx([0.8, 1.5, 3.5])
    assert rows.people.tolist() == [1, 2, 1]


def test_everybody_and_each_type(three, hall):
    table = tables_by_type(lambda tracks: doors(tracks, hall), three)
    people = table.people.unstack("type")
    assert people.loc["middle"].to_dict() == {"all": 2, "adult": 1, "child": 1}
    assert people.loc["east"].to_dict() == {"all": 1, "adult": 0, "child": 1}


def test_tracks_without_types_have_everybody_alone(walk, hall):
    table = tables_by_type(lambda tracks: doors(tracks, hall), walk({0: (0, [(3, 2), (6, 2)])}))
    assert table.index.get_level_values("type").unique().tolist() == ["all"]


def test_doors_of_a_run_as_pedpy_and_a_plain_count_have_them(leaving):
    plan, tracks = leaving
    table, data = doors(tracks, plan), tracks.to_pedpy()
    for opening in plan.openings():
        line = pedpy.MeasurementLine([opening.a, opening.b])
        curve, crossed = pedpy.compute_n_t(traj_data=data, measurement_line=line)
        own = table.loc[opening.name]
        assert own.people == curve.cumulative_pedestrians.max() == len(crossed) > 0
        times = np.sort(crossed.frame) / tracks.frame_rate
        # PedPy has the first frame beyond the line, which is at most one frame later.
        assert times[0] - 1 / 30 <= own.first_s <= times[0]
        assert times[-1] - 1 / 30 <= own.last_s <= times[-1]
        theirs = (len(times) - 1) / (times[-1] - times[0])
        assert own.flow_per_s == pytest.approx(theirs, abs=2 / 30 / (times[-1] - times[0]) * theirs)
    left = sum(tracks.exit_frames >= 0)
    assert table.people[table.kind == "exit"].sum() == left


def test_a_run_has_the_same_passages_as_a_plain_loop(leaving):
    plan, tracks = leaving
    rows = tracks.to_pandas()[["person", "frame", "x", "y"]]
    for opening in plan.openings():
        (ax, ay), (bx, by) = opening.a, opening.b
        passed = []
        for person, own in rows.groupby("person"):
            last = None
            for row in own.itertuples():
                side = (bx - ax) * (row.y - ay) - (by - ay) * (row.x - ax) >= 0
                along = ((row.x - ax) * (bx - ax) + (row.y - ay) * (by - ay)) / opening.length**2
                if last is not None and side != last and -0.05 < along < 1.05:
                    passed.append((person, row.frame))
                last = side
        found = crossings_of_doors(tracks, plan)[opening.name]
        frames = np.ceil(found.time * 30 - 1e-9).astype(int)
        pairs = zip(found.person.tolist(), frames.tolist(), strict=True)
        assert sorted(pairs) == sorted(passed)


def test_doors_of_a_building_are_those_of_their_level():
    hall = "POLYGON ((0 0, 24 0, 24 8, 0 8, 0 0))"
    office = two_storeys()
    ground = office.levels[0]
    floors = [
        Level(0, hall, exits=ground.exits, gates=[Gate("lobby", (2, 0), (2, 8))]),
        Level(1, hall, elevation=RISE, gates=[Gate("upstairs", (2, 0), (2, 8))]),
    ]
    building = Building(floors, office.stairs)
    # One on each level walks west over x = 2; the one downstairs goes out.
    x = np.array([3.0, 3.0, 1.0, 1.0, -0.1, 1.0])
    z = np.array([0.0, RISE] * 3)
    tracks = Trajectories(
        [0, 0, 1, 1, 2, 2],
        [0, 1] * 3,
        x,
        np.full(6, 4.0),
        0.0 * x,
        frame_rate=1.0,
        inside_at_end=np.array([1]),
        fields={"z": z, "level": (z > 0).astype(np.int16)},
    )
    table = doors(tracks, building)
    assert table.level.to_dict() == {"lobby": 0, "west": 0, "east": 0, "upstairs": 1}
    assert table.people.to_dict() == {"lobby": 1, "west": 1, "east": 0, "upstairs": 1}
    with pytest.raises(ResultsError, match="no elevations"):
        doors(Trajectories([0], [0], [1.0], [1.0], [0.0]), building)


def at_a_door(walk, gap, *, waiting=True, inside=False):
    """One frame a second: 0 passes x = 5 at 0.5 s, and 1 ``gap`` s later, after standing."""
    stand = (4.5, 2.0) if waiting else (1.0, 2.0)
    before = [stand] * (gap + 1)
    after = [] if inside else [(5.5, 2.0), (5.5, 2.0)]
    tracks = {0: (0, [(4.5, 2.0), (5.5, 2.0)] + [(8.0, 2.0)] * 2), 1: (0, before + after)}
    return walk(tracks, frame_rate=1.0)


def test_a_clog_is_a_long_gap_with_somebody_before_the_door(walk, hall):
    table = clogging(at_a_door(walk, 4), hall)
    assert table.loc["middle"].tolist() == [1, 4.0, 4.0]
    assert table.loc["east"].tolist() == [0, 0.0, 0.0]
    for tracks in (at_a_door(walk, 2), at_a_door(walk, 4, waiting=False)):
        assert clogging(tracks, hall).loc["middle"].tolist() == [0, 0.0, 0.0]
    assert clogging(at_a_door(walk, 2), hall, gap=1.5).clogs.tolist() == [1, 0]


def test_people_who_never_get_through_clog_a_door_until_the_end(walk, hall):
    table = clogging(at_a_door(walk, 7, inside=True), hall)
    assert table.loc["middle"].tolist() == [1, 6.5, 6.5]


def test_waiting_is_counted_second_by_second(walk, hall):
    # Person 0 stands for 3 s, crosses the gate, stands for 2 s, and leaves.
    ways = {
        0: (0, [(4, 2)] * 4 + [(6, 2)] * 3 + [(8, 2), (10.5, 2)]),
        1: (0, [(3, 2), (4, 2), (6, 2), (7, 2), (9, 2), (10.5, 2)]),
    }
    tracks = walk(ways, frame_rate=1.0)
    assert waiting_times(tracks).tolist() == [5.0, 0.0]
    lengths = queue_lengths(tracks, hall)
    assert [n for _, n in lengths["middle"]] == [1, 1, 1, 0, 0, 0, 0, 0, 0]
    assert [n for _, n in lengths["east"]] == [0, 0, 0, 0, 1, 1, 0, 0, 0]
    table = queues(tracks, hall)
    assert table.loc["middle"].tolist() == [1, 3.0, 3.0, pytest.approx(3 / 9), 1, 0.0]
    assert table.loc["east"].tolist() == [1, 2.0, 2.0, pytest.approx(2 / 9), 1, 4.0]


def test_nobody_waits_where_nobody_is(hall):
    nobody = Trajectories([], [], [], [], [], last_frame=30)
    assert doors(nobody, hall).people.tolist() == [0, 0]
    assert queues(nobody, hall).most_queue.tolist() == [0, 0]
    assert queues(nobody, hall).most_queue_s.isna().all()
    assert clogging(nobody, hall).clogs.tolist() == [0, 0]


@pytest.mark.parametrize("given", [{"gap": 0.0}, {"reach": np.nan}, {"gap": np.inf}])
def test_numbers_of_clogging_must_be_positive(three, hall, given):
    with pytest.raises(ResultsError, match="expected more than 0"):
        clogging(three, hall, **given)
