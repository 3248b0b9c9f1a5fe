import numpy as np
import pytest
import shapely
from numba import njit

from mesa_mobility.floorplan import lines_of_sight
from mesa_mobility.floorplan.walls.line_of_sight import unwalled
from mesa_mobility.floorplan.walls.sight import sight_of
from mesa_mobility.floorplan.walls.wall_boxes import FEW, boxes_around


@pytest.mark.parametrize("count", [0, 1, 8, 9, 24, 25, 200])
def test_every_wall_lies_in_one_box(count: int) -> None:
    rng = np.random.default_rng(count)
    walls = rng.uniform(0, 50, (count, 4))
    boxes, numbers = boxes_around(walls)
    outer, blocks = len(boxes) - len(numbers), len(numbers)
    assert blocks <= -(-count // 8) + 1
    assert outer == (-(-blocks // 8) if blocks > FEW else 0)
    found = []
    for block in range(blocks):
        for lane in range(8):
            x, y, wide, high = boxes[outer + block, :, lane]
            if wide < 0:  # it fills up the row
                continue
            wall = walls[numbers[block, lane]].reshape(2, 2)
            found.append(int(numbers[block, lane]))
            assert (wall.min(axis=0), wall.max(axis=0)) == (
                pytest.approx([x - wide, y - high]),
                pytest.approx([x + wide, y + high]),
            )
            if outer:
                cx, cy, half, tall = boxes[block // 8, :, block % 8]
                assert (np.abs(wall - [cx, cy]) <= [half + 1e-9, tall + 1e-9]).all()
    assert sorted(found) == list(range(count))


@pytest.mark.parametrize("count", [20, 30, 300, 512, 513])
@pytest.mark.parametrize("clearance", [0.0, 0.2])
def test_views_among_many_walls_are_those_of_shapely(count: int, clearance: float) -> None:
    rng = np.random.default_rng(count)
    middles, along = rng.uniform(0, 40, (count, 2)), rng.normal(0, 0.5, (count, 2))
    along[::2, 0] = 0.0  # every other one is upright
    walls = np.column_stack([middles - along, middles + along])
    p, far = rng.uniform(-2, 42, (400, 2)), rng.normal(0, 8, (400, 2))
    far[:20] *= [1, 0]
    q = p + far
    lines = shapely.linestrings(np.stack([p, q], axis=1))[:, None]
    away = shapely.distance(lines, shapely.linestrings(walls.reshape(-1, 2, 2))).min(axis=1)
    seen = (away > 0) & (away >= clearance)
    assert 40 < seen.sum() < 390
    assert lines_of_sight(walls, p, q, clearance).tolist() == seen.tolist()


@njit
def _unwalled(sight, p, q):
    found = np.empty(len(p), np.bool_)
    for i in range(len(p)):
        found[i] = unwalled(sight, p[i, 0], p[i, 1], q[i, 0], q[i, 1])
    return found


@pytest.mark.parametrize("count", [0, 3, 30, 512, 513])
def test_walls_that_lie_across_are_those_of_shapely(count: int) -> None:
    rng = np.random.default_rng(count)
    middles, along = rng.uniform(0, 40, (count, 2)), rng.normal(0, 0.5, (count, 2))
    walls = np.column_stack([middles - along, middles + along])
    p = rng.uniform(-2, 42, (400, 2))
    q = p + rng.normal(0, 8, (400, 2))
    own = min(count, 30)
    p[:own] = walls[:own, :2]  # who stands at the end of a wall looks past it
    lines = shapely.linestrings(np.stack([p, q], axis=1))[:, None]
    across = shapely.intersects(lines, shapely.linestrings(walls.reshape(-1, 2, 2)))
    across[np.arange(own), np.arange(own)] = False
    found = _unwalled(sight_of(walls, (), 0.0), p, q)
    assert found.tolist() == (~across.any(axis=1)).tolist()
    assert count < 30 or 40 < found.sum() < 390


def test_curtains_hide_nobody() -> None:
    p, q = np.array([[0.0, 0.0]]), np.array([[4.0, 0.0]])
    line = [(2.0, -1.0, 2.0, 1.0)]
    assert not _unwalled(sight_of(line, (), 0.0), p, q)[0]
    assert _unwalled(sight_of((), line, 0.0), p, q)[0]
