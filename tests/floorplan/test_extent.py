"""Plans too large, too small, or in another unit than metres."""

import json
import subprocess
import sys
import warnings

import pytest
from shapely import Polygon, affinity, box
from shapely.geometry import mapping, shape

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, FloorPlan, SpeedZone


def hall(width, height, door=1.0, **parts):
    return FloorPlan(box(0, 0, width, height), exits=[Exit("out", (0, 0), (0, door))], **parts)


def test_twenty_kilometres_are_accepted():
    assert hall(20_000, 20_000).bounds == (0, 0, 20_000, 20_000)


@pytest.mark.parametrize(
    ("width", "height", "says"),
    [
        (20_001, 10, "the walkable area is 20001 by 10 m, expected at most 20000 m either way"),
        (
            10,
            30_000,
            r"10 by 30000 m, .* 20000 m either way .are its coordinates millimetres",
        ),
        (1e8, 1e8, r"1e\+08 by 1e\+08 m, expected at most 20000 m"),
        (1e12, 1e12, "walkable area has coordinates up to 1e.12, expected metres, at most 1e.08"),
        (1e300, 1e300, "walkable area has coordinates up to 1e.300"),
        (0.0012, 0.0007, "0.0012 by 0.0007 m, too small to stand in: .* like degrees of long"),
    ],
)
def test_plans_of_another_size(width, height, says):
    with pytest.raises(FloorPlanError, match=says) as error:
        hall(width, height, door=0.5 * height)
    assert "\n" not in str(error.value)


def test_degrees_are_recognised_by_their_values():
    house = box(13.3761, 52.5186, 13.3773, 52.5191)
    with pytest.raises(FloorPlanError, match="look like degrees of longitude and latitude"):
        FloorPlan(house, exits=[Exit("e", (13.3761, 52.5187), (13.3761, 52.5188))])
    dot = affinity.translate(box(0, 0, 0.1, 0.1), 500, 0)
    with pytest.raises(FloorPlanError, match=r"too small to stand in: expected metres$"):
        FloorPlan(dot, exits=[Exit("e", (500, 0), (500, 0.1))])


def test_coordinates_of_a_national_grid_are_accepted():
    plan = FloorPlan(
        box(32_500_000, 5_600_000, 32_500_010, 5_600_010),
        exits=[Exit("e", (32_500_000, 5_600_001), (32_500_000, 5_600_002))],
    )
    assert plan.area == 100


def test_obstacles_and_zones_beyond_the_planet_are_refused():
    far = Polygon([(0, 0), (1e12, 0), (0, 1e12)])
    with pytest.raises(FloorPlanError, match=r"obstacle 0 has coordinates up to 1e.12"):
        hall(10, 10, obstacles=[far])
    with pytest.raises(FloorPlanError, match=r"speed zone has coordinates up to 1e.12"):
        SpeedZone(far, 0.5)


def collection(scale):
    plan = hall(12, 8).to_geojson()
    for feature in plan["features"]:
        polygon = feature["geometry"]["type"] == "Polygon"
        rings = feature["geometry"]["coordinates"]
        rings = rings if polygon else [rings]
        scaled = [[[x * scale, y * scale] for x, y in ring] for ring in rings]
        feature["geometry"]["coordinates"] = scaled if polygon else scaled[0]
    return plan


def test_a_plan_in_millimetres_gives_a_warning_with_its_size():
    with pytest.warns(UserWarning, match="12000 by 8000 m .* opening 1000 m wide: .* millimetres"):
        FloorPlan.from_geojson(collection(1000))
    wkt = "POLYGON((0 0, 12000 0, 12000 8000, 0 8000, 0 0))"
    for make in (FloorPlan.from_wkt, FloorPlan):
        with pytest.warns(UserWarning, match="12000 by 8000 m .* millimetres"):
            make(wkt, exits=[Exit("e", (0, 0), (0, 900))])


def test_a_plan_that_may_be_in_degrees_gives_a_warning_with_its_size():
    plan = hall(12, 8).to_geojson()
    for feature in plan["features"]:
        feature["geometry"] = mapping(
            affinity.scale(shape(feature["geometry"]), 0.05, 0.05, origin=(0, 0))
        )
    with pytest.warns(UserWarning, match=r"0.6 by 0.4 m: expected metres, found .* degrees"):
        FloorPlan.from_geojson(plan)
    with pytest.warns(UserWarning, match=r"0.5 by 0.4 m: .* degrees of longitude and latitude"):
        hall(0.5, 0.4, door=0.4)


def test_plans_in_metres_give_none():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        FloorPlan.from_geojson(collection(1))
        hall(1, 1)
        FloorPlan.from_geojson(hall(5000, 5000, door=5).to_geojson())


@pytest.mark.parametrize("closed", ["yes", 1, None, "true", [], 0])
def test_closed_is_true_or_false(closed):
    plan = collection(1)
    plan["features"][1]["properties"]["closed"] = closed
    with pytest.raises(FloorPlanError, match="feature 1: closed must be true or false, found"):
        FloorPlan.from_geojson(plan)
    for answer in (True, False):
        plan["features"][1]["properties"]["closed"] = answer
        assert FloorPlan.from_geojson(plan).is_open("out") is not answer


@pytest.mark.parametrize("digits", [400, 5000])
def test_numbers_of_hundreds_of_digits(digits, tmp_path):
    path = tmp_path / "plan.geojson"
    path.write_text(json.dumps(collection(1)).replace("12", "1" * digits, 1))
    with pytest.raises(FloorPlanError, match=r"plan\.geojson: ") as error:
        FloorPlan.from_geojson(path)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "wkt",
    [
        "CURVEPOLYGON(CIRCULARSTRING(0 0, 4 0, 4 4, 0 4, 0 0))",
        "curvepolygon z((0 0, 4 0, 4 4, 0 4, 0 0))",
        "GEOMETRYCOLLECTION(POLYGON((0 0, 4 0, 4 4, 0 4, 0 0)))",
        "TIN(((0 0, 4 0, 4 4, 0 0)))",
        "POLYGONE((0 0, 4 0, 4 4, 0 0))",
    ],
)
def test_other_shapes_in_wkt(wkt):
    with pytest.raises(FloorPlanError, match=r"walkable area: the WKT cannot be read .*POLYGON"):
        FloorPlan.from_wkt(wkt, exits=[Exit("e", (0, 0), (0, 1))])


def test_shapes_within_shapes_do_not_end_the_process():
    code = (
        "from mesa_mobility import FloorPlan\n"
        "try:\n    FloorPlan('GEOMETRYCOLLECTION(' * 300_000 + 'POINT(0 0)' + ')' * 300_000)\n"
        "except Exception as error:\n    print(error)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0
    assert "the WKT cannot be read" in done.stdout
