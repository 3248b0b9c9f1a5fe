"""Measured tracks on a floor plan: who is on the floor, and to which exit tracks lead."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan, Gate, Trajectories
from mesa_mobility.crowd.insertion.tracks import TrackRows
from mesa_mobility.errors import ModelError

HALL = box(0, 0, 20, 4)
WEST, EAST = Exit("west", (0, 0), (0, 4)), Exit("east", (20, 0), (20, 4))
GATE = Gate("middle", (10, 0), (10, 4))


def rows_of(*ways: list[float], exits=(WEST, EAST)):
    """Rows of people 7, 8, ... whose x are given frame by frame, on the middle of a hall."""
    person = np.repeat(np.arange(7, 7 + len(ways)), [len(way) for way in ways])
    frame = np.concatenate([np.arange(len(way)) for way in ways])
    x = np.concatenate(ways)
    order = np.lexsort((person, frame))
    tracks = Trajectories(
        frame=frame[order],
        person=person[order],
        x=x[order],
        y=np.full(len(x), 2.0),
        heading=np.zeros(len(x)),
        frame_rate=10.0,
    )
    plan = FloorPlan(HALL, exits=list(exits), gates=[GATE])
    return TrackRows.of(tracks, plan, "run.txt"), plan


@pytest.mark.parametrize(
    ("way", "exit_"),
    [
        ([1.0, 10.0, 19.5], "east"),
        ([19.0, 10.0, 0.5], "west"),
        # Nearer to the west all the time, but walking east: 7 m nearer to it.
        ([1.0, 4.0, 8.0], "east"),
        ([19.0, 16.0, 12.0], "west"),
        # At the end of the track they stand at the west exit, wherever they were before.
        ([0.2, 5.0, 0.9], "west"),
        # What lies off the floor does not count: on it, they have come from 1 to 8 m.
        ([-6.0, 1.0, 8.0, 35.0], "east"),
        ([1.0, 8.0, 8.0, -3.0], "east"),
    ],
)
def test_a_track_leads_to_the_exit_at_its_end_or_to_the_one_approached(way, exit_):
    rows, plan = rows_of([10.0, 10.0], way)
    (found,) = rows.exits(np.array([8]), plan)
    assert plan.exits[found].name == exit_


def test_exits_are_in_the_order_of_the_people_asked_for():
    rows, plan = rows_of([1.0, 8.0], [19.0, 12.0], [2.0, 19.5])
    assert rows.exits(np.array([9, 8, 7]), plan).tolist() == [1, 0, 1]


def test_rows_are_ordered_by_person_and_know_how_far_off_the_floor_they_are():
    rows, _ = rows_of([-0.4, 1.0], [20.5, 20.75])
    assert rows.person.tolist() == [7, 7, 8, 8]
    assert rows.frame.tolist() == [0, 1, 0, 1]
    np.testing.assert_allclose(rows.off, [0.4, 0.0, 0.5, 0.75])
    assert rows.on_floor.tolist() == [True, True, True, False]
    assert rows.where(3) == "run.txt: person 8, frame 1"


def test_without_exits_there_is_none_to_lead_to():
    rows, plan = rows_of([1.0, 2.0], exits=())
    with pytest.raises(ModelError, match="the floor plan has no exit, expected one where tracks"):
        rows.exits(np.array([7]), plan)
