"""What is looked up of everybody once a step, by one thread or several."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan, threads
from mesa_mobility.crowd import overview
from mesa_mobility.crowd.neighbours import build_grid, headways
from tests.fixtures.maps import shipped_map
from tests.fixtures.scenes import model_of


@pytest.mark.parametrize("count", [1, 3])
def test_the_same_by_any_number_of_threads(monkeypatch, count):
    plan = FloorPlan(box(0, 0, 8, 8), exits=[Exit("right", (8, 3), (8, 5))])
    model = model_of(plan, shipped_map(), rng=1)
    places = np.array([(1.0 + 0.8 * (k % 6), 1.0 + 0.8 * (k // 6)) for k in range(24)])
    model.add_pedestrians(places)
    rows = np.arange(24)
    crowd = model.crowd
    crowd.records["route"][5] = np.inf
    alone = np.empty((24, 2))
    known = overview.look_over(rows, 0, crowd, alone)
    grid = build_grid(rows, crowd.x, crowd.y)
    before = headways(grid, crowd.records).copy()
    monkeypatch.setattr(threads, "THREADS", count)
    for module in ("overview", "neighbours"):
        monkeypatch.setattr(f"mesa_mobility.crowd.{module}.BRIEF", 1)
    shared = np.empty((24, 2))
    found = overview.look_over(rows, 0, crowd, shared)
    assert shared.tolist() == alone.tolist() == places.tolist()
    assert found.speeds.tolist() == known.speeds.tolist()
    assert found.ways.tolist() == known.ways.tolist()
    assert len(found.ways) == 23
    assert found.awaited == known.awaited
    assert headways(grid, crowd.records).tobytes() == before.tobytes()
