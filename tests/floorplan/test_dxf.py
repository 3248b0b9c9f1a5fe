"""Floor plans drawn in CAD, written by ezdxf and read back."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility import FloorPlan
from mesa_mobility.errors import FloorPlanError

ezdxf = pytest.importorskip("ezdxf", reason="no ezdxf: pip install 'mesa-mobility[cad]'")

METRES_OF_CODE = {1: 0.0254, 2: 0.3048, 4: 0.001, 5: 0.01, 6: 1.0, 10: 0.9144, 14: 0.1}
"""Metres in the unit of each code of $INSUNITS, from the DXF reference of Autodesk."""


def drawn(path, draw, units=6):
    """A file with what ``draw`` puts into model space."""
    document = ezdxf.new(units=units)
    draw(document.modelspace())
    document.saveas(path)
    return path


def outline(space, points, layer, close=True):
    space.add_lwpolyline(points, close=close, dxfattribs={"layer": layer})


def line(space, a, b, layer):
    space.add_line(a, b, dxfattribs={"layer": layer})


def room(space, scale=1.0, layers=("walkable", "exit street")):
    """A room of 6 by 4 m with a door of 1 m."""
    outline(space, [(0, 0), (6 * scale, 0), (6 * scale, 4 * scale), (0, 4 * scale)], layers[0])
    line(space, (6 * scale, 1.5 * scale), (6 * scale, 2.5 * scale), layers[1])


@pytest.mark.parametrize("code", METRES_OF_CODE)
def test_a_plan_is_in_metres_whatever_its_unit(tmp_path, code):
    scale = 1 / METRES_OF_CODE[code]
    plan = FloorPlan.from_file(drawn(tmp_path / "room.dxf", lambda s: room(s, scale), code))
    assert plan.bounds == pytest.approx((0, 0, 6, 4), abs=1e-9)
    assert plan.area == pytest.approx(24.0)
    (street,) = plan.exits
    assert (street.name, street.length) == ("street", pytest.approx(1.0))


def test_a_unit_that_is_named_counts_instead(tmp_path):
    path = drawn(tmp_path / "room.dxf", lambda s: room(s, 1000.0), units=0)
    with pytest.raises(
        FloorPlanError, match=r"room.dxf: does not say its unit.*expected one of mm"
    ):
        FloorPlan.from_dxf(path)
    assert FloorPlan.from_dxf(path, unit="mm").area == pytest.approx(24.0)
    with pytest.raises(FloorPlanError, match="unit: got 'miles', expected one of mm, cm"):
        FloorPlan.from_dxf(path, unit="miles")


def test_other_units_are_refused_by_their_code_and_absurd_ones_by_their_extent(tmp_path):
    with pytest.raises(FloorPlanError, match="has unit 19"):
        FloorPlan.from_dxf(drawn(tmp_path / "a.dxf", room, units=19))
    with pytest.raises(FloorPlanError, match="60000 by 40000 m, expected at most 20000 m"):
        FloorPlan.from_dxf(drawn(tmp_path / "b.dxf", lambda s: room(s, 10_000.0)))


def test_every_part_from_its_layer(tmp_path):
    def draw(space):
        outline(space, [(0, 0), (10, 0), (10, 8), (0, 8)], "WALKABLE hall")
        outline(space, [(4, 3), (6, 3), (6, 5), (4, 5)], "WALKABLE hall")  # a hole
        space.add_circle((8, 6), 0.5, dxfattribs={"layer": "Obstacle"})
        line(space, (5, 0), (5, 3), "GATE_passage")
        line(space, (10, 1), (10, 2), "EXIT")
        line(space, (10, 6), (10, 7), "EXIT")
        space.add_text("the hall", dxfattribs={"layer": "WALKABLE hall"})
        line(space, (-5, -5), (20, 20), "A-GRID")

    plan = FloorPlan.from_dxf(drawn(tmp_path / "hall.dxf", draw))
    assert plan.name == "hall"
    assert plan.walkable.area == pytest.approx(80 - 4)
    (pillar,) = plan.obstacles.values()
    # Chords within 5 mm of a circle of 0.5 m enclose at most 2 % less.
    assert math.pi * 0.25 * 0.98 < pillar.area <= math.pi * 0.25
    assert [(each.name, each.a, each.b) for each in plan.gates] == [("passage", (5, 0), (5, 3))]
    assert [each.name for each in plan.exits] == ["exit 1", "exit 2"]


def test_layers_of_other_names(tmp_path):
    layers = {"A-SLAB": "walkable", "A-DOOR": "exit street"}
    path = drawn(tmp_path / "room.dxf", lambda s: room(s, layers=tuple(layers)))
    assert FloorPlan.from_dxf(path, layers=layers).exits[0].name == "street"
    with pytest.raises(
        FloorPlanError, match="has no layer of kind walkable; it has drawings on A-"
    ):
        FloorPlan.from_file(path)
    with pytest.raises(FloorPlanError, match="has no layer A-WALL; it has drawings on A-DOOR, A-S"):
        FloorPlan.from_dxf(path, layers={**layers, "A-WALL": "obstacle"})
    with pytest.raises(FloorPlanError, match="layer A-DOOR: got 'way out', expected one of walk"):
        FloorPlan.from_dxf(path, layers={**layers, "A-DOOR": "way out"})


def test_blocks_are_drawn_where_they_stand_and_on_the_layer_on_which_they_stand(tmp_path):
    document = ezdxf.new(units=6)
    pillar = document.blocks.new("pillar")
    outline(pillar, [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)], "0")
    pair = document.blocks.new("pair")
    pair.add_blockref("pillar", (0, 0), dxfattribs={"layer": "0"})
    pair.add_blockref("pillar", (2, 0), dxfattribs={"layer": "0"})
    space = document.modelspace()
    room(space)
    turned = {"layer": "obstacle", "rotation": 90.0}
    space.add_blockref("pair", (2, 1), dxfattribs=turned)
    document.saveas(tmp_path / "room.dxf")
    plan = FloorPlan.from_file(tmp_path / "room.dxf")
    centres = sorted((each.centroid.x, each.centroid.y) for each in plan.obstacles.values())
    assert centres == [pytest.approx((2, 1)), pytest.approx((2, 3))]
    assert plan.area == pytest.approx(24 - 2)


def test_an_island_in_a_hole_is_an_obstacle_of_its_own(tmp_path):
    def square(space, half):
        ring = [
            (3 - half, 2 - half),
            (3 + half, 2 - half),
            (3 + half, 2 + half),
            (3 - half, 2 + half),
        ]
        outline(space, ring, "obstacle")

    def draw(space):
        room(space)
        # The gap between hole and island has no room for anybody, whom it would lock in.
        for half in (1.5, 0.55, 0.5):
            square(space, half)

    found = FloorPlan.from_dxf(drawn(tmp_path / "a.dxf", draw)).obstacles.values()
    assert sorted(each.area for each in found) == pytest.approx([1.0, 9.0 - 1.21])


def test_rooms_that_share_a_wall_are_one_floor(tmp_path):
    def draw(space):
        outline(space, [(0, 0), (4, 0), (4, 4), (0, 4)], "walkable")
        outline(space, [(4, 0), (8, 0), (8, 4), (4, 4)], "walkable")
        line(space, (8, 1), (8, 3), "exit")

    plan = FloorPlan.from_dxf(drawn(tmp_path / "a.dxf", draw))
    assert plan.walkable.area == pytest.approx(32.0)
    assert [each.name for each in plan.exits] == ["exit"]


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda s: line(s, (0, 0), (5, 0), "walkable"), r"an outline is open at \("),
        (
            lambda s: s.add_3dface([(0, 0), (1, 0), (1, 1)], dxfattribs={"layer": "walkable"}),
            r"3DFACE #\w+ on layer walkable: expected lines, polylines",
        ),
        (lambda s: outline(s, [(0, 0), (4, 4), (4, 0), (0, 4)], "walkable"), "not valid: Self-in"),
        (lambda s: outline(s, [(0, 0), (6e9, 0), (6, 4), (0, 4)], "walkable"), "up to 6e"),
        (
            lambda s: (room(s), outline(s, [(6, 0), (6, 1), (6, 1.2)], "exit b", close=False)),
            "exit must have two points, found 3",
        ),
        (
            lambda s: (room(s), outline(s, [(9, 9), (12, 9), (12, 12)], "walkable")),
            "walkable must be a Polygon, found MultiPolygon",
        ),
        (lambda s: None, "has no layer of kind walkable; it has drawings on none"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(tmp_path, draw, message):
    path = drawn(tmp_path / "bad.dxf", draw)
    with pytest.raises(FloorPlanError, match=message) as found:
        FloorPlan.from_file(path)
    assert str(found.value).startswith(f"{path}: ")
    assert "\n" not in str(found.value)


def test_blocks_that_hold_blocks_end_at_a_limit(tmp_path, monkeypatch):
    document = ezdxf.new(units=6)
    document.blocks.new("b0").add_line((0, 0), (1, 0))
    for k in range(1, 12):
        block = document.blocks.new(f"b{k}")
        for _ in range(10):
            block.add_blockref(f"b{k - 1}", (0, 0))
    document.modelspace().add_blockref("b11", (0, 0))
    document.saveas(tmp_path / "bomb.dxf")
    monkeypatch.setattr("mesa_mobility.floorplan.formats.drawing.MOST_ENTITIES", 3000)
    with pytest.raises(FloorPlanError, match="more than 3,000 entities"):
        FloorPlan.from_dxf(tmp_path / "bomb.dxf")


def test_files_that_are_no_drawings(tmp_path):
    for name, content, message in (
        ("text.dxf", b"hello\nworld\n", "is not a DXF that can be read"),
        ("empty.dxf", b"", "is not a DXF that can be read"),
        ("autocad.dxf", b"AC1032\0\0", "is a DWG, expected a DXF"),
    ):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(FloorPlanError, match=message):
            FloorPlan.from_file(tmp_path / name)
    with pytest.raises(FloorPlanError, match=r"none.dxf: cannot be read \(No such file"):
        FloorPlan.from_file(tmp_path / "none.dxf")


SPOILT = ("nan", "inf", "1e308", "-1", "0", "999999999", "INSERT", "SPLINE", "pillar", "", "40")


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A file with a room, a pillar that is a block, and a spline, as lines."""
    document = ezdxf.new(units=6)
    document.blocks.new("pillar").add_circle((0, 0), 0.2)
    space = document.modelspace()
    room(space)
    space.add_blockref("pillar", (2, 2), dxfattribs={"layer": "obstacle"})
    curve = [(4, 1), (5, 2), (4, 3), (3.5, 2), (4, 1)]
    space.add_spline(curve, dxfattribs={"layer": "obstacle"})
    path = tmp_path_factory.mktemp("dxf") / "whole.dxf"
    document.saveas(path)
    return path, path.read_text().split("\n")


