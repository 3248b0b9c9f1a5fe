"""Options of one cluster, thinned: the cheapest of each cell, and edited copies where none ends."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import kept
from mesa_mobility.mobility.edits import SAMPLE_EVERY, Edit, edit_paths, rotations

DURATIONS = (12, 24, 45)
"""Option durations in frames; 45 frames, 1.5 s, is the paper's time step."""

BUDGET = 3.3
"""Most that a path may cost: two transitions of some quality, or three that hardly show.

An edit counts too.
"""

EDITED_FRAMES = DURATIONS[-1:]
"""Durations of the options that are edited, if nothing else is said."""

EDIT_CELL = (0.15, 0.15, np.deg2rad(20.0))
"""Cell in which the cheapest edited option is kept if no recorded one ends there."""


class ClusterOptions(NamedTuple):
    """Options of one cluster, a row each.

    Attributes:
        layers: index of the duration.
        cells: cell in which the option ends.
        costs: cost of the option.
        paths: the path.
        path_clusters: clusters along the path.
        sources: pose in which the option starts.
        jumps: transitions of the option between recordings.
        edits: number of the edit that has made the option, 0 for none.
    """

    layers: NDArray[np.int64]
    cells: NDArray[np.int64]
    costs: NDArray[np.float32]
    paths: NDArray[np.float32]
    path_clusters: NDArray[np.int32]
    sources: NDArray[np.int32]
    jumps: NDArray[np.int64]
    edits: NDArray[np.int16]

    def taken(self, rows: NDArray[np.generic]) -> ClusterOptions:
        """Some of the options, in the order of ``rows``."""
        return ClusterOptions(*(column[rows] for column in self))


def merge(parts: list[tuple[NDArray, ...]]) -> ClusterOptions:
    """Thin the parts of one cluster together; earlier parts win ties."""
    cells, layers, costs, paths, path_clusters, sources, jumps = (
        np.concatenate(column) for column in zip(*parts, strict=True)
    )
    edits = np.zeros(len(cells), dtype=np.int16)
    return _thinned(
        ClusterOptions(layers, cells, costs, paths, path_clusters, sources, jumps, edits)
    )


