"""Drawings of other programs: layers of any name, exits off the edge, stray lines, walls alone."""

import warnings

import pytest

from mesa_mobility import FloorPlan
from tests.floorplan.formats.mutations import read_all

ezdxf = pytest.importorskip("ezdxf", reason="no ezdxf: pip install 'mesa-mobility[cad]'")


def square(space, x0, y0, x1, y1, layer):
    corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    space.add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})


def hall(space):
    """12 m by 8 m, a pillar, exits as areas and lines."""
    square(space, 0, 0, 12, 8, "jps-walkablearea")
    square(space, 4, 3, 6, 5, "jps-obstacles")
    square(space, 11.2, 2, 11.6, 3.5, "jps-exits")  # 0.4 m from the edge
    space.add_line((2, 0.5), (3, 0.5), dxfattribs={"layer": "jps-exits"})
    space.add_line((1, 1), (2, 2), dxfattribs={"layer": "jps-walkablearea"})
    space.add_line((1, 1), (2, 2), dxfattribs={"layer": "jps-journeys"})


def saved(path, draw, units=6):
    document = ezdxf.new(units=units)
    draw(document.modelspace())
    document.saveas(path)
    return path


def read(path, **options):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        plan = FloorPlan.from_file(path, **options)
    return plan, "\n".join(str(each.message) for each in found)


def test_layers_are_guessed_and_exits_put_on_the_edge(tmp_path):
    plan, said = read(saved(tmp_path / "hall.dxf", hall))
    assert plan.area == 12 * 8 - 4
    ends = [sorted([each.a, each.b]) for each in plan.exits]
    assert ends == [
        [pytest.approx((12, 2)), pytest.approx((12, 3.5))],
        [pytest.approx((2, 0)), pytest.approx((3, 0))],
    ]
    for part in (
        "layer jps-exits holds exit",
        "left out the layers jps-journeys",
        "left out a stray line that ends at (2.000, 2.000) m",
        "exit 'exit 1' was moved to the edge, by 0.40 m",
    ):
        assert part in said


def test_an_exit_far_from_the_edge_is_cut_out(tmp_path):
    def draw(space):
        square(space, 0, 0, 20, 20, "floor")
        square(space, 9, 9, 11, 12, "exit")

    plan, said = read(saved(tmp_path / "hall.dxf", draw))
    assert plan.area == 400 - 6
    assert sorted(round(each.length, 6) for each in plan.exits) == [2, 2, 3, 3]
    assert "people leave when they reach it" in said


def test_a_drawing_of_millimetres_that_is_in_metres(tmp_path):
    plan, said = read(saved(tmp_path / "hall.dxf", hall, units=4))
    assert plan.area == 12 * 8 - 4
    assert "taken as metres" in said


def test_walls_alone_make_a_floor(tmp_path):
    def draw(space):
        # A room of 6 m by 4 m whose wall of lines has a gap of 1 m, and a hatched pillar.
        for a, b in (
            ((0, 0), (6, 0)),
            ((6, 0), (6, 1)),
            ((6, 2), (6, 4)),
            ((6, 4), (0, 4)),
            ((0, 4), (0, 0)),
        ):
            space.add_line(a, b, dxfattribs={"layer": "A-WALL"})
        hatch = space.add_hatch(dxfattribs={"layer": "A-WALL"})
        hatch.paths.add_polyline_path([(2, 1), (3, 1), (3, 2), (2, 2)])

    plan, said = read(saved(tmp_path / "room.dxf", draw), exits="6 1, 6 2")
    assert "what the outermost walls enclose" in said
    # Lines are walls 0.1 m thick.
    assert plan.area == pytest.approx(5.9 * 3.9 - 1, abs=0.15)
    assert plan.exits[0].length == pytest.approx(0.9, abs=0.11)


@pytest.mark.parametrize("count", [15, pytest.param(1500, marks=pytest.mark.slow)])
def test_damaged_files_are_plans_or_refused(tmp_path, count):
    whole = saved(tmp_path / "hall.dxf", hall).read_bytes()
    at = whole.index(b"ENTITIES")
    for part in (whole, whole[:at] + whole[at:]):
        assert read_all(part, tmp_path / "hall.dxf", count // 2) >= 0
