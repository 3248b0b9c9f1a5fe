"""Waiting: people who stand for a time, or until a condition holds."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mesa_mobility._numbers import is_number
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.errors import ModelError

LONGEST_WAIT = 1e6
"""Longest wait in seconds; eleven days."""

HELD = 12
"""Frames for which a behaviour holds somebody: people who stand decide again after as many."""

_UNTIL_TOLD = np.iinfo(np.int32).max


def frames_of(seconds: NDArray[np.float64], name: str) -> NDArray[np.int64]:
    """(n,) times in frames, rounded up; an error in the last bit does not add a frame.

    Raises:
        ModelError: a negative or endless time.
    """
    off = ~((seconds >= 0.0) & (seconds <= LONGEST_WAIT))
    if off.any():
        raise ModelError(f"{name}: got {seconds[off][0]}, expected 0 to {LONGEST_WAIT:g} s")
    return np.ceil(seconds / FRAME_SECONDS - 1e-6).astype(np.int64)


def waiting(rows: NDArray[np.int64], frame: int, crowd: Crowd) -> NDArray[np.bool_]:
    """(n,) whether people in ``rows`` wait, for whatever reason."""
    waits: NDArray[np.bool_] = crowd.agenda["waits_until"][rows] > frame
    return waits


def wait_until(rows: NDArray[np.int64], frames: int | NDArray[np.int64], crowd: Crowd) -> None:
    """Have people in ``rows`` wait until these frames at least."""
    until = crowd.agenda["waits_until"]
    until[rows] = np.maximum(until[rows], frames)


def end_wait(rows: int | NDArray[np.int64], frame: int, crowd: Crowd) -> None:
    """Have people in ``rows`` wait no longer."""
    crowd.agenda["waits_until"][rows] = frame


class Waits:
    """The conditions for which people wait."""

    def __init__(self) -> None:
        self._conditions: dict[int, Callable[[], bool]] = {}

    @property
    def waiting_for_functions(self) -> int:
        """How many people wait until a function says so."""
        return len(self._conditions)

    def tell(
        self,
        row: int,
        seconds: float | None,
        until: Callable[[], bool] | None,
        frame: int,
        crowd: Crowd,
    ) -> None:
        """Have the person in ``row`` wait from ``frame`` on.

        Raises:
            ModelError: neither a time nor a condition, both, or a time out of range.
        """
        if (seconds is None) == (until is None):
            raise ModelError("wait: expected either seconds or until")
        if until is not None and not callable(until):
            raise ModelError(f"wait: until is {until!r}, expected a function without arguments")
        if until is not None:
            self._conditions[row] = until
            crowd.agenda["waits_until"][row] = _UNTIL_TOLD
        else:
            if not is_number(seconds):
                raise ModelError(
                    f"wait: got {seconds!r:.60}, expected seconds, 0 to {LONGEST_WAIT:g}"
                )
            self._conditions.pop(row, None)
            frames = frames_of(np.array([seconds], dtype=np.float64), "wait")
            crowd.agenda["waits_until"][row] = frame + frames[0]

    def evaluate(self, rows: NDArray[np.int64], frame: int, crowd: Crowd) -> None:
        """Evaluate the conditions of those in ``rows``; where one holds, the person goes on."""
        if not self._conditions:
            return
        until = crowd.agenda["waits_until"]
        for row in rows[until[rows] == _UNTIL_TOLD].tolist():
            if self._conditions[row]():
                del self._conditions[row]
                until[row] = frame
