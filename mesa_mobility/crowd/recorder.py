"""Recording of positions and headings, frame by frame."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.hooks import Saved
from mesa_mobility.crowd.state.records import Crowd


class Recorder(Saved):
    """Keeps position and heading of everybody inside, one block of arrays a frame."""

    def __init__(self) -> None:
        self._blocks: list[tuple[NDArray[np.generic], ...]] = []
        self._fields: dict[str, np.dtype[Any]] = {}

    def state(self) -> dict[str, Any]:
        """All that has been recorded."""
        return self.arrays()

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        self._blocks = [tuple(state.values())]
        self._fields = {name: values.dtype for name, values in list(state.items())[5:]}

    def add(self, frame: int, rows: NDArray[np.int64], state: Crowd) -> None:
        """Keep the people in ``rows`` at ``frame``."""
        self._blocks.append(
            (
                np.full(len(rows), frame, dtype=np.int32),
                rows.astype(np.int32),
                state.x[rows],
                state.y[rows],
                state.heading[rows],
                *(values[rows] for values in state.fields.values()),
            )
        )
        self._fields = {name: values.dtype for name, values in state.fields.items()}

    def arrays(self) -> dict[str, NDArray[np.generic]]:
        """``frame``, ``person``, ``x``, ``y``, ``heading`` and fields of the model's people: a row
        for each person and frame."""
        names = ("frame", "person", "x", "y", "heading", *self._fields)
        if not self._blocks:
            kinds: list[Any] = [np.int32, np.int32, *[np.float64] * 3, *self._fields.values()]
            return {name: np.empty(0, kind) for name, kind in zip(names, kinds, strict=True)}
        columns = zip(*self._blocks, strict=True)
        return {name: np.concatenate(c) for name, c in zip(names, columns, strict=True)}
