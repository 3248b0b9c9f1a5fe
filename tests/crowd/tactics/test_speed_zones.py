"""Slower in some places: at a share of the preferred speed for decisions taken there."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, SpeedZone
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.results import Trajectories, crossings
from tests.fixtures.maps import make_map, shipped_map, stand, straight
from tests.fixtures.scenes import advance, model_of, put


def strip(*zones: SpeedZone) -> FloorPlan:
    return FloorPlan(box(0, 0, 40, 2), exits=[Exit("out", (40, 0), (40, 2))], zones=zones)


def two_speeds():
    """Walking 0.5 m or 0.25 m each 12 frames: 1.25 or 0.625 m/s."""
    on = (straight(0.5, 12), straight(0.25, 12))
    return make_map([(stand(), *on), (*on, stand())])


def test_the_factor_holds_for_decisions_taken_in_the_zone_its_edge_included():
    model = model_of(strip(SpeedZone(box(3, 0, 5, 2), 0.5)), two_speeds())
    person = put(model, 2.0, 1.0, preferred_speeds=[1.25])
    ends = []
    for _ in range(14):
        advance(model, 12)
        ends.append(float(person.position[0]))
    # Half a metre up to the edge at 3, a quarter from there to the edge at 5, both of which
    # belong to the zone, then half a metre again.
    expected = [2.5, 3.0, *np.arange(3.25, 5.3, 0.25), 5.75, 6.25, 6.75]
    assert ends == pytest.approx(expected[:14], abs=1e-5)
    assert person.preferred_speed == 1.25


def test_where_zones_overlap_their_factors_multiply():
    plan = strip(SpeedZone(box(0, 0, 10, 2), 0.5), SpeedZone(box(5, 0, 15, 2), 0.4))
    points = [(2.0, 1.0), (7.0, 1.0), (12.0, 1.0), (20.0, 1.0), (10.0, 1.0)]
    assert plan.speed_factors(points).tolist() == pytest.approx([0.5, 0.2, 0.4, 1.0, 0.2])


def test_ten_metres_at_half_a_metre_a_second():
    # ISO 20414 test 3, flat: 1 m/s, half of it from x = 10 to 20 m.
    plan = strip(SpeedZone("POLYGON ((10 0, 20 0, 20 2, 10 2, 10 0))", 0.5, name="stair"))
    model = PedestrianModel(plan, mobility_map=shipped_map(), record=True, rng=1)
    model.add_pedestrians([(1.0, 1.0)], preferred_speeds=[1.0])
    model.run(max_seconds=100)
    tracks = Trajectories.of(model)
    times = [crossings(tracks, (x, 0.0), (x, 2.0)).time[0] for x in (11.5, 18.5, 22.0, 38.0)]
    assert 7.0 / (times[1] - times[0]) == pytest.approx(0.5, abs=0.05)
    assert 16.0 / (times[3] - times[2]) == pytest.approx(1.0, abs=0.05)


def test_zones_survive_a_file(tmp_path):
    plan = strip(SpeedZone(box(1, 0, 2, 2), 0.3, name="mud"))
    plan.write_geojson(tmp_path / "plan.geojson")
    again = FloorPlan.from_geojson(tmp_path / "plan.geojson")
    (zone,) = again.zones
    assert (zone.name, zone.factor) == ("mud", 0.3)
    assert zone.area.equals(box(1, 0, 2, 2))
    broken = plan.to_geojson()
    broken["features"][-1]["properties"]["factor"] = "slow"
    with pytest.raises(FloorPlanError, match="feature 2: speed zone 'mud': factor"):
        FloorPlan.from_geojson(broken)


@pytest.mark.parametrize("factor", [0.0, -0.5, 1.5, float("nan"), "half"])
def test_factors_that_cannot_be(factor):
    with pytest.raises(FloorPlanError, match="factor"):
        SpeedZone(box(0, 0, 1, 1), factor)


def test_zones_that_cannot_be():
    with pytest.raises(FloorPlanError, match="speed zone 'x'"):
        SpeedZone("POLYGON EMPTY", 0.5, name="x")
    with pytest.raises(FloorPlanError, match="no floor"):
        strip(SpeedZone(box(50, 0, 60, 2), 0.5))
    with pytest.raises(FloorPlanError, match="SpeedZone"):
        strip(box(0, 0, 1, 1))
