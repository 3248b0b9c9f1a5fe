"""Per-step crowd aggregates, by one thread or several."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.compiled import threads
from mesa_mobility.crowd.state import aggregates
from mesa_mobility.crowd.state.people_grid import grid_of_frame
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
    crowd.agenda["waits_until"][[3, 17]] = 1
    crowd.records["vx"][:24] = np.linspace(0.0, 1.5, 24)
    alone = np.empty((24, 2))
    known = aggregates.aggregate(rows, 0, crowd, alone)
    before = grid_of_frame(rows, crowd.records).table.tobytes()
    monkeypatch.setattr(threads, "THREADS", count)
    monkeypatch.setattr(threads, "BLOCK", 5)
    shared = np.empty((24, 2))
    found = aggregates.aggregate(rows, 0, crowd, shared)
    assert shared.tolist() == alone.tolist() == places.tolist()
    assert (found.people, found.going, found.awaited) == (24, 23, 2)
    assert known == pytest.approx(found, rel=1e-12)
    assert found.speeds == pytest.approx(np.hypot(crowd.vx[:24], crowd.vy[:24]).sum())
    assert grid_of_frame(rows, crowd.records).table.tobytes() == before
