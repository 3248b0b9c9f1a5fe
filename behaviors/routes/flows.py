"""How many people a second pass doors, stairs, escalators and lifts, from published figures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import shapely
from mesa_mobility.behaviors.exits.quickest_exit import people_a_second
from numpy.typing import NDArray

if TYPE_CHECKING:
    from mesa_mobility.floorplan import Belt, FloorPlan, Shaft

STAIRS_DOWN, STAIRS_UP = 1.1, 0.88
"""Most people a second and metre of clear width on stairs (IMO MSC.1/Circ.1533, 2016)."""


def on_stairs(width: float, *, down: bool) -> float:
    """People a second on stairs of a clear width, metres, down or up.

    The most specific flow of IMO MSC.1/Circ.1533: 1.1 persons/(s m) down and 0.88 up.
    """
    return width * (STAIRS_DOWN if down else STAIRS_UP)


def on_escalator(belt: Belt) -> float:
    """People a second on an escalator: its capacity, one each ``gap_s`` seconds.

    By default that is one person on each step 1 m wide (``Escalator``).
    """
    return 1.0 / belt.gap_s


def in_lift(shaft: Shaft) -> float:
    """People a second in a lift: a full car for each of its longest rides to and fro.

    A round trip is twice the longest ride, in which doors close and open, as in counts of the
    handling capacity of lifts (CIBSE Guide D: passengers of a trip over the time of the trip).
    """
    last = range(len(shaft.stops))
    longest = max(shaft.ride_s(start, end) for start in last for end in last if start != end)
    return shaft.capacity / (2.0 * longest)


def flows_through(
    plan: FloorPlan, names: Sequence[str], directions: Sequence[tuple[float, float]]
) -> NDArray[np.float64]:
    """(o,) people a second through gates and exits.

    A gate on stairs passes what stairs do, those of escalators and lifts what these do, and all
    others as many as doors do (``people_a_second``), those of ramps included.

    Args:
        plan: the floor plan.
        names: (o,) of the gates and exits.
        directions: (o,) unit vectors (x, y) in which people cross them.
    """
    given = {
        gate.name: on_escalator(seam.belt)
        for seam in plan.seams
        if seam.belt is not None
        for gate in seam.gates
    }
    given |= {gate.name: in_lift(shaft) for shaft in plan.shafts for gate in shaft.gates}
    stairs = [zone for zone in plan.zones if zone.is_stair]
    flows = np.empty(len(names))
    for k, (name, direction) in enumerate(zip(names, directions, strict=True)):
        opening = plan.gate(name)
        middle = shapely.Point(opening.midpoint)
        downhill = [zone.downhill for zone in stairs if zone.area.intersects(middle)]
        if name in given:
            flows[k] = given[name]
        elif downhill:
            down = float(np.dot(np.array(downhill[0]), direction)) > 0.0
            flows[k] = on_stairs(opening.length, down=down)
        else:
            flows[k] = people_a_second(opening.length)
    return flows
