"""Indoor maps of several levels: IMDF archives and OpenStreetMap, with stairs and lifts."""

import json
import warnings
import zipfile

import pytest

from mesa_mobility import Building, FloorPlan
from mesa_mobility.buildings import read_floor
from mesa_mobility.errors import FloorPlanError, MobilityError
from tests.floorplan.formats.mutations import damaged
from tests.floorplan.formats.test_rooms import EAST, NORTH, area, feature

KEPT = {"scale": (EAST, NORTH), "zero": (7.0, 51.0)}
BOTH = ("ground", "first")


def unit(category, level, *box, **more):
    return {**area(*box, category=category, level_id=level, **KEPT, **more), "type": "Feature"}


def opening(level, *ends):
    line = [[7 + x / EAST, 51 + y / NORTH] for x, y in ends]
    return feature("LineString", line, properties={"category": "pedestrian", "level_id": level})


def venue(ordinals=(0, 1)):
    """Two levels: a walkway 20 m by 4 m, stairs of 8 m by 3 m and a lift at its upper side, and a
    door at its left end."""
    files = {
        "venue": [{**area(0, 0, 20, 12, **KEPT), "properties": {"name": {"en": "Hall"}}}],
        "level": [
            {**area(0, 0, 20, 12, ordinal=number, **KEPT), "id": level}
            for level, number in zip(BOTH, ordinals, strict=True)
        ],
        "unit": [
            each
            for level in BOTH
            for each in (
                unit("walkway", level, 0, 0, 20, 4),
                unit("stairs", level, 5, 4, 8, 12, name={"en": "East"}),
                unit("elevator", level, 12, 4, 14, 6.2),
            )
        ],
        "opening": [
            each
            for level in BOTH
            for each in (
                opening(level, (5.5, 4), (7.5, 4)),
                opening(level, (0, 1), (0, 3)),
                opening(level, (12.5, 4), (13.5, 4)),
            )
        ],
    }
    return {
        f"{kind}.geojson": json.dumps({"type": "FeatureCollection", "features": features})
        for kind, features in files.items()
    }


def zipped(path, files):
    with zipfile.ZipFile(path, "w") as archive:
        for name, text in files.items():
            archive.writestr(f"imdf/{name}", text)
    return path


def read(path, **options):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        floor = read_floor(path, **options)
    return floor, "\n".join(str(each.message) for each in found)


def test_an_archive_of_imdf_is_a_building(tmp_path):
    building, said = read(zipped(tmp_path / "hall.zip", venue()))
    assert isinstance(building, Building)
    assert building.name == "Hall"
    assert [(each.number, each.elevation) for each in building.levels] == [(0, 0.0), (1, 3.0)]
    # The door of the upper level leads out of the building, 3 m above the ground.
    assert [len(each.exits) for each in building.levels] == [1, 0]
    assert "no exits: they lead out of a level that stairs or lifts leave" in said
    (stairs,) = building.stairs
    # 3 m in risers of 17 cm are 18: two flights, since both levels are left at the same end.
    assert (stairs.name, stairs.risers, stairs.shape) == ("East", 18, "dog_leg")
    # A width of 3 m has two flights, with 10 cm beside and between them.
    assert stairs.width == pytest.approx((3 - 0.3) / 2, abs=0.01)
    (lift,) = building.lifts
    assert lift.numbers == (0, 1)
    assert lift.width == pytest.approx(2 - 0.2, abs=0.01)
    assert "levels are taken to be 3 m apart" in said
    higher, _ = read(tmp_path / "hall.zip", height=4.0)
    assert higher.levels[1].elevation == 4.0


def test_a_folder_and_one_level_of_it(tmp_path):
    for name, text in venue().items():
        (tmp_path / name).write_text(text)
    plan, _ = read(tmp_path, level="1")
    assert isinstance(plan, FloorPlan)
    # People leave by the upper flight of the stairs, or by the lift.
    assert sorted(each.name for each in plan.exits) == ["East 2", "lift"]
    with pytest.raises(FloorPlanError, match="has no level '5', expected one of 0, 1"):
        read(tmp_path, level="5")


def test_an_archive_without_units(tmp_path):
    files = venue()
    del files["unit.geojson"]
    with pytest.raises(FloorPlanError, match=r"has 0 files unit.geojson, expected one"):
        read(zipped(tmp_path / "hall.zip", files))


def test_steps_of_openstreetmap_join_levels(tmp_path):
    """Stairs 5 m long up along x, 1.6 m wide, of 18 risers."""

    def steps(ends, **tags):
        line = [[7 + x / EAST, 51 + y / NORTH] for x, y in ends]
        return feature("LineString", line, properties={"highway": "steps", "level": "0-1", **tags})

    def written(**tags):
        halls = [area(0, 0, 20, 8, indoor="area", level=level, **KEPT) for level in ("0", "1")]
        door = feature(
            "Point", [7.0, 51 + 4 / NORTH], properties={"entrance": "main", "level": "0"}
        )
        features = [*halls, door, steps(((6, 4), (11, 4)), width="1.6", step_count="18", **tags)]
        text = json.dumps({"type": "FeatureCollection", "features": features})
        (tmp_path / "hall.geojson").write_text(text)
        return read(tmp_path / "hall.geojson")[0]

    building = written(incline="up")
    (stairs,) = building.stairs
    assert (stairs.risers, stairs.width) == (18, pytest.approx(1.6, abs=0.01))
    assert stairs.tread == pytest.approx(5 / 17, abs=1e-3)
    # Coordinates begin in the middle of the hall, whose corners are (-10, -4) and (10, 4).
    assert [each[0] for each in stairs.head] == pytest.approx([1, 1], abs=0.01)
    assert written(incline="down").stairs[0].head[0][0] == pytest.approx(-4, abs=0.01)


def test_levels_that_nothing_joins_are_read_alone(tmp_path):
    files = venue(ordinals=(0, 3))
    units = json.loads(files["unit.geojson"])
    units["features"] = [
        each for each in units["features"] if each["properties"]["category"] == "walkway"
    ]
    plan, said = read(zipped(tmp_path / "hall.zip", {**files, "unit.geojson": json.dumps(units)}))
    assert isinstance(plan, FloorPlan)
    assert "level 0 of 0, 3; --level names another" in said


@pytest.mark.parametrize("count", [40, pytest.param(1500, marks=pytest.mark.slow)])
def test_damaged_archives_are_buildings_or_refused(tmp_path, count):
    whole = zipped(tmp_path / "hall.zip", venue()).read_bytes()
    files = venue()
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    found = 0
    for number, data in enumerate(damaged(whole, count)):
        (tmp_path / "hall.zip").write_bytes(data)
        name = ("unit.geojson", "level.geojson", "opening.geojson")[number % 3]
        (tmp_path / name).write_bytes(next(damaged(files[name].encode(), 1, seed=number)))
        for path in (tmp_path / "hall.zip", tmp_path):
            try:
                found += isinstance(read(path, exits="longest")[0], Building | FloorPlan)
            except MobilityError as error:
                if "\n" in str(error):
                    raise AssertionError(repr(error)) from error
        (tmp_path / name).write_text(files[name])
    assert found > 0
