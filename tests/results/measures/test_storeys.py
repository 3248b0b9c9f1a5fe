"""People on storeys and stairs of a building, in tracks that are made by hand."""

import numpy as np
import pytest

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import (
    Trajectories,
    by_level,
    by_stairs,
    climbs,
    flow_over_time,
    leaving_times,
    occupancy_by_level,
    occupancy_by_stairs,
)
from tests.fixtures.buildings import RISE, two_storeys

# The straight stair falls from x = 8 to 12.93 at y = 0.6. The dog-leg falls from x = 14 to 16.32 at
# y = 7.4, to its landing at half the rise, and back to x = 14 at y = 6.
MIDDLE = (10.465, 0.6, RISE / 2)
HIGH, LOW = (8.493, 0.6, 0.9 * RISE), (12.437, 0.6, 0.1 * RISE)
LANDING = (17.0, 6.7, RISE / 2)
ON_UPPER, ON_LOWER = (15.16, 7.4, 0.75 * RISE), (15.16, 6.0, 0.25 * RISE)
UPSTAIRS, DOWNSTAIRS = (7.0, 0.6, RISE), (13.5, 0.6, 0.0)

PEOPLE = [
    # Down the straight stair, and out in the last second.
    [UPSTAIRS, UPSTAIRS, HIGH, MIDDLE, LOW, DOWNSTAIRS, DOWNSTAIRS, (-0.1, 4.0, 0.0)],
    # Up the dog-leg.
    [(13.0, 6.0, 0.0), ON_LOWER, LANDING, ON_UPPER, *[(13.0, 7.4, RISE)] * 4],
    # Onto the straight stair, back, and onto it again.
    [UPSTAIRS, UPSTAIRS, HIGH, UPSTAIRS, HIGH, MIDDLE, LOW, LOW],
]


def tracks_of(people, *, levels=True):
    """Tracks of one frame a second; person 0 has left at the end."""
    places = np.array(people, dtype=float)
    count, frames = places.shape[:2]
    x, y, z = places.transpose(1, 0, 2).reshape(-1, 3).T
    fields = {"z": z}
    if levels:
        fields["level"] = np.select([z == 0.0, z == RISE], [0, 1], -32_768).astype(np.int16)
    return Trajectories(
        np.repeat(np.arange(frames), count),
        np.tile(np.arange(count), frames),
        x,
        y,
        0.0 * x,
        frame_rate=1.0,
        inside_at_end=np.arange(1, count),
        fields=fields,
    )


@pytest.fixture(params=[True, False], ids=["levels known", "elevations alone"])
def tracks(request):
    return tracks_of(PEOPLE, levels=request.param)


def test_people_on_each_level_and_stair_second_by_second(tracks):
    office = two_storeys()
    found = occupancy_by_level(tracks, office), occupancy_by_stairs(tracks, office)
    counts = [{name: [n for _, n in curve] for name, curve in each.items()} for each in found]
    assert counts == [
        {0: [1, 0, 0, 0, 0, 1, 1, 0], 1: [2, 2, 0, 1, 1, 1, 1, 1]},
        {"south": [0, 0, 2, 1, 2, 1, 1, 1], "north": [0, 1, 1, 1, 0, 0, 0, 0]},
    ]
    assert [t for t, _ in found[0][0]] == [float(t) for t in range(8)]
    assert [t for t, _ in occupancy_by_level(tracks, office, every=3.0)[1]] == [0.0, 3.0, 6.0]


def test_when_each_person_last_left_a_level(tracks):
    times = leaving_times(tracks, two_storeys())
    assert times[1].tolist() == [2.0, np.inf, 4.0]
    np.testing.assert_array_equal(times[0], [7.0, 1.0, np.nan])