@settings(max_examples=40, deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(0, 1), st.sampled_from(SPOILT) | st.none()), min_size=1, max_size=5
    )
)
def test_a_damaged_file_is_read_or_refused_in_one_line(whole, damages):
    path, lines = whole
    lines = list(lines)
    begin = lines.index("BLOCKS")
    for share, text in damages:
        lines[begin + int(share * (len(lines) - begin - 1))] = text
    path.write_text("\n".join(each for each in lines if each is not None))
    message, area = "", 1.0
    try:
        area = FloorPlan.from_dxf(path).area
    except FloorPlanError as error:
        message = str(error)
    assert "\n" not in message
    assert area > 0


@st.composite
def stars(draw):
    """The corners of a simple polygon around the origin, metres."""
    radii = draw(st.lists(st.integers(2_000, 9_000), min_size=5, max_size=12))
    angles = 2 * np.pi * np.arange(len(radii)) / len(radii)
    xy = np.array(radii)[:, None] / 1000 * np.column_stack([np.cos(angles), np.sin(angles)])
    return np.round(xy, 3)


@settings(max_examples=15, deadline=None)
@given(stars(), st.sampled_from(sorted(METRES_OF_CODE)), st.randoms(use_true_random=False))
def test_what_is_drawn_comes_back_from_any_unit_and_from_single_lines(
    tmp_path_factory, corners, code, random
):
    scale, n = 1 / METRES_OF_CODE[code], len(corners)
    pieces = [(corners[k], corners[(k + 1) % n]) for k in range(n)]
    pieces = [piece if random.random() < 0.5 else piece[::-1] for piece in pieces]
    random.shuffle(pieces)
    a, b = corners[0], corners[1]
    door = (a + 0.25 * (b - a), a + 0.75 * (b - a))
    hole = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]

    def draw(space):
        for one, other in pieces:
            line(space, one * scale, other * scale, "walkable")
        outline(space, np.array(hole) * scale, "walkable")
        line(space, door[0] * scale, door[1] * scale, "exit door")

    plan = FloorPlan.from_dxf(drawn(tmp_path_factory.mktemp("star") / "star.dxf", draw, code))
    expected = shapely.Polygon(corners, [hole])
    assert shapely.hausdorff_distance(plan.walkable, expected) < 1e-9
    assert plan.walkable.area == pytest.approx(expected.area)
    assert np.allclose([plan.exits[0].a, plan.exits[0].b], door, atol=1e-9)
