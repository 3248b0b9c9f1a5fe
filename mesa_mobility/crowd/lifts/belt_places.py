"""Where people are on a belt and around it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.floorplan import Belt, Seam


class Near(NamedTuple):
    """People on a belt or near it.

    Attributes:
        who: (n,) their indices among the points asked for, or what these stand for.
        along: (n,) metres behind the line at which people step on.
        aside: (n,) metres from the middle of the belt, to either side.
        shifts: (n, 2) metres to the same place on the sheet on which people step on.
    """

    who: NDArray[np.int64]
    along: NDArray[np.float64]
    aside: NDArray[np.float64]
    shifts: NDArray[np.float64]


class BeltPlaces:
    """The places on a belt and around it, on both sheets on which it is drawn.

    Args:
        seam: the seam of the belt.
        belt: the belt.
        reach: metres that people may cover with one movement, their bodies and those of riders
            included.
        ahead: frames for which the belt may move on for certain.

    Attributes:
        half: half its width, metres.
        length: in plan, metres.
        gap_s: least mean time from one person who steps on to the next, seconds.
        direction: (2,) unit vector in which people ride.
        velocity: (2,) of those on it, m/s.
    """

    def __init__(self, seam: Seam, belt: Belt, reach: float, ahead: int) -> None:
        self._seam, self._way = seam, belt.way
        self.half, self.length, self.gap_s = seam.width / 2.0, belt.length, belt.gap_s
        self.direction = belt.way * np.array(seam.direction)
        self._speed = abs(belt.speed)
        self.velocity = belt.speed * np.array(seam.direction)
        # Within so many metres people may be in the way of riders.
        self._around = reach + self.metres(ahead)

    def metres(self, frames: int) -> float:
        """Metres by which the belt moves on in a number of frames."""
        return self._speed * frames * FRAME_SECONDS

    def near(self, points: NDArray[np.float64]) -> Near:
        """The people at some of (n, 2) points, metres, who are on the belt or near it."""
        found = []
        for second in (False, True):
            steps_on = second == (self._way < 0)
            past = self._way * self._seam.past(points, second)
            across = np.array([-self.direction[1], self.direction[0]])
            aside = np.abs((points - self._middle(second)) @ across)
            # Beyond the far end of a drawing is the floor of another storey.
            first, last = self.length / 2.0 + self._around, self._seam.depth
            low, high = (-first, last) if steps_on else (-last, first)
            who = np.flatnonzero(
                (past >= low) & (past <= high) & (aside <= self.half + self._around)
            )
            shift = np.zeros(2) if steps_on else -self._way * np.array(self._seam.shift)
            shifts = np.tile(shift, (len(who), 1))
            found.append((who, past[who] + self.length / 2.0, aside[who], shifts))
        return Near(*(np.concatenate(each) for each in zip(*found, strict=True)))

    def _middle(self, second: bool) -> NDArray[np.float64]:
        """(2,) the middle of the belt as drawn on one of its sheets, metres."""
        return np.array(self._seam.centre) + (self._seam.shift if second else (0.0, 0.0))
