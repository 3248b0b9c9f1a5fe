"""Geometries in WKT that are floor, without a word of what they are."""

import warnings

import pytest

from mesa_mobility import FloorPlan
from mesa_mobility.errors import FloorPlanError
from tests.floorplan.formats.mutations import read_all

T = "POLYGON ((-2 0, -2 6, -10 6, -10 10, 10 10, 10 6, 2 6, 2 0, -2 0))"
"""20 m by 4 m, and 4 m by 6 m below it."""


@pytest.fixture
def read(tmp_path):
    def reading(text, exits="longest"):
        (tmp_path / "hall.wkt").write_bytes(text if isinstance(text, bytes) else text.encode())
        return FloorPlan.from_file(tmp_path / "hall.wkt", exits=exits)

    return reading


@pytest.mark.parametrize(
    "text",
    [
        T,
        f"\ufeff{T}\n",
        f"# a hall\nSRID=32632;{T}",
        f"GEOMETRYCOLLECTION ({T})",
        f"GEOMETRYCOLLECTION (GEOMETRYCOLLECTION ({T}, POLYGON EMPTY))",
        T.replace(", ", ",\n  "),
        T.lower(),
        T.replace("POLYGON", "POLYGON Z").replace(",", " 0,").replace("))", " 0))"),
    ],
)
def test_one_floor(read, text):
    plan = read(text)
    assert plan.area == 20 * 4 + 4 * 6
    (door,) = plan.exits
    # In the middle of the longest edge, from (-10, 10) to (10, 10).
    assert sorted([door.a, door.b]) == [pytest.approx((-0.6, 10)), pytest.approx((0.6, 10))]


def test_parts_that_touch_are_one_floor_and_others_are_named(read):
    rooms = [(0, 0, 4, 3), (4, 0, 8, 3), (8.04, 0, 12, 3), (12.2, 0, 14, 3)]
    text = "MULTIPOLYGON (" + ", ".join(
        f"(({a} {b}, {c} {b}, {c} {d}, {a} {d}, {a} {b}))" for a, b, c, d in rooms
    )
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        plan = read(text + ")")
    assert plan.area == pytest.approx(12 * 3)
    said = [str(each.message).partition("hall.wkt: ")[2] for each in found]
    assert said == [
        "3 areas that touch are joined to one floor",
        "left out geometry 1: 5.40 m² around (13.10, 1.50), 0.20 m from the rest of the floor",
    ]


def test_a_slit_within_one_part_stays_a_wall(read):
    text = "POLYGON ((0 0, 4 0, 4 3, 4.04 3, 4.04 0, 8 0, 8 6, 0 6, 0 0)), "
    text += "POLYGON ((20 0, 21 0, 21 1, 20 0))"
    with pytest.warns(UserWarning, match="left out geometry 2"):
        assert read(text).area == pytest.approx(8 * 6 - 0.04 * 3)


def test_degrees_become_metres(read):
    text = "SRID=4326;POLYGON ((7 50.9999, 7.0001 50.9999, 7.0001 51.0001, 7 51.0001, 7 50.9999))"
    with pytest.warns(UserWarning, match="longitude 7.000050, latitude 51.000000"):
        width, south, east, north = (round(each, 3) for each in read(text).bounds)
    # A degree at 51 degrees north on WGS 84: 70,197.6 m of longitude, 111,248.3 m of latitude.
    assert (-width, -south, east, north) == pytest.approx((3.510, 11.125, 3.510, 11.125), abs=1e-3)


@pytest.mark.parametrize(
    ("exits", "ends"),
    [
        ("-1 0, 1 0", [[(-1, 0), (1, 0)]]),
        ("-1 0.5, 1 0.5", [[(-1, 0), (1, 0)]]),
        ("-10 7, -10 9; 10 7, 10 9", [[(-10, 7), (-10, 9)], [(10, 7), (10, 9)]]),
    ],
)
@pytest.mark.filterwarnings("ignore:.*moved to the edge")
def test_lines_of_exits(read, exits, ends):
    found = [sorted([each.a, each.b]) for each in read(T, exits).exits]
    assert found == [[pytest.approx(a), pytest.approx(b)] for a, b in ends]


def test_a_file_of_exits(read, tmp_path):
    lines = "# doors\nsouth -1 0, 1 0\nexit north LINESTRING (4 10, 6 10)\n"
    (tmp_path / "doors.txt").write_text(lines)
    plan = read(T, str(tmp_path / "doors.txt"))
    assert [(each.name, each.length) for each in plan.exits] == [("south", 2), ("north", 2)]


@pytest.mark.parametrize(
    ("exits", "message"),
    [
        ("shortest", "--exits: got 'shortest', expected longest, lines 'x1 y1, x2 y2' or a file"),
        ("0 3, 1 3", r"--exits: exit 'exit 1': it is 1.00 m from the edge"),
        ("0 0, 0 0", "--exit: both ends are the same, expected 'x1 y1, x2 y2' in metres"),
        ("0 0, 1 0; 0 0, 1", "--exit: got '0 0, 1', expected 'x1 y1"),
        ("1e9 0, 1 0", "--exit has coordinates up to 1e"),
        (None, "has no exit, and no gate that people could go to: --exits longest makes one"),
    ],
)
def test_wrong_exits(read, exits, message):
    with pytest.raises(FloorPlanError, match=message):
        read(T, exits)


def test_exits_of_the_file_count_more(read):
    text = "walkable POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))\nexit street LINESTRING (6 1, 6 3)"
    with pytest.warns(UserWarning, match="--exits is ignored: the file has 1 exit$"):
        assert [each.name for each in read(text).exits] == ["street"]
    bare = read(text.splitlines()[0])
    assert [each.length for each in bare.exits] == pytest.approx([1.2])


def test_an_outline_that_crosses_itself_is_mended(read):
    with pytest.warns(UserWarning, match="geometry 1 was mended: .*Self-intersection"):
        plan = read("POLYGON ((0 0, 8 0, 8 6, 0 6, 0 0, 0 3, -1 3, 0 2, 0 0))")
    assert plan.area == pytest.approx(48.5)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("POLYGON ((0 0, 1 0", "geometry 1: the WKT cannot be read"),
        ("POINT (1 1)", "has no area to walk on, expected a polygon"),
        ("GEOMETRYCOLLECTION (" * 200_000, "cannot be read|nest deeper than 8"),
        ("GEOMETRYCOLLECTION (" * 20 + T + ")" * 20, "nest deeper than 8"),
        (T + " and so on", "'and so on', expected a geometry in WKT"),
        (b"\xff\xfe\x00", "is not text, expected lines of WKT"),
        ("POLYGON ((0 0, 1e9 0, 1 1, 0 0))", "coordinates up to 1e"),
        ("POLYGON ((0 0, 1 0, 0 0))", "geometry 1: the WKT cannot be read|no area to walk on"),
    ],
)
@pytest.mark.filterwarnings("ignore:.*left out")
def test_what_is_no_floor(read, text, message):
    with pytest.raises(FloorPlanError, match=message) as found:
        read(text)
    assert "\n" not in str(found.value)


@pytest.mark.parametrize("count", [60, pytest.param(1500, marks=pytest.mark.slow)])
def test_damaged_files_are_plans_or_refused(tmp_path, count):
    whole = f"\ufeffSRID=25832;GEOMETRYCOLLECTION ({T}, POLYGON ((10 6, 14 6, 14 10, 10 10, 10 6)))"
    assert read_all(whole.encode(), tmp_path / "hall.wkt", count) > count // 20
