import numpy as np
import pytest
from shapely import box

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, FloorPlan, Gate


def room_with_gap(gap: float) -> FloorPlan:
    """10 m x 4 m, a wall across at x = 5 that leaves a gap at its upper end."""
    return FloorPlan(
        box(0, 0, 10, 4),
        exits=[Exit("e", (0, 1), (0, 2))],
        obstacles=[box(5, 0, 5.2, 4 - gap)],
        gates=[Gate("door", (5.1, 4 - gap), (5.1, 4))],
    )


LEFT, RIGHT = (2.0, 2.0), (8.0, 2.0)


def test_a_body_that_fits_gets_out() -> None:
    room_with_gap(0.5).check_reachable([LEFT, RIGHT], 0.24)


def test_a_body_that_does_not_fit_is_reported() -> None:
    with pytest.raises(
        FloorPlanError,
        match=r"1 of 2 people cannot reach an open exit .* 0.52 m; .* at \(8.00, 2.00\)",
    ):
        room_with_gap(0.5).check_reachable([LEFT, RIGHT], 0.26)


def test_the_exit_itself_can_be_too_narrow() -> None:
    room_with_gap(2).check_reachable([LEFT], 0.49)
    with pytest.raises(FloorPlanError, match="1 of 1 people"):
        room_with_gap(2).check_reachable([LEFT], 0.51)


def test_an_obstacle_in_front_of_an_exit_blocks_it() -> None:
    plan = room_with_gap(2)
    plan.add_obstacle(box(0, 1.1, 1, 3))
    with pytest.raises(FloorPlanError, match="1 of 1 people"):
        plan.check_reachable([LEFT], 0.1)


def test_closed_gates_and_exits_are_in_the_way() -> None:
    plan = room_with_gap(1)
    plan.check_reachable([RIGHT], 0.2)
    plan.close_gate("door")
    plan.check_reachable([LEFT], 0.2)
    with pytest.raises(FloorPlanError, match="1 of 1 people"):
        plan.check_reachable([RIGHT], 0.2)
    plan.close_gate("e")
    with pytest.raises(FloorPlanError, match="1 of 1 people"):
        plan.check_reachable([LEFT], 0.2)


def test_somebody_close_to_a_wall_counts_as_on_the_near_side() -> None:
    room_with_gap(0.5).check_reachable([(4.95, 2)], 0.24)
    with pytest.raises(FloorPlanError, match="1 of 1 people"):
        room_with_gap(0.5).check_reachable([(5.25, 2)], 0.26)


@pytest.mark.parametrize("place", [(5.1, 1), (20, 20)])
def test_somebody_outside_is_reported(place: tuple) -> None:
    with pytest.raises(FloorPlanError, match="1 of 1 people"):
        room_with_gap(1).check_reachable([place], 0.2)


def test_nobody_is_fine_and_nan_is_not() -> None:
    room_with_gap(1).check_reachable(np.empty((0, 2)), 0.2)
    with pytest.raises(FloorPlanError, match="must be finite"):
        room_with_gap(1).check_reachable([(np.nan, 1)], 0.2)
