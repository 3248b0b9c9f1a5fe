"""Where people go, and where they aim on the way there."""

from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias, TypeGuard

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.floorplan.floor.floor import Floor

Destination: TypeAlias = tuple[str, ...] | tuple[float, float] | None
"""Names of exits, or of a gate; a point, metres; or None for all exits."""


def is_point(destination: Destination) -> TypeGuard[tuple[float, float]]:
    """Whether a destination is a point."""
    return destination is not None and not isinstance(destination[0], str)


@dataclass(frozen=True)
class Targets:
    """Targets of n people.

    Attributes:
        points: (n, 2) metres: behind a gate or exit to cross, or past a corner to walk around, as
            far as the way on from there is in view. A person who cannot reach the destination gets
            their own position.
        gates: (n,) the gate or exit aimed through, as its number in `FloorPlan.openings()` (gates
            first, then exits); -1 for a corner.
        distances: (n,) length of the route to the line of the exit, or of the gate to cross, or to
            the point, in metres; inf where there is none.
        corners: (n, 2) the next corner of the route and the node after it, as their numbers in
            `Router.graph`; -1 where the next node is a gate or exit. None if unknown.
        floor: the floor on which people may leave the straight line to their targets, such as that
            without hazards. None for the model's.
    """

    points: NDArray[np.float64]
    gates: NDArray[np.int64]
    distances: NDArray[np.float64]
    corners: NDArray[np.int64] | None = None
    floor: Floor | None = None

    @cached_property
    def nearest_first(self) -> NDArray[np.intp]:
        """(n,) the people in rising order of distance; equal ones keep their order."""
        return np.asarray(self.distances).argsort(kind="stable")
