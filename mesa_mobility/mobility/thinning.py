"""Options of one cluster, thinned: the cheapest of each cell, and edited ones where none ends."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.mobility.edits import SAMPLE_EVERY, Edit, edit_paths

DURATIONS = (12, 24, 45)
"""Option durations in frames; 45 frames, 1.5 s, is the paper's time step."""

BUDGET = 3.3
"""Most that a path may cost: two transitions of some quality, or three that hardly show.

An edit counts too.
"""

EDIT_CELL = (0.15, 0.15, np.deg2rad(20.0))
"""Cell in which the cheapest edited option is kept if no recorded one ends there."""


class ClusterOptions(NamedTuple):
    """Options of one cluster: index of duration, cell, cost, path, clusters, poses, and the number
    of the edit, 0 if there is none."""

    layers: NDArray[np.int64]
    cells: NDArray[np.int64]
    costs: NDArray[np.float32]
    paths: NDArray[np.float32]
    path_clusters: NDArray[np.int32]
    chains: NDArray[np.int32]
    edits: NDArray[np.int16]

    def taken(self, rows: NDArray[np.generic]) -> ClusterOptions:
        """Some of the options, in the order of ``rows``."""
        return ClusterOptions(*(column[rows] for column in self))


def merge(parts: list[tuple[NDArray, ...]]) -> ClusterOptions:
    """Thin the parts of one cluster together; earlier parts win ties."""
    cells, layers, costs, paths, path_clusters, chains = (
        np.concatenate(column) for column in zip(*parts, strict=True)
    )
    edits = np.zeros(len(cells), dtype=np.int16)
    return _thinned(ClusterOptions(layers, cells, costs, paths, path_clusters, chains, edits))


def with_edits(recorded: ClusterOptions, edits: Sequence[Edit]) -> ClusterOptions:
    """Add the cheapest edited copy in each cell that no recorded option ends in."""
    if not edits:
        return recorded
    copies = _joined(_edited(recorded, edit, number) for number, edit in enumerate(edits, 1))
    taken = np.unique(_edit_cells(recorded))
    copies = copies._replace(cells=_edit_cells(copies))
    added = _thinned(copies.taken(~np.isin(copies.cells, taken)))
    both = _joined((recorded, added))
    return both.taken(np.argsort(both.layers, kind="stable"))


def _edited(recorded: ClusterOptions, edit: Edit, number: int) -> ClusterOptions:
    """Edited copies of those options for which this does not cost too much."""
    options = recorded.taken(recorded.costs + edit.cost <= BUDGET)
    present = np.arange(options.paths.shape[1]) < _samples(options)[:, None]
    return options._replace(
        costs=(options.costs + edit.cost).astype(np.float32),
        paths=np.where(present[..., None], edit_paths(options.paths, edit), 0.0).astype(np.float32),
        edits=np.full(len(options.costs), number, dtype=np.int16),
    )


def _joined(parts: Iterable[ClusterOptions]) -> ClusterOptions:
    return ClusterOptions(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _samples(options: ClusterOptions) -> NDArray[np.int64]:
    return np.array(DURATIONS)[options.layers] // SAMPLE_EVERY


def _edit_cells(options: ClusterOptions) -> NDArray[np.int64]:
    """A number for the duration and the cell of ``EDIT_CELL`` of each option's end."""
    ends = options.paths[np.arange(len(options.costs)), _samples(options) - 1].astype(np.float64)
    x, y, heading = np.floor(ends / EDIT_CELL + 0.5).astype(np.int64).T
    heading %= round(2.0 * np.pi / EDIT_CELL[2])
    # Nobody gets 4,096 cells far.
    return ((options.layers * 8192 + x + 4096) * 8192 + y + 4096) * 64 + heading


def _thinned(options: ClusterOptions) -> ClusterOptions:
    """The cheapest option of each cell, the first among equals."""
    layers, cells, costs, *_ = options
    order = np.lexsort((np.arange(len(cells)), costs, cells, layers))
    first = np.ones(len(order), dtype=bool)
    first[1:] = (np.diff(cells[order]) != 0) | (np.diff(layers[order]) != 0)
    return options.taken(order[first])
