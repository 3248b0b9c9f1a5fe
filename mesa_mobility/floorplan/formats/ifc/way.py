"""Stairs and ramps as a building takes them, while they are fitted to the floors that they join."""

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

NEWEL = 0.1
"""Metres from the foot of a flight to the head of the next, round the corner of a landing."""

ON, LEFT, RIGHT = "on", "left", "right"
"""Ways on from a landing, as seen by somebody who walks down."""


class End(NamedTuple):
    """The upper or the lower edge of stairs.

    Attributes:
        middle: (2,) metres.
        away: (2,) direction of length 1 from the stairs on to the floor.
        across: (2,) direction of length 1 along the edge, from the left of somebody who walks down.
    """

    middle: NDArray[np.float64]
    away: NDArray[np.float64]
    across: NDArray[np.float64]


@dataclass(frozen=True)
class Way:
    """Stairs, or a ramp of two risers and a tread as long as itself; metres.

    Attributes:
        head: (2, 2) the upper edge, its left end first as seen by somebody who walks down.
        risers: number of all risers.
        tread: depth of a tread.
        turn: "left" or "right" for two flights side by side, otherwise nothing.
        well: between these flights.
        landing: depth of landings, or None.
        flights: risers of each of several flights, from the top.
        turns: ways on from the landings between these.
        guessed: what is only like the stairs of the file, for a note; or nothing.
    """

    head: NDArray[np.float64]
    risers: int
    tread: float
    turn: str = ""
    well: float = 0.0
    landing: float | None = None
    flights: tuple[int, ...] = ()
    turns: tuple[str, ...] = field(default=())
    guessed: str = ""

    @property
    def width(self) -> float:
        """Clear width, metres."""
        return float(np.hypot(*(self.head[1] - self.head[0])))

    @property
    def given(self) -> dict[str, object]:
        """Properties of a feature of stairs."""
        given: dict[str, object] = {"risers": self.risers, "tread": round(self.tread, 4)}
        if self.turn:
            given |= {"type": "dog_leg", "turn": self.turn, "well": self.well}
        if self.flights:
            given |= {"type": "flights", "flights": self.flights, "turns": self.turns}
        return given if self.landing is None else given | {"landing": self.landing}

    def ends(self) -> tuple[End, End]:
        """The upper and the lower edge."""
        across, middle = (self.head[1] - self.head[0]) / self.width, self.head.mean(axis=0)
        down = _left_of(across)
        upper = End(middle, -down, across)
        if self.turn:
            side = -1.0 if self.turn == LEFT else 1.0
            # Of an odd number of risers the lower flight has one more.
            longer = self.risers % 2 * self.tread
            middle = middle + side * (self.well + self.width) * across - longer * down
            return upper, End(middle, -down, -across)
        counts = self.flights or (self.risers,)
        for count, turn in zip(counts, (*self.turns, ""), strict=True):
            middle = middle + (count - 1) * self.tread * down
            if turn == ON:
                middle = middle + (self.landing or self.width) * down
            elif turn:
                side = -1.0 if turn == LEFT else 1.0
                beyond = NEWEL + self.width / 2
                middle = middle + side * self.width / 2 * across + beyond * down
                across = -side * down
                down = _left_of(across)
        return upper, End(middle, down, across)

    def narrowed(self, upper: tuple[float, float], lower: tuple[float, float]) -> "Way":
        """The same without what is in the way before its ends.

        Landings with quarter turns keep the inner sides of both their flights where they are, so
        what is in the way there stays; see ``ends`` for what comes out.

        Args:
            upper: metres that are blocked on the left and the right of the upper edge, as seen by
                somebody who walks down.
            lower: the same of the lower edge.
        """
        (left, right), (lower_left, lower_right) = upper, lower
        quarter = [each for each in self.turns if each != ON]
        if self.turn:  # the way back has its left where the way there has its right
            left, right = max(left, lower_right), max(right, lower_left)
        elif not quarter:
            left, right = max(left, lower_left), max(right, lower_right)
        else:
            outer = lower_right if quarter[-1] == LEFT else lower_left
            if quarter[0] == LEFT:
                right = max(right, outer - left)
            else:
                left = max(left, outer - right)
        across = self.ends()[0].across
        head = self.head + np.array([left * across, -right * across])
        return replace(self, head=head, well=self.well + left + right)


def _left_of(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """(2,) a direction turned left by a right angle."""
    return np.array([-direction[1], direction[0]])
