"""Everybody who walks alone keeps the speed that they want, however slow, in and out of zones."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, PedestrianType, SpeedZone
from mesa_mobility.results import Trajectories, crossings
from tests.fixtures.maps import ALL_TYPES

SLOWEST = 0.05


def off(kind, speed, factor, seed):
    """By what share somebody takes longer over 10 m than they should; nan if they never arrive."""
    zones = [SpeedZone(box(4.0, 0.0, 14.0, 2.0), factor=factor)] if factor < 1.0 else []
    plan = FloorPlan(box(0, 0, 20, 2), exits=[Exit("end", (20, 0), (20, 2))], zones=zones)
    model = PedestrianModel(plan, pedestrian_types=[kind], record=True, rng=seed)
    model.add_pedestrians([(1.0, 1.0)], headings=[0.0], preferred_speeds=[speed])
    due = 10.0 / (speed * factor)
    model.run(max_seconds=2.0 * (9.0 / speed + due))
    tracks = Trajectories.of(model)
    times = [crossings(tracks, (x, 0.0), (x, 2.0)).time for x in (4.0, 14.0)]
    if model.stalled or not all(len(each) for each in times):
        return np.nan
    return (times[1][0] - times[0][0]) / due - 1.0


def fastest(kind):
    """1.5 times the mean of a type, or the top speed that its map states."""
    metadata = kind.mobility_map.metadata
    recorded = metadata.get("walking_speed_m_s", {})
    mean = metadata.get("preferred_speed_m_s", {}).get("mean", recorded.get("p75"))
    return min(1.5 * mean, max(recorded.get("p95", np.inf), mean))


@pytest.mark.parametrize(
    ("name", "speed", "factor"),
    [
        ("wheelchair_manual", 0.1725, 0.6),
        pytest.param("slow", 0.167, 0.4, marks=pytest.mark.thorough),
        pytest.param("cane", 0.10, 0.6, marks=pytest.mark.thorough),
        pytest.param("cane", 0.15, 1.0, marks=pytest.mark.thorough),
        pytest.param("able_bodied", 0.12, 1.0, marks=pytest.mark.thorough),
    ],
)
def test_slow_people_do_not_freeze(name, speed, factor):
    assert abs(off(PedestrianType.named(name), speed, factor, 1)) <= 0.05


@pytest.mark.slow
@pytest.mark.parametrize("factor", [1.0, 0.8, 0.6, 0.4])
@pytest.mark.parametrize("name", ALL_TYPES)
def test_each_type_keeps_each_speed_in_each_zone(name, factor):
    kind = PedestrianType.named(name)
    found = {
        (round(float(speed), 3), seed): off(kind, float(speed), factor, seed)
        for speed in np.geomspace(SLOWEST, fastest(kind), 8)
        for seed in (1, 2, 3)
    }
    assert {at: share for at, share in found.items() if not abs(share) <= 0.05} == {}
