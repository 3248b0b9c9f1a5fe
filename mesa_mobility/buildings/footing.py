"""Where bodies and feet are on stairs: pictures need more than the slope that people walk."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.buildings.connections.flights import Flight
from mesa_mobility.buildings.places import height_on, place_on

_STEP = 0.8
"""Metres beyond either end of a flight from which a foot may be on it."""

_ASIDE = 0.5
"""Metres beside a flight within which a foot of somebody on the flight counts as on it."""

_SAME = 0.05
"""Metres: a place that is farther above or below a flight belongs to another."""

_ROUNDING = 1e-6
"""Metres: the edge of a tread belongs to the tread above it."""


class Footing:
    """Heights at which bodies and feet are drawn in a building.

    A place on a flight has the height of a slope. Treads are above or below this slope by up to
    half a riser. On a ramp the slope itself carries people.

    Args:
        flights: those of the building.
    """

    def __init__(self, flights: Sequence[Flight]) -> None:
        self._flights = tuple(flights)

    def carried(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Heights above which bodies are drawn.

        On a flight this is the line through the middles of the treads, which the body reaches
        within a tread from either end.

        Args:
            places: (n, 3) true places of people, metres.

        Returns:
            (n,) metres.
        """
        found = places[:, 2].copy()
        for flight in self._flights:
            if not flight.risers:
                continue
            down, aside = place_on(flight, places[:, :2])
            on = (down > 0.0) & (down < flight.going) & (aside <= flight.width / 2.0)
            on &= np.abs(height_on(flight, down) - places[:, 2]) <= _SAME
            end = min(flight.tread, flight.going / 2.0)
            drop = (0.5 + end / flight.tread) * flight.riser
            found[on] = np.interp(
                down[on],
                [0.0, end, flight.going - end, flight.going],
                [flight.top, flight.top - drop, flight.bottom + drop, flight.bottom],
            )
        return found

    def beneath(
        self, places: NDArray[np.float64], points: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Heights of the floor beneath parts of bodies.

        Args:
            places: (n, 3) true places of people, metres.
            points: (n, 2) places of a part of each person's body, as of a heel, metres.

        Returns:
            (n,) heights of the treads or floors beneath the points, metres, and (n,) heights of the
            line through the outer edges of the treads, over which feet swing.
        """
        treads = places[:, 2].copy()
        edges = treads.copy()
        for flight in self._flights:
            down, aside = place_on(flight, places[:, :2])
            half = flight.width / 2.0
            along = np.clip(down, 0.0, flight.going)
            near = (np.abs(down - along) <= _STEP) & (aside <= half + _STEP)
            near &= np.abs(height_on(flight, along) - places[:, 2]) <= _SAME
            on = near & (down == along) & (aside <= half)
            down, aside = place_on(flight, points)
            over = near & (aside <= np.where(on, half + _ASIDE, half))
            over &= on | ((down > 0.0) & (down < flight.going + flight.tread))
            if not flight.risers:
                slope = height_on(flight, np.clip(down[over], 0.0, flight.going))
                treads[over] = edges[over] = slope
                continue
            count = np.ceil((down[over] - _ROUNDING) / flight.tread)
            count[down[over] >= flight.going] = flight.risers
            lowest, highest = flight.bottom, flight.top
            treads[over] = np.clip(highest - flight.riser * count, lowest, highest)
            line = highest - flight.riser * down[over] / flight.tread
            edges[over] = np.clip(line, lowest, highest)
        return treads, edges
