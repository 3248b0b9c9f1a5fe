"""Repeated queries from the same place are cached, as long as the answer is valid."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility.compiled import threads
from mesa_mobility.floorplan import Router

# In the corridor of 20 m, exits lie 2 m behind the lines at x = 0 and x = 20.
WEST, EAST = -2.0, 22.0


def aim(router: Router, x: float, destination: int = 0) -> float:
    return float(router.targets([(x, 2.0)], [destination]).points[0, 0])


def lie(router: Router) -> None:
    """Change every answer that is kept, so that their use shows."""
    router._cache["target_x"] = 99.0


def test_an_answer_is_given_again_for_the_same_place_and_destination(plans) -> None:
    router = Router(plans["corridor"]())
    east = router.destination(("east",))
    assert (aim(router, 5.0), aim(router, 5.0, east)) == (WEST, EAST)
    lie(router)
    assert (aim(router, 5.0), aim(router, 5.0, east)) == (99.0, 99.0)
    # From a place that is the next number it is worked out.
    assert aim(router, np.nextafter(5.0, 6.0)) == WEST
    assert aim(router, 15.0) == EAST


def test_a_kept_answer_is_complete(plans) -> None:
    router = Router(plans["l_corridor"]())
    places = [(1.0, 1.0), (11.0, 5.0), (11.0, 5.0), (-3.0, -3.0)]
    first = router.targets(places, [0] * 4)
    # 9.2 m along and 0.8 m up to (10.2, 1.8), then 8.2 m up; 5 m up.
    assert first.distances[:3] == pytest.approx([np.hypot(9.2, 0.8) + 8.2, 5.0, 5.0])
    again = router.targets(places, [0] * 4)
    assert (again.points == first.points).all()
    assert (again.gates == first.gates).all()
    assert (again.distances == first.distances).all()
    assert (again.corners == first.corners).all()
    assert again.corners[0, 0] >= 0


def test_where_another_answer_is_kept_it_is_worked_out(plans) -> None:
    router = Router(plans["corridor"]())
    east = router.destination(("east",))
    aim(router, 5.0)
    kept = router._cache[router._cache["destination"] > 0][0]
    # The cache is full of answers for (5, 2), which serve no other place.
    router._cache[:] = kept
    lie(router)
    assert aim(router, 5.0) == 99.0
    assert [aim(router, x, to) for x, to in ((6.0, 0), (5.0, east), (2.0, 0))] == [WEST, EAST, WEST]


def test_answers_are_forgotten_when_the_floor_plan_changes(plans) -> None:
    plan = plans["corridor"]()
    router = Router(plan)
    assert aim(router, 5.0) == WEST
    plan.close_gate("west")
    assert aim(router, 5.0) == EAST
    plan.open_gate("west")
    assert aim(router, 5.0) == WEST
    barrier = plan.add_obstacle(box(3.0, 0.0, 3.5, 4.0))
    assert aim(router, 5.0) == EAST
    plan.remove_obstacle(barrier)
    assert aim(router, 5.0) == WEST


def test_what_threads_have_found_is_kept(plans, monkeypatch) -> None:
    monkeypatch.setattr(threads, "THREADS", 2)
    router = Router(plans["corridor"]())
    x = np.linspace(1.0, 19.0, 300)
    places = np.column_stack([x, np.full(300, 2.0)])
    for _ in range(2):
        found = router.targets(places, np.zeros(300, int))
        assert (found.points[:, 0] == np.where(x < 10.0, WEST, EAST)).all()
    lie(router)
    found = router.targets(places, np.zeros(300, int))
    # 300 answers share 16,384 places, so that few are lost to others.
    assert (found.points[:, 0] == 99.0).mean() > 0.9
