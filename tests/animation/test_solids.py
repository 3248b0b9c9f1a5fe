"""Walls, obstacles and seats as they stand on a floor."""

import numpy as np
import pytest
import shapely

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.animation.floor import drawn_floor
from mesa_mobility.animation.scenery import surfaces
from mesa_mobility.animation.solids import THICK, solids_of


def room(obstacles=()):
    return FloorPlan(
        "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))",
        exits=[Exit("door", (10, 3), (10, 5))],
        obstacles=list(obstacles),
    )


def test_walls_go_round_the_floor_and_leave_exits_free():
    (wall,) = solids_of(room())
    # A ring of 0.15 m with its corners, without the 2 m of the exit.
    assert wall.area.area == pytest.approx(36 * THICK + 4 * THICK**2 - 2 * THICK, abs=1e-6)
    assert wall.kind == "wall"
    assert not wall.area.intersects(shapely.Point(10.05, 4))
    assert wall.area.intersects(shapely.Point(10.05, 2))


def test_a_closed_exit_is_a_wall():
    plan = room()
    plan.close_gate("door")
    (wall,) = solids_of(plan)
    assert wall.area.intersects(shapely.Point(10.05, 4))


def test_rows_as_deep_as_seats_are_seats_and_face_the_room():
    rows = [shapely.box(2, y, 7, y + 0.45) for y in (4.0, 5.0, 6.0)]
    found = solids_of(room(rows))
    cushions = [each for each in found if each.kind == "seat" and each.top < 0.5]
    backs = [each for each in found if each.kind == "seat" and each.top > 0.5]
    assert sorted(each.area.bounds for each in cushions) == [row.bounds for row in rows]
    # Nine seats of 0.55 m fit into 5 m, and the room is in front of the first row.
    assert len(backs) == 27
    for back in backs:
        row = next(each for each in rows if each.distance(back.area) < 1e-9)
        assert back.area.centroid.y > row.centroid.y + 0.1
    assert [each.kind for each in found].count("wall") == 1


def test_two_rows_or_a_deep_block_are_no_seats():
    for blocks in (
        [shapely.box(2, y, 7, y + 0.45) for y in (4.0, 5.0)],
        [shapely.box(2, y, 7, y + 0.8) for y in (3.0, 4.5, 6.0)],
    ):
        found = solids_of(room(blocks))
        assert {each.kind for each in found} == {"wall"}
        assert len(found) == 1 + len(blocks)


def test_meshes_have_the_volume_of_what_they_show():
    block = shapely.box(2, 2, 4, 3)
    meshes = {each.name: each for each in surfaces(room([block]))}
    assert set(meshes) == {"floor", "walls", "wall_tops"}
    top = meshes["wall_tops"]
    corners = top.vertices[top.triangles].astype(np.float64)
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] / 2
    ring = 36 * THICK + 4 * THICK**2 - 2 * THICK
    assert areas.sum() == pytest.approx(2.0 + ring, abs=1e-4)
    np.testing.assert_allclose(top.vertices[:, 2], 1.2, atol=1e-6)
    assert meshes["walls"].vertices[:, 2].min() == 0.0


def test_the_browser_gets_the_same_solids():
    plan = room([shapely.box(2, 2, 4, 3)])
    drawn = drawn_floor(plan)["solids"]
    areas = [shapely.Polygon(each["rings"][0], each["rings"][1:]).area for each in drawn]
    known = [each.area.area for each in solids_of(plan)]
    np.testing.assert_allclose(areas, known, atol=1e-3)
