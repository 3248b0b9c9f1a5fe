"""Wheelchairs: what their options must keep, worked out from the paths."""

import itertools
import math

import numpy as np
import pytest

from mesa_mobility.mobility import WHEELCHAIRS, MobilityMap, abilities_of

# Free speeds of Boyce, Shields and Silcock (1999), m/s.
SPEEDS = {"wheelchair_manual": 0.69, "wheelchair_powered": 0.89, "wheelchair_assisted": 1.30}

STEP_S = 0.1

# Paths are kept in steps of half a millimetre and 0.2 milliradians.
ROUNDING_M, ROUNDING_RAD = 0.0005, 0.0002


@pytest.fixture(scope="module", params=WHEELCHAIRS)
def chair(request) -> MobilityMap:
    return WHEELCHAIRS[request.param].build(request.param)


def paths_of(map_):
    """The path of every seventh option, with its start."""
    for row in range(0, map_.n_options, 7):
        samples = map_.paths[map_.path_offsets[row] : map_.path_offsets[row + 1]]
        yield row, np.concatenate([np.zeros((1, 3)), samples.astype(float)])


def signed_speeds(path):
    """Speed along the mean heading of each step, and across it."""
    steps, heading = np.diff(path[:, :2], axis=0), path[:-1, 2] + 0.5 * np.diff(path[:, 2])
    along = steps[:, 0] * np.cos(heading) + steps[:, 1] * np.sin(heading)
    across = steps[:, 1] * np.cos(heading) - steps[:, 0] * np.sin(heading)
    return along / STEP_S, across / STEP_S


def test_wheels_do_not_slip(chair):
    for row, path in paths_of(chair):
        _, across = signed_speeds(path)
        # Where the speed changes within a step, its chord is a little off the mean heading.
        assert np.abs(across).max() < 0.02, row


def test_speeds_change_within_the_limits(chair):
    limits = WHEELCHAIRS[chair.pedestrian_type].drive
    for row, path in paths_of(chair):
        along, _ = signed_speeds(path)
        change = np.diff(along) / STEP_S
        slack = 4 * ROUNDING_M / STEP_S**2
        assert change.max(initial=0.0) < limits.acceleration + slack, row
        assert change.min(initial=0.0) > -limits.braking - slack, row
        assert along.max() < limits.fastest + 2 * ROUNDING_M / STEP_S, row


def test_turns_are_the_wider_the_quicker(chair):
    limits = WHEELCHAIRS[chair.pedestrian_type].drive
    for row, path in paths_of(chair):
        along, _ = signed_speeds(path)
        rate = np.abs(np.diff(path[:, 2])) / STEP_S
        assert rate.max() < limits.turn_rate + 2 * ROUNDING_RAD / STEP_S, row
        assert (rate * np.abs(along)).max() < limits.lateral_acceleration + 0.05, row


def test_it_turns_right_round_within_the_turning_circle(chair):
    """1.5 m across (DIN 18040-1); in place, the footprint sweeps its diagonal, 1.39 m."""
    body = chair.metadata["body"]
    rows = np.asarray(chair.options_of(chair.standing))
    spot = rows[np.hypot(*chair.end_points[rows].T) == 0.0]
    spot = spot[chair.end_clusters[spot] == chair.standing]
    right_round = math.ceil(2 * math.pi / chair.end_headings[spot].max() - 0.01)
    assert right_round <= 5
    moved = max(
        np.abs(chair.paths[chair.path_offsets[k] : chair.path_offsets[k + 1], :2]).max()
        for k in spot.tolist()
    )
    # None of these options leaves the place on its way.
    assert moved == 0.0
    assert math.hypot(body["length_m"], body["width_m"]) <= 1.5
    assert min(abilities_of(chair)["turn_on_the_spot_deg"]) >= 89.9


def test_it_reaches_its_speed_and_stops(chair):
    """Between neighbouring speeds within 0.4 s, and from each speed to standing."""
    limits = WHEELCHAIRS[chair.pedestrian_type].drive
    speeds = np.round(chair.mean_speeds.astype(float), 3)
    assert speeds[chair.standing] == 0.0
    assert speeds.max() == pytest.approx(limits.fastest)
    wanted = WHEELCHAIRS[chair.pedestrian_type].speed
    assert speeds.max() >= wanted.mean + wanted.deviation
    forwards = [chair.standing, *range(2, chair.n_clusters)]
    for cluster, quicker in itertools.pairwise(forwards):
        rows = np.asarray(chair.options_of(cluster))
        short = chair.durations[rows] == 12
        assert quicker in chair.end_clusters[rows[short]]
        assert cluster in chair.end_clusters[rows[short]]
    for cluster in forwards[1:]:
        rows = np.asarray(chair.options_of(cluster))
        stops = rows[chair.end_clusters[rows] == chair.standing]
        # The longest options are of 1.5 s.
        assert (len(stops) > 0) == (speeds[cluster] <= 1.5 * limits.braking)
        if not len(stops):
            continue
        ahead = chair.end_points[stops, 0].astype(float)
        # Not shorter than braking takes: v squared over twice the deceleration.
        shortest = speeds[cluster] ** 2 / (2 * limits.braking)
        straight = np.abs(chair.end_headings[stops]) == 0.0
        assert ahead[straight].min() >= shortest - ROUNDING_M


def test_speeds_and_footprint_are_those_of_the_sources(chair):
    metadata = chair.metadata
    assert metadata["preferred_speed_m_s"]["mean"] == SPEEDS[chair.pedestrian_type]
    assert metadata["body"]["core_radius_m"] == 0.35
    assert (metadata["body"]["length_m"], metadata["body"]["width_m"]) == (1.2, 0.7)
    assert "nobody is recorded" in metadata["derived"]["by"]


def test_it_backs_off_slowly(chair):
    """Without that, nobody who faces a wall closely could turn a long body."""
    rows = np.asarray(chair.options_of(chair.standing))
    back = chair.end_points[rows, 0].min()
    assert -0.35 < back < -0.1
