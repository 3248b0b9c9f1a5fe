"""The movement options of a mobility map as flat arrays for the compiled kernels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.mobility import MobilityMap

FRAME_SECONDS = 1.0 / 30.0
SAMPLE_FRAMES = 3
"""Frames between two samples of an option's path."""

SAMPLES = 16
"""Samples of a path: the start and those of the longest option."""

LEVELS = (4, 8, 12, 15)
"""Samples, at 0.4, 0.8, 1.2 and 1.5 s, at which all options of a cluster are looked at together."""


class OptionTable(NamedTuple):
    """Options of all capabilities in a model, stacked.

    Clusters are numbered through: those of capability k follow those of k - 1.  Options of a
    cluster are in groups of a few that are alike (see ``groups``).

    Fields: ``offsets`` (clusters + 1,) and ``groups`` (groups,) first option of each; ``farthest``
    (clusters,) reach of its options; by option: ``x``, ``y``, ``heading`` of the end and its unit
    vector ``ux``, ``uy``, ``speed`` (displacement over duration, m/s), ``frames``, ``cluster`` at
    the end, ``reach`` (largest distance of the path from its start), ``stride`` (longest way
    between two samples, metres), ``path`` (n, 3, 16): x, y, heading at the samples, the start
    among them and the end again once it has come, ``at_x``, ``at_y`` (levels, n) the same at the
    ``LEVELS`` alone.  Single precision, as the map: what is read
    at each decision comes from main memory.
    """

    offsets: NDArray[np.int64]
    groups: NDArray[np.int64]
    farthest: NDArray[np.float64]
    x: NDArray[np.float32]
    y: NDArray[np.float32]
    heading: NDArray[np.float32]
    ux: NDArray[np.float32]
    uy: NDArray[np.float32]
    speed: NDArray[np.float32]
    frames: NDArray[np.int32]
    cluster: NDArray[np.int32]
    reach: NDArray[np.float64]
    stride: NDArray[np.float32]
    path: NDArray[np.float32]
    at_x: NDArray[np.float32]
    at_y: NDArray[np.float32]


def padded_paths(mobility_map: MobilityMap, rows: NDArray[np.int64]) -> NDArray[np.float32]:
    """(n, 3, 16) x, y, heading of the options in ``rows`` at the samples, from the start on."""
    first = mobility_map.path_offsets[rows]
    last = mobility_map.path_offsets[rows + 1] - 1
    path = np.zeros((len(rows), 3, SAMPLES), dtype=np.float32)
    for k in range(1, SAMPLES):
        path[:, :, k] = mobility_map.paths[np.minimum(first + k - 1, last)]
    return path


def option_table(
    mobility_map: MobilityMap,
    rows: NDArray[np.int64],
    offsets: NDArray[np.int64],
    groups: NDArray[np.int64],
) -> OptionTable:
    """The table of the options in ``rows`` of a map; ``offsets`` and ``groups`` as its fields."""
    path = padded_paths(mobility_map, rows)
    x, y = mobility_map.end_points[rows].astype(np.float32).T
    heading = mobility_map.end_headings[rows].astype(np.float32)
    frames = mobility_map.durations[rows].astype(np.int32)
    places = path[:, :2].astype(np.float64)
    reach = np.hypot(places[:, 0], places[:, 1]).max(axis=1)
    steps = np.hypot(*np.moveaxis(np.diff(places, axis=2), 1, 0)).max(axis=1)
    wide = heading.astype(np.float64)
    speed = np.hypot(x.astype(np.float64), y) / (frames * FRAME_SECONDS)
    return OptionTable(
        offsets=offsets,
        groups=groups,
        farthest=np.maximum.reduceat(reach, offsets[:-1]),
        x=np.ascontiguousarray(x),
        y=np.ascontiguousarray(y),
        heading=heading,
        ux=np.cos(wide).astype(np.float32),
        uy=np.sin(wide).astype(np.float32),
        speed=speed.astype(np.float32),
        frames=frames,
        cluster=mobility_map.end_clusters[rows].astype(np.int32),
        reach=reach,
        stride=np.nextafter(steps.astype(np.float32), np.float32(np.inf)),
        path=path,
        at_x=np.ascontiguousarray(path[:, 0, LEVELS].T),
        at_y=np.ascontiguousarray(path[:, 1, LEVELS].T),
    )


def stack_tables(tables: Sequence[OptionTable]) -> OptionTable:
    """One table for several, clusters and rows numbered through."""
    if len(tables) == 1:
        return tables[0]
    options = np.cumsum([0] + [len(table.x) for table in tables])
    clusters = np.cumsum([0] + [len(table.farthest) for table in tables])
    shift = {"offsets": options, "groups": options, "cluster": clusters}
    columns = {}
    for name in OptionTable._fields:
        parts = [getattr(table, name) for table in tables]
        if name in shift:
            parts = [part + by for part, by in zip(parts, shift[name], strict=False)]
        if name == "offsets":
            parts = [parts[0], *(part[1:] for part in parts[1:])]
        axis = 1 if name in ("at_x", "at_y") else 0
        columns[name] = np.concatenate(parts, axis=axis).astype(getattr(tables[0], name).dtype)
    return OptionTable(**columns)
