"""What behaviours are given and must not change: compiled functions take it on trust."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.hooks import Plugin, ships
from mesa_mobility.crowd.tactics.deciding import Deciding
from mesa_mobility.errors import ModelError

_UNCHANGED = "pedestrians", "positions", "destinations", "inside.pedestrians"


class Given:
    """The arrays of a frame, as the first behaviour gets them.

    Args:
        deciding: what behaviours are given.
    """

    def __init__(self, deciding: Deciding) -> None:
        self._deciding = deciding
        self._kept: list[NDArray[Any]] = []

    def keep(self, behaviour: Plugin) -> bool:
        """Whether a behaviour that is about to be called is from outside, and is to be checked."""
        if ships(behaviour):
            return False
        if not self._kept:
            self._kept = [each.copy() for each in self._arrays()]
        return True

    def check(self, behaviour: Plugin) -> None:
        """Raise ModelError where a behaviour has changed them in place."""
        for name, now, kept in zip(_UNCHANGED, self._arrays(), self._kept, strict=True):
            if not np.array_equal(now, kept):
                now[:] = kept
                raise ModelError(
                    f"behaviour {behaviour.name!r}: changed deciding.{name} in place, expected it "
                    "to be left as it is"
                )

    def _arrays(self) -> tuple[NDArray[Any], ...]:
        each = self._deciding
        return each.pedestrians, each.positions, each.destinations, each.inside.pedestrians
