"""Floor plans as text with WKT."""

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility import FloorPlan
from mesa_mobility.errors import FloorPlanError

TEXT = """
# A hall with a corridor, in metres.
walkable the hall POLYGON ((0 0, 12 0, 12 3, 20 3, 20 5, 12 5, 12 8, 0 8, 0 0))
obstacle POLYGON ((4 3, 6 3, 6 5, 4 5, 4 3))
exit main street LINESTRING (20 3, 20 5)
Gate corridor closed=true LineString (12 3, 12 5)
zone stairs factor=0.5 POLYGON ((14 3, 18 3, 18 5, 14 5, 14 3))
"""


@pytest.fixture
def written(tmp_path):
    def write(text):
        (tmp_path / "hall.wkt").write_text(text)
        return tmp_path / "hall.wkt"

    return write


def test_every_part_of_a_line(written):
    plan = FloorPlan.from_file(written(TEXT))
    assert (plan.name, plan.version) == ("the hall", 0)
    assert plan.walkable.area == 12 * 8 + 8 * 2
    assert [each.area for each in plan.obstacles.values()] == [4.0]
    assert [(each.name, each.a, each.b) for each in plan.exits] == [
        ("main street", (20, 3), (20, 5))
    ]
    assert [each.name for each in plan.gates] == ["corridor"]
    assert not plan.is_open("corridor")
    assert [(zone.name, zone.factor, zone.area.area) for zone in plan.zones] == [("stairs", 0.5, 8)]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("door LINESTRING (0 0, 0 1)", "line 8: property kind must be one of walkable, ob"),
        ("exit here", "line 8: 'exit here', expected one of walkable, obstacle"),
        ("POLYGON ((0 0, 1 0, 1 1, 0 0))", "line 8: 'POLYGON"),
        ("exit x POLYGON ((0 0, 1 0, 1 1, 0 0))", "line 8: exit must be a LineString, found Poly"),
        ("exit x LINESTRING (0 0, 0 1", r"line 8: exit: the WKT cannot be read \("),
        ("exit LINESTRING (0 0, 0 1)", "line 8: exit name must be a text"),
        ("exit x closed=yes LINESTRING (0 0, 0 1)", "line 8: closed must be true or false"),
        ("zone x factor=2 POLYGON ((0 0, 1 0, 1 1, 0 0))", "line 8: "),
        ("exit x LINESTRING (0 0, 0 1, 0 2)", "line 8: exit must have two points, found 3"),
        ("walkable POLYGON ((0 0, 1 0, 1 1, 0 0))", "expected one walkable area, found 2"),
    ],
)
def test_a_wrong_line_is_named(written, line, message):
    path = written(TEXT + line)
    with pytest.raises(FloorPlanError, match=message) as found:
        FloorPlan.from_file(path)
    assert str(found.value).startswith(f"{path}: ")


def test_other_files(tmp_path):
    (tmp_path / "a.wkt").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(FloorPlanError, match="is not text, expected lines of WKT"):
        FloorPlan.from_file(tmp_path / "a.wkt")
    with pytest.raises(FloorPlanError, match="cannot be read"):
        FloorPlan.from_file(tmp_path / "b.wkt")
    with pytest.raises(
        FloorPlanError, match=r"c.shp: expected a name that ends in .dxf, .*.scenario, .wkt$"
    ):
        FloorPlan.from_file(tmp_path / "c.shp")


sizes = st.floats(1.0, 390.0, allow_nan=False)


@given(sizes, sizes)
def test_coordinates_come_back_to_the_last_bit(tmp_path_factory, width, height):
    path = tmp_path_factory.mktemp("wkt") / "box.wkt"
    box = shapely.box(0, 0, width, height)
    path.write_text(
        f"walkable {shapely.to_wkt(box, rounding_precision=-1)}\n"
        f"exit door LINESTRING ({width!r} 0, {width!r} {height!r})\n"
    )
    plan = FloorPlan.from_file(path)
    assert plan.walkable.equals_exact(box, 0.0)
    assert (plan.exits[0].a, plan.exits[0].b) == ((width, 0.0), (width, height))