def with_copies(
    recorded: ClusterOptions, edits: Sequence[Edit], frames: Sequence[int] = EDITED_FRAMES
) -> ClusterOptions:
    """Add edited copies of options, the cheapest in each cell that no recorded one ends in.

    Each has the number of its edit; its path is still that of the original.

    Recordings leave gaps among the places that a body can be in after 1.5 s.  Shorter options lie
    close to each other as recorded; edited ones would add hardly a place and cost time in each
    decision.

    Args:
        recorded: the options, by layer.
        edits: how they are edited.
        frames: durations of the options of which there are copies.
    """
    if not edits:
        return recorded
    parts = []
    for layer, duration in enumerate(DURATIONS):
        own = recorded.taken(np.flatnonzero(recorded.layers == layer))
        parts.append(own)
        if duration not in frames or not len(own.layers):
            continue
        paths = np.ascontiguousarray(own.paths[:, : duration // SAMPLE_EVERY])
        rows, by, cells, costs = _cheapest_copies(
            own.costs,
            paths,
            np.array([edit.cost for edit in edits]),
            np.array([edit.turn_rate for edit in edits]),
            np.array([rotations(edit, paths.shape[1]) for edit in edits]),
            BUDGET,
            np.array(EDIT_CELL),
        )
        order = np.argsort(cells)
        parts.append(
            own.taken(rows[order])._replace(
                cells=cells[order], costs=costs[order], edits=(by[order] + 1).astype(np.int16)
            )
        )
    return _joined(parts)


def edit_copies(options: ClusterOptions, edits: Sequence[Edit]) -> None:
    """Edit the paths of those options that have the number of an edit."""
    # In full only where they are kept, of some twenty copies one; all of an edit at once.
    for number, edit in enumerate(edits, start=1):
        own = np.flatnonzero(options.edits == number)
        options.paths[own] = edit_paths(options.paths[own], edit)


def _joined(parts: Iterable[ClusterOptions]) -> ClusterOptions:
    return ClusterOptions(*(np.concatenate(column) for column in zip(*parts, strict=True)))


@kept(nogil=True)
def _cheapest_copies(
    costs: NDArray[np.float32],
    paths: NDArray[np.float32],
    edit_costs: NDArray[np.float64],
    turn_rates: NDArray[np.float64],
    turned: NDArray[np.float64],
    budget: float,
    cell: NDArray[np.float64],
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.float32]]:
    """The cheapest copy in each cell in which no option ends: its row, edit, cell and cost.

    ``turned`` (edits, samples, 2) are the cosine and sine of each step's rotation, times stride.
    Among copies of the same cost, the first edit counts, and of one edit the first option.
    """
    headings = round(2.0 * np.pi / cell[2])
    last = paths.shape[1] - 1
    size = 64
    while size < 2 * (len(costs) * (len(edit_costs) + 1)):
        size *= 2
    keys = np.full(size, -1, np.int64)
    row_of = np.empty(size, np.int64)
    edit_of = np.empty(size, np.int64)
    cost_of = np.empty(size, np.float32)
    used = 0
    for edit in range(-1, len(edit_costs)):
        for row in range(len(costs)):
            cost = costs[row]
            x, y, heading = 0.0, 0.0, np.float64(paths[row, last, 2])
            if edit < 0:
                x = np.float64(paths[row, last, 0])
                y = np.float64(paths[row, last, 1])
            else:
                if cost + edit_costs[edit] > budget:
                    continue
                cost = np.float32(cost + edit_costs[edit])
                before_x, before_y = 0.0, 0.0
                for s in range(last + 1):
                    dx, dy = paths[row, s, 0] - before_x, paths[row, s, 1] - before_y
                    before_x, before_y = np.float64(paths[row, s, 0]), np.float64(paths[row, s, 1])
                    x += turned[edit, s, 0] * dx - turned[edit, s, 1] * dy
                    y += turned[edit, s, 1] * dx + turned[edit, s, 0] * dy
                heading += turn_rates[edit] * (last + 1)
                # Ends are compared as they will be stored.
                x, y = np.float64(np.float32(x)), np.float64(np.float32(y))
                heading = np.float64(np.float32(heading))
            ix = np.int64(np.floor(x / cell[0] + 0.5))
            iy = np.int64(np.floor(y / cell[1] + 0.5))
            ih = np.int64(np.floor(heading / cell[2] + 0.5)) % headings
            # Nobody gets 4,096 cells far.
            key = ((ix + 4096) * 8192 + iy + 4096) * 64 + ih
            slot = (key * 0x9E3779B1 >> 15) & (size - 1)
            while keys[slot] >= 0 and keys[slot] != key:
                slot = (slot + 1) & (size - 1)
            if keys[slot] < 0:
                keys[slot] = key
                used += edit >= 0
            elif edit < 0 or edit_of[slot] < 0 or cost >= cost_of[slot]:
                continue
            row_of[slot], edit_of[slot], cost_of[slot] = row, edit, cost
    out_row, out_edit = np.empty(used, np.int64), np.empty(used, np.int64)
    out_cell, out_cost = np.empty(used, np.int64), np.empty(used, np.float32)
    n = 0
    for slot in range(size):
        if keys[slot] >= 0 and edit_of[slot] >= 0:
            out_row[n], out_edit[n] = row_of[slot], edit_of[slot]
            out_cell[n], out_cost[n] = keys[slot], cost_of[slot]
            n += 1
    return out_row, out_edit, out_cell, out_cost


def _thinned(options: ClusterOptions) -> ClusterOptions:
    """The cheapest option of each cell, the first among equals."""
    layers, cells, costs, *_ = options
    order = np.lexsort((np.arange(len(cells)), costs, cells, layers))
    first = np.ones(len(order), dtype=bool)
    first[1:] = (np.diff(cells[order]) != 0) | (np.diff(layers[order]) != 0)
    return options.taken(order[first])
