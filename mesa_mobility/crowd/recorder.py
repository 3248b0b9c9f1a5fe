"""Recording of positions and headings, frame by frame, and of decisions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.repertoire import Repertoire
from mesa_mobility.crowd.state.records import Crowd


class Recorder:
    """Keeps position and heading of everybody inside, one block of arrays a frame."""

    def __init__(self) -> None:
        self._blocks: list[tuple[NDArray[np.generic], ...]] = []

    def add(self, frame: int, rows: NDArray[np.int64], state: Crowd) -> None:
        """Keep the people in ``rows`` at ``frame``."""
        self._blocks.append(
            (
                np.full(len(rows), frame, dtype=np.int32),
                rows.astype(np.int32),
                state.x[rows],
                state.y[rows],
                state.heading[rows],
            )
        )

    def arrays(self) -> dict[str, NDArray[np.generic]]:
        """``frame``, ``person``, ``x``, ``y``, ``heading``: a row for each person and frame."""
        names = ("frame", "person", "x", "y", "heading")
        if not self._blocks:
            kinds = (np.int32, np.int32, np.float64, np.float64, np.float64)
            return {name: np.empty(0, kind) for name, kind in zip(names, kinds, strict=True)}
        columns = zip(*self._blocks, strict=True)
        return {name: np.concatenate(c) for name, c in zip(names, columns, strict=True)}


class DecisionRecorder:
    """Keeps who has taken which option, one block of arrays for each frame with decisions."""

    def __init__(self) -> None:
        self._blocks: list[tuple[NDArray[np.int32], ...]] = []

    def add(self, frame: int, rows: NDArray[np.int64], state: Crowd) -> None:
        """Keep what the people in ``rows``, who have decided at ``frame``, are doing now."""
        self._blocks.append(
            (
                np.full(len(rows), frame, dtype=np.int32),
                rows.astype(np.int32),
                state.type_index[rows].astype(np.int32),
                state.option[rows],
            )
        )

    def arrays(self, repertoire: Repertoire) -> dict[str, NDArray[np.generic]]:
        """What was decided, a row for each decision in the order in which they were taken.

        ``frame``; ``person``; ``type_index`` of the person's type; ``option``, a row of the type's
        map, or -2 for the fallback; ``share`` of the option's ground that is covered.
        """
        names = ("frame", "person", "type_index", "option")
        columns = [np.concatenate(each) for each in zip(*self._blocks, strict=True)]
        found = dict(zip(names, columns or [np.empty(0, np.int32)] * 4, strict=True))
        option, share = found["option"].copy(), np.ones(len(found["option"]), dtype=np.float32)
        for number, capability in enumerate(repertoire.capabilities):
            own = (found["type_index"] == number) & (option >= 0)
            rows = option[own] - repertoire.first_option[number]
            option[own] = capability.parts.rows[rows]
            share[own] = capability.parts.share[rows]
        return {**found, "option": option, "share": share}
