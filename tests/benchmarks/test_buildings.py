"""The count of what is wrong in a building, on tracks made by hand, and a few random buildings."""

import numpy as np
import pytest

from benchmarks.conflicts.buildings.counting import Crowd, count
from benchmarks.conflicts.buildings.scene import COUNTED, buildings, fastest_of, on_steps
from benchmarks.conflicts.buildings.surfaces import level_name, surfaces_of
from mesa_mobility import Building, Exit, Level, Lift, MobilityMap, PedestrianType, Trajectories
from tests.fixtures.buildings import HALL, RISE, two_storeys

HALLS = two_storeys()
# Down the straight stair from (8, 0.6) to (12.93, 0.6), and out by the eastern exit.
WAY = [(4, 4, RISE), (7.5, 0.6, RISE), (8, 0.6, RISE), (12.93, 0.6, 0), (14, 0.6, 0), (24.03, 4, 0)]
STEP = 0.04
"""Metres a frame, 1.2 m/s."""


def walk(way=WAY):
    """(n, 3) places along a line."""
    way = np.array(way, dtype=float)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(way[:, :2], axis=0).T))])
    # The last step leads as far beyond the exit as a whole one.
    at = np.linspace(0.0, along[-1], round(along[-1] / STEP))
    return np.column_stack([np.interp(at, along, axis) for axis in way.T])


def counted(*tracks, building=HALLS, rows=None, last=None, radius=0.15):
    """What is counted of people with these tracks, all from frame 0 on."""
    frame = np.concatenate([np.arange(len(track)) for track in tracks])
    person = np.repeat(np.arange(len(tracks)), [len(track) for track in tracks])
    kept = np.ones(len(frame), dtype=bool) if rows is None else rows
    exits = {level_name(each.number): [e.line for e in each.exits] for each in building.levels}
    people = len(tracks)
    crowd = Crowd(
        frame[kept],
        person[kept],
        np.concatenate(tracks)[kept],
        int(frame.max()) if last is None else last,
        np.full(people, radius),
        np.full(people, 1.5),
    )
    found = count(crowd, surfaces_of(building), exits, {"car": 1.0})
    return {name: getattr(found, name) for name in COUNTED if getattr(found, name)}, found


def test_a_walk_down_and_out_has_no_fault():
    wrong, found = counted(walk(), last=1000)
    assert wrong == {}
    assert found.left == {0}
    assert found.changes == 2  # onto the stair and off it
    assert found.inside == {}


def test_somebody_who_is_inside_at_the_end_is_counted_apart():
    wrong, found = counted(walk()[:100])
    assert wrong == {}
    assert found.inside == {0: 99}


def test_somebody_moved_through_a_floor():
    # From (6, 4) on the upper level to the same place on the lower one, and on to the exit.
    upper, lower = walk([(4, 4, RISE), (6, 4, RISE)]), walk([(6, 4, 0), (24.03, 4, 0)])
    wrong, found = counted(np.concatenate([upper, lower]))
    assert wrong == {"floor_crossings": 1, "jumps": 1}
    assert found.named[0].endswith("(6.000, 4.000, 3.060)")


def test_a_row_too_many_is_doubling_wherever_it_is():
    track = walk()
    for extra in (0, 400):
        frame = np.append(np.arange(len(track)), 200)
        exits = {"level 0": [each.line for each in HALLS.levels[0].exits]}
        crowd = Crowd(
            frame, np.append(np.zeros(len(track), int), 0), np.vstack([track, track[extra]]),
            1000, np.array([0.15]), np.array([1.5]),
        )  # fmt: skip
        assert count(crowd, surfaces_of(HALLS), exits, {}).doubled == 1
    # A second record that was never put in.
    crowd = Crowd(crowd.frame, np.append(crowd.person[:-1], 1), crowd.xyz, 1000, crowd.radii,
                  crowd.fastest)  # fmt: skip
    assert count(crowd, surfaces_of(HALLS), exits, {}).doubled == 1


def test_a_jump_on_a_floor():
    track = walk([(4, 4, RISE), (6, 4, RISE)])
    track[30:, 1] += 0.06  # a step of 0.07 m; 1.5 m/s are 0.05 m
    assert counted(track)[0] == {"jumps": 1}


