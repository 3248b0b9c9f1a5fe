"""Building models in IFC, written by IfcOpenShell and read back."""

import warnings
from pathlib import Path

import numpy as np
import pytest
import shapely

from mesa_mobility import Building, FloorPlan, PedestrianModel
from mesa_mobility.buildings import read_floor
from mesa_mobility.errors import FloorPlanError, MobilityError
from mesa_mobility.floorplan.formats.ifc import child
from tests.floorplan.formats.mutations import read_all

pytest.importorskip("ifcopenshell", reason="no IfcOpenShell: pip install 'mesa-mobility[ifc]'")
from tests.floorplan.formats.house import RISERS, TREAD, house, house_with_a_landing


def read(path, **options):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        floor = read_floor(path, **options)
    return floor, "\n".join(str(each.message) for each in found)


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return house(tmp_path_factory.mktemp("ifc") / "house.ifc")


@pytest.fixture(scope="module")
def found(path):
    return read(path)


def test_storeys_doors_and_stairs_of_a_house(found):
    building, said = found
    assert isinstance(building, Building)
    assert building.name == "Test house"
    assert [(each.number, each.name, each.elevation) for each in building.levels] == [
        (0, "Ground", 0.0),
        (1, "Loft", 3.0),
    ]
    ground, loft = building.levels
    (street,) = ground.exits
    assert (street.name, street.length) == ("Street", pytest.approx(1.0))
    assert sorted([street.a, street.b]) == [(-0.3, 1.5), (-0.3, 2.5)]
    (inner,) = ground.gates
    assert (inner.name, inner.length) == ("door 17", pytest.approx(0.9))
    assert not loft.exits
    assert "Balcony: no exit, since it leads out 3.0 m above the ground" in said
    # Both rooms, the floor in both doors, without the column.
    free = ground.area.difference(shapely.union_all(list(ground.blocked)))
    expected = 8 * 5 + 3.8 * 5 - 0.5 * 0.5 + 0.9 * 0.2 + 1.0 * 0.3
    assert free.area == pytest.approx(expected, abs=0.01)
    assert "left out the storeys Roof: they have no rooms" in said
    (stairs,) = building.stairs
    assert (stairs.name, stairs.shape, stairs.risers) == ("Main", "straight", RISERS)
    assert stairs.tread == pytest.approx(TREAD, abs=1e-3)
    # Who walks down walks against x, with smaller y on their left.
    top = 1.5 + (RISERS - 1) * TREAD
    assert np.allclose(stairs.head, [(top, 3.8), (top, 4.9)], atol=1e-3)


@pytest.mark.parametrize(
    ("scale", "schema", "flights"), [(1000.0, "IFC4", True), (1.0, "IFC2X3", False)]
)
def test_other_units_schemas_and_stairs_of_a_body_alone(tmp_path, found, scale, schema, flights):
    other, _ = read(house(tmp_path / "other.ifc", scale, schema, flights=flights))
    for one, same in zip(found[0].levels, other.levels, strict=True):
        assert one.area.symmetric_difference(same.area).area < 1e-3
    assert np.allclose(other.stairs[0].head, found[0].stairs[0].head, atol=1e-3)
    assert other.stairs[0].risers == RISERS


def test_one_level_is_left_by_its_stairs(path):
    for level in ("1", "Loft"):
        plan, _ = read(path, level=level)
        assert isinstance(plan, FloorPlan)
        assert [each.name for each in plan.exits] == ["Main"]
    plan, _ = read(path, level="0")
    assert sorted(each.name for each in plan.exits) == ["Main", "Street"]
    with pytest.raises(FloorPlanError, match=r"house.ifc: has no level '7', expected one of 0"):
        read(path, level="7")


@pytest.mark.thorough
def test_stairs_round_a_corner(tmp_path):
    """Who walks down walks against y, turns right and walks against x: eight risers, then nine."""
    building, said = read(house_with_a_landing(tmp_path / "corner.ifc"))
    (stairs,) = building.stairs
    assert (stairs.shape, stairs.flights, stairs.turns) == ("flights", (8, 9), ("right",))
    assert np.allclose(stairs.head, [(6.44, 7.16), (5.24, 7.16)], atol=2e-3)
    assert stairs.tread == pytest.approx(0.28, abs=1e-3)
    assert "taken as" not in said
    upper, lower = stairs.parts(3.0, 0.0)[0]
    assert np.allclose(upper.foot, [(6.44, 5.2), (5.24, 5.2)], atol=5e-3)
    # As in the file, but for the post of the handrail: 0.1 m further down the upper flight.
    assert np.allclose(lower.foot, [(3.0, 4.0 - 0.1), (3.0, 5.2 - 0.1)], atol=5e-3)
    model = PedestrianModel(building, record=True, rng=1)
    model.add_pedestrians(building.random_points(6, model.rng, level=1, spacing=0.5, clearance=0.3))
    model.run(max_seconds=90)
    assert model.inside == 0


@pytest.mark.thorough
def test_people_of_the_loft_walk_out(found):
    model = PedestrianModel(found[0], record=True, rng=1)
    places = found[0].random_points(4, model.rng, level=1, spacing=0.5, clearance=0.3)
    model.add_pedestrians(places)
    model.run(max_seconds=90)
    assert model.inside == 0


def test_faulty_files_and_a_missing_library(tmp_path, path, monkeypatch):
    other = tmp_path / "other.ifc"
    with pytest.raises(FloorPlanError, match=r"other.ifc: cannot be read \(No such file"):
        FloorPlan.from_file(other)
    other.write_text("nothing")
    with pytest.raises(FloorPlanError, match="is no IFC, expected a text that begins with ISO"):
        FloorPlan.from_file(other)
    other.write_text("ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\nENDSEC;\n")
    with pytest.raises(FloorPlanError, match=r"has no rooms and no slabs|cannot be read as IFC"):
        FloorPlan.from_file(other)
    monkeypatch.setattr(child, "LEAST_S", 0.01)
    monkeypatch.setattr(child, "S_PER_MB", 0.0)
    with pytest.raises(FloorPlanError, match="cannot be read within 0 s"):
        FloorPlan.from_file(path)
    monkeypatch.setattr(child, "find_spec", lambda name: None)
    with pytest.raises(MobilityError, match=r"pip install 'mesa-mobility\[ifc\]'"):
        FloorPlan.from_file(path)


@pytest.mark.parametrize(
    "count",
    [pytest.param(15, marks=pytest.mark.thorough), pytest.param(1500, marks=pytest.mark.slow)],
)
def test_damaged_files_are_plans_or_refused(tmp_path, path, count):
    assert read_all(Path(path).read_bytes(), tmp_path / "house.ifc", count) > 0


def test_rooms_have_the_names_and_areas_of_the_file(found):
    building, _ = found
    rooms = {each.name: each for each in building.rooms}
    # 8 m x 5 m, 3.8 m x 5 m with a column, and 12 m x 5 m above the stairs.
    assert {name: each.area for name, each in rooms.items()} == pytest.approx(
        {"101 Hall": 40.0, "102 Office": 19.0, "201 Loft": 60.0}
    )
    assert [each.level for each in building.rooms] == [0, 0, 1]
    stated = {name: each.stated_area for name, each in rooms.items()}
    assert stated == {"101 Hall": None, "102 Office": 21.2, "201 Loft": None}
    assert rooms["102 Office"].doors == ("door 17",)
    assert {"Street", "door 17"} <= set(rooms["101 Hall"].doors)
