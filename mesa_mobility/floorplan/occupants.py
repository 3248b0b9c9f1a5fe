"""The people on a floor plan: an obstacle is refused where one of them stands.

Obstacles and bodies are solid: in a building, too, nothing can be put down where somebody stands.
A plan that allowed it would have people inside walls. They could not be moved without being pushed
into others or through a wall, and beside the edge of the floor the wall that keeps them in would be
gone. So the change is refused and the plan stays as it was. Try again when the place is free, put
the obstacle beside it, or take the people out first.

Doors are lines and may be closed at any time: a body across the line steps off to the side on which
its centre is, and those who are in an exit on their way out leave.
"""

from __future__ import annotations

import gc
from typing import Protocol
from weakref import WeakKeyDictionary, WeakSet

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.floor import Floor


class Occupants(Protocol):
    """People who walk on a floor plan."""

    def bodies(self) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
        """(n,) number, (n, 2) position and (n,) core radius, metres, of everybody inside."""


# Not an attribute of plans: a copy of a plan, or one sent to another process, is empty.
_OCCUPANTS: WeakKeyDictionary[Floor, WeakSet[Occupants]] = WeakKeyDictionary()


def add_occupants(plan: Floor, people: Occupants) -> None:
    """From now on refuse obstacles where one of these people stands, as long as they exist."""
    _OCCUPANTS.setdefault(plan, WeakSet()).add(people)


def check_vacant(plan: Floor, obstacle: Polygon, name: str, free: BaseGeometry) -> None:
    """Raise FloorPlanError if somebody stands where an obstacle is to be.

    Args:
        plan: the plan without the obstacle.
        obstacle: its area.
        name: its name in the error.
        free: the free area with it.
    """
    if _in_the_way(plan, obstacle, free) is None:
        return
    # People of a model without references do not count, collected or not.
    gc.collect()
    number = _in_the_way(plan, obstacle, free)
    if number is not None:
        raise FloorPlanError(f"{name}: pedestrian {number} stands there, expected free floor")


def _in_the_way(plan: Floor, obstacle: Polygon, free: BaseGeometry) -> int | None:
    """Lowest number of a person that the obstacle would touch or leave off the floor."""
    found: list[int] = []
    for people in _OCCUPANTS.get(plan, ()):
        numbers, places, radii = people.bodies()
        touched = shapely.distance(shapely.points(places), obstacle) < radii
        # A narrow remainder beside the obstacle counts as solid, too.
        off = plan.contains(places) & ~shapely.intersects_xy(free, places[:, 0], places[:, 1])
        found += numbers[touched | off].tolist()
    return min(found, default=None)