def test_the_table_of_levels(tracks):
    table = by_level(tracks, two_storeys())
    assert table.index.tolist() == [1, 0]
    assert table.loc[1, ["people", "at_start", "at_end", "most"]].tolist() == [3, 2, 1, 2]
    assert table.loc[0, ["people", "at_start", "at_end", "most"]].tolist() == [2, 1, 0, 1]
    np.testing.assert_array_equal(table.clear_s, [np.nan, 7.0])
    # 192 m2 without the strips: each 0.35 m longer than its flight, and 0.05 m wider where no wall
    # of the hall is beside it.
    free = 192.0 - 5.28 * 1.25 - 2.67 * 1.25, 192.0 - 5.28 * 1.25 - 2.67 * 1.3
    assert table.most_per_m2.tolist() == pytest.approx([2.0 / free[0], 1.0 / free[1]])


def test_the_ways_on_a_stair(tracks):
    found = climbs(tracks, two_storeys())
    south, north = found["south"], found["north"]
    assert south.person.tolist() == [0, 2, 2]
    assert south.start.tolist() == [2.0, 2.0, 4.0]
    assert south.end.tolist() == [5.0, 3.0, np.inf]
    assert south.came_by.tolist() == [1, 1, 1]
    assert south.left_by.tolist() == [-1, 1, 0]
    assert south.down.tolist() == [True, False, False]
    assert (north.person.tolist(), north.up.tolist()) == ([1], [True])
    assert (north.start.tolist(), north.end.tolist()) == ([1.0], [4.0])
    head = south.over_head()
    assert head.time.tolist() == [2.0, 2.0, 3.0, 4.0]
    assert head.person.tolist() == [0, 2, 2, 2]
    assert head.direction.tolist() == [1, 1, -1, 1]
    assert north.over_foot().direction.tolist() == north.over_head().direction.tolist() == [-1]
    assert flow_over_time(head, tracks.duration, window=5.0) == [[2.5, 0.4]]


def test_the_table_of_stairs(tracks):
    table = by_stairs(tracks, two_storeys())
    assert table.index.tolist() == ["south", "north"]
    assert table[["people", "down", "up", "most"]].to_numpy().tolist() == [
        [2, 1, 0, 2],
        [1, 0, 1, 1],
    ]
    assert table.mean_s.tolist() == [3.0, 3.0]
    # Four passages from 2 to 4 s; one alone is no flow.
    np.testing.assert_array_equal(table.head_per_s, [1.5, np.nan])
    assert table.foot_per_s.isna().all()
    areas = 4.93 * 1.2, 2 * 2.32 * 1.2 + 1.2 * 2.6
    assert table.most_per_m2.tolist() == pytest.approx([2.0 / areas[0], 1.0 / areas[1]])


def test_a_person_may_start_on_a_stair_and_nobody_need_be_there():
    office = two_storeys()
    way = climbs(tracks_of([[DOWNSTAIRS] * 2, [MIDDLE, UPSTAIRS]]), office)["south"]
    assert (way.came_by.tolist(), way.left_by.tolist()) == ([0], [1])
    assert not way.down.any()
    assert not way.up.any()
    nobody = Trajectories([], [], [], [], [], last_frame=3, fields={"z": []})
    assert by_level(nobody, office)["most"].tolist() == [0, 0]
    assert by_level(nobody, office)["clear_s"].isna().all()
    assert by_stairs(nobody, office)["people"].tolist() == [0, 0]


def test_tracks_without_elevations_are_refused():
    flat = Trajectories([0], [0], [1.0], [1.0], [0.0])
    for measure in (by_level, by_stairs, climbs, leaving_times, occupancy_by_level):
        with pytest.raises(ResultsError, match="no elevations, expected those of a building"):
            measure(flat, two_storeys())


def test_places_know_their_stairs():
    office = two_storeys()
    places = [HIGH, MIDDLE, ON_UPPER, LANDING, ON_LOWER, UPSTAIRS, (10.465, 0.6, RISE), (9, 4, 1)]
    assert office.stairs_at(places).tolist() == [0, 0, 1, 1, 1, -1, -1, -1]