def test_a_gap_and_an_end_elsewhere_than_at_an_exit_are_losses():
    track = walk()
    kept = np.ones(len(track), dtype=bool)
    kept[200] = False
    assert counted(track, rows=kept)[0] == {"lost": 1}
    assert counted(track[:200], last=1000)[0] == {"lost": 1}
    # Not at the exit, but above it.
    upper = walk([(20, 4, RISE), (23.9, 4, RISE)])
    assert counted(upper, last=1000)[0] == {"lost": 1}


def test_bodies_overlap_beside_each_other_but_not_above():
    one, other = np.tile([4.0, 4.0, RISE], (5, 1)), np.tile([4.2, 4.0, RISE], (5, 1))
    assert counted(one, other)[0] == {"overlaps": 5}
    assert counted(one, other, radius=0.1)[0] == {}
    other[:, 2] = 0.0
    assert counted(one, other)[0] == {}


def test_a_step_through_the_wall_beside_a_stair():
    # From the upper level onto the flight, 0.1 m below its head, in two steps.
    y = np.array([1.27, 1.26, 1.19, 1.18])
    z = np.where(y < 1.2, RISE * (1.0 - 0.1 / 4.93), RISE)
    wrong, _ = counted(np.column_stack([np.full(4, 8.1), y, z]))
    assert wrong == {"wall_crossings": 1, "jumps": 1}


@pytest.mark.parametrize("off", [(0, 0, 0.05), (0, 4.05, 0)])
def test_places_above_a_floor_or_beside_it_are_off(off):
    track = np.tile([4.0, 4.0, RISE], (5, 1))
    track[2] += off
    assert counted(track)[0]["off_floor"] == 1


@pytest.mark.parametrize(("frames", "jumps"), [(90, 0), (60, 60), (1, 1)])
def test_a_ride_takes_the_time_of_the_car(frames, jumps):
    # 3 m at 1 m/s are 90 frames. The car is behind the door at y = 4.
    levels = [Level(0, HALL, exits=[Exit("out", (0, 2), (0, 4))]), Level(1, HALL, 3.0)]
    building = Building(levels, lifts=[Lift("car", [0, 1], ((8.0, 4.0), (8.9, 4.0)))])
    track = np.tile([8.45, 4.8, 3.0], (frames + 20, 1))
    track[9:-10, 2], track[-10:, 2] = np.linspace(3.0, 0.0, frames + 1), 0.0
    wrong, found = counted(track, building=building)
    assert wrong == ({"jumps": jumps} if jumps else {})
    assert found.rides == int(frames > 1)


def test_who_rises_beside_a_car_is_off_the_floor():
    levels = [Level(0, HALL, exits=[Exit("out", (0, 2), (0, 4))]), Level(1, HALL, 3.0)]
    building = Building(levels, lifts=[Lift("car", [0, 1], ((8.0, 4.0), (8.9, 4.0)))])
    track = np.tile([8.45, 2.0, 3.0], (110, 1))
    track[9:100, 2], track[100:, 2] = np.linspace(3.0, 0.0, 91), 0.0
    assert counted(track, building=building)[0]["off_floor"] == 89


@pytest.mark.parametrize(("kind", "found"), [("wheelchair_manual", [0]), ("child", [])])
def test_who_does_not_use_stairs_is_found_on_them(kind, found):
    x, y, z = walk().T
    tracks = Trajectories(
        np.arange(len(x)), np.zeros(len(x), int), x, y, 0.0 * x, fields={"z": z},
        person_data={"type": np.array([kind])},
    )  # fmt: skip
    assert on_steps(tracks, HALLS, [PedestrianType.named(kind)], surfaces_of(HALLS)) == found


def test_the_fastest_movement_is_far_below_a_sprint():
    assert 1.0 < fastest_of(MobilityMap.load()) < 4.0


@pytest.mark.parametrize("seed", [4, 18])
def test_nobody_is_lost_doubled_or_through_anything_in_random_buildings(seed):
    figures = buildings(seed)
    assert figures["people"] > 0
    assert figures["changes"] > 0
    assert {name: figures[name] for name in COUNTED if figures[name]} == {}
    assert figures["stood"] == 0
