"""The movement options of a mobility map as flat arrays for the compiled kernels."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import DTypeLike, NDArray

from mesa_mobility.errors import ModelError
from mesa_mobility.mobility import MobilityMap

FRAMES_A_SECOND = 30
FRAME_SECONDS = 1.0 / FRAMES_A_SECOND
SAMPLE_FRAMES = 3
"""Frames between two samples of an option's path."""

SAMPLES = 16
"""Samples of a path: the start and those of the longest option."""

LONGEST_MOVEMENT = (SAMPLES - 1) * SAMPLE_FRAMES
"""Frames of the longest option."""

LONGEST_MOVEMENT_S = LONGEST_MOVEMENT / FRAMES_A_SECOND
"""Seconds of the longest option."""

LEVELS = (4, 8, 12, 15)
"""Samples, at 0.4, 0.8, 1.2 and 1.5 s, at which the broad phase tests whole groups."""


_LINE = 64
"""Bytes of a cache line."""

_BLOCK = 4096
"""Options of a block."""

OptionRecords: TypeAlias = "np.recarray[Any, Any]"

OPTION = np.dtype(
    [
        ("x", "f4"),
        ("y", "f4"),
        ("ux", "f4"),
        ("uy", "f4"),
        ("speed", "f4"),
        ("stride", "f4"),
        ("reach", "f4"),
        ("frames", "i2"),
        ("cluster", "u2"),
    ],
    align=True,
)
"""What the search reads of an option, apart from its path and group: 32 bytes.

Fields: ``x``, ``y`` of the end, metres, and ``ux``, ``uy`` the unit vector of facing there;
``speed`` (displacement over duration, m/s); ``stride`` (greatest distance between two successive
samples, metres, rounded up); ``reach`` (greatest distance of the path from its start, metres,
rounded up); ``frames``; ``cluster`` at the end.
"""


class OptionTable(NamedTuple):
    """Options of all capabilities in a model, stacked.

    Clusters have consecutive numbers: those of capability k follow those of k - 1.  Options of a
    cluster are in groups of a few similar ones (see ``option_groups``).

    Values are in single precision, as in the map: each decision reads them from main memory.

    Attributes:
        offsets: (clusters + 1,) first option of each cluster, then the number of options.
        groups: (groups,) first option of each group.
        farthest: (clusters,) greatest reach of the options of each cluster, metres.
        options: (n,) records of ``OPTION``.
        heading: (n,) heading at the end of each option, radians.
        path: (n, 3, 16) x, y (metres) and heading (radians) at the samples from the start on. The
            end is repeated.
    """

    offsets: NDArray[np.int64]
    groups: NDArray[np.int64]
    farthest: NDArray[np.float64]
    options: OptionRecords
    heading: NDArray[np.float32]
    path: NDArray[np.float32]


class Parts(NamedTuple):
    """Options of a map, whole or shortened.

    Attributes:
        rows: (n,) rows of the map.
        share: (n,) the part of the option's length that is walked, and on foot of its turn, too.
        clusters: (n,) cluster at the end of each.
    """

    rows: NDArray[np.int64]
    share: NDArray[np.float64]
    clusters: NDArray[np.int64]

    def taken(self, order: NDArray[np.int64] | slice) -> Parts:
        """A selection of them, or all in another order."""
        return Parts(self.rows[order], self.share[order], self.clusters[order])


def sampled(mobility_map: MobilityMap, parts: Parts, samples: Sequence[int]) -> NDArray[np.float32]:
    """(n, samples, 3) x, y, heading of options, whole or shortened, at samples from 1 on.

    A shortened option covers a share of the ground and of the turn; with a share of 0 it turns on
    the spot.  On wheels it turns as the whole one does: with a share of the turn as well, wheels
    would slip to the side.
    """
    first = mobility_map.path_offsets[parts.rows, None]
    last = mobility_map.path_offsets[parts.rows + 1, None] - 1
    places = mobility_map.paths.take(
        np.minimum(first + np.array(samples, dtype=np.int64) - 1, last), axis=0
    )
    share = parts.share.astype(np.float32)
    turns_whole = (share == 0.0) | mobility_map.on_wheels
    of_turn = np.where(turns_whole, np.float32(1.0), share)
    places *= np.stack([share, share, of_turn], axis=1)[:, None]
    return places


def padded_paths(mobility_map: MobilityMap, parts: Parts) -> NDArray[np.float32]:
    """(n, 3, 16) x, y, heading of options, whole or shortened, at the samples from the start."""
    path = in_lines((len(parts.rows), 3, SAMPLES), np.float32)
    for block in _blocks(len(path)):
        places = sampled(mobility_map, parts.taken(block), range(1, SAMPLES))
        path[block, :, 0] = 0.0
        path[block, :, 1:] = places.transpose(0, 2, 1)
    return path


def in_blocks(
    path: NDArray[np.float32],
) -> Iterator[tuple[slice, NDArray[np.float32], NDArray[np.float32]]]:
    """Blocks of options: their slice, and (16, options) of their x and of their y.

    A block fits the processor's cache, and NumPy works along its options. Along the few samples of
    each option, or with all options at once, it takes several times as long.
    """
    for block in _blocks(len(path)):
        x, y = (np.ascontiguousarray(path[block, axis].T) for axis in (0, 1))
        yield block, x, y


def _blocks(n: int) -> list[slice]:
    return [slice(k, min(k + _BLOCK, n)) for k in range(0, n, _BLOCK)]


def option_table(
    mobility_map: MobilityMap,
    parts: Parts,
    path: NDArray[np.float32],
    offsets: NDArray[np.int64],
    groups: NDArray[np.int64],
) -> OptionTable:
    """The table of options, whole or shortened; the last three arguments are fields of it."""
    frames = mobility_map.durations[parts.rows]
    x, y, heading = path[:, :, -1].T
    reach, steps = np.empty(len(path)), np.empty(len(path))
    for block, xs, ys in in_blocks(path):
        reach[block] = np.sqrt(squared(xs, ys).max(axis=0))
        steps[block] = np.sqrt(squared(_differences(xs), _differences(ys)).max(axis=0))
    wide = heading.astype(np.float64)
    options = in_lines(len(path), OPTION).view(np.recarray)
    options.x, options.y = x, y
    options.ux, options.uy = np.cos(wide), np.sin(wide)
    options.speed = np.hypot(x.astype(np.float64), y) / (frames * FRAME_SECONDS)
    options.frames, options.cluster = frames, parts.clusters
    options.stride, options.reach = rounded_up(steps), rounded_up(reach)
    return OptionTable(
        offsets=offsets,
        groups=groups,
        farthest=np.maximum.reduceat(reach, offsets[:-1]),
        options=options,
        heading=heading.copy(),
        path=path,
    )


def squared(x: NDArray[np.floating], y: NDArray[np.floating]) -> NDArray[np.float64]:
    """x squared and y squared, summed in double precision."""
    squares = np.square(x, dtype=np.float64)
    squares += np.square(y, dtype=np.float64)
    return squares


def boxes(path: NDArray[np.float32]) -> NDArray[np.float32]:
    """(n, 4) least x and y, greatest x and y along options; ``path`` (n, 3, 16)."""
    spanned = np.empty((len(path), 4), dtype=np.float32)
    for block, x, y in in_blocks(path):
        spanned[block] = np.stack([x.min(0), y.min(0), x.max(0), y.max(0)], axis=1)
    return spanned


def _differences(x: NDArray[np.float32]) -> NDArray[np.float64]:
    """From each row to the next, in double precision."""
    return np.subtract(x[1:], x[:-1], dtype=np.float64)


def in_lines(shape: int | tuple[int, ...], dtype: DTypeLike) -> NDArray[Any]:
    """An empty array aligned to cache lines.

    Otherwise each option would lie in two lines, and both would be read from main memory.
    """
    size = int(np.prod(shape)) * np.dtype(dtype).itemsize
    memory = np.empty(size + _LINE, dtype=np.uint8)
    start = -memory.ctypes.data % _LINE
    return memory[start : start + size].view(dtype).reshape(shape)


def rounded_up(values: NDArray[np.float64]) -> NDArray[np.float32]:
    """The values in single precision, rounded up."""
    return np.nextafter(values.astype(np.float32), np.float32(np.inf))


def stack_tables(tables: Sequence[OptionTable]) -> OptionTable:
    """One table of several, with consecutive numbers of clusters and rows."""
    if len(tables) == 1:
        return tables[0]
    options = np.cumsum([0] + [len(table.options) for table in tables], dtype=np.int64)
    clusters = np.cumsum([0] + [len(table.farthest) for table in tables], dtype=np.int64)
    if clusters[-1] > np.iinfo(OPTION["cluster"].type).max:
        raise ModelError(
            f"pedestrian types: their maps have {clusters[-1]} clusters together, "
            f"expected {np.iinfo(OPTION['cluster'].type).max} at most"
        )
    records = in_lines(options[-1], OPTION).view(np.recarray)
    np.concatenate([table.options for table in tables], out=records)
    path = in_lines((options[-1], 3, SAMPLES), np.float32)
    np.concatenate([table.path for table in tables], out=path)
    records.cluster += np.repeat(clusters[:-1], np.diff(options)).astype(records.cluster.dtype)
    firsts = [table.offsets[:-1] + by for table, by in zip(tables, options, strict=False)]
    return OptionTable(
        offsets=np.concatenate([*firsts, options[-1:]]),
        groups=np.concatenate(
            [table.groups + by for table, by in zip(tables, options, strict=False)]
        ),
        farthest=np.concatenate([table.farthest for table in tables]),
        options=records,
        heading=np.concatenate([table.heading for table in tables]),
        path=path,
    )


def unstacked(
    table: OptionTable, first_option: NDArray[np.int64], first_cluster: NDArray[np.int32]
) -> list[OptionTable]:
    """The tables of which `stack_tables` has made one; paths and headings stay where they are.

    Args:
        table: the table of all.
        first_option: (tables,) row of the first option of each.
        first_cluster: (tables,) number of the first cluster of each.
    """
    if len(first_option) == 1:
        return [table]
    ends = *first_option[1:], len(table.options)
    last_clusters = *first_cluster[1:], len(table.farthest)
    return [
        _part(table, slice(*options), slice(*clusters))
        for options, clusters in zip(
            zip(first_option, ends, strict=True),
            zip(first_cluster, last_clusters, strict=True),
            strict=True,
        )
    ]


def _part(table: OptionTable, rows: slice, clusters: slice) -> OptionTable:
    options = table.options[rows].copy().view(np.recarray)
    options.cluster -= options.cluster.dtype.type(clusters.start)
    groups = table.groups[slice(*np.searchsorted(table.groups, (rows.start, rows.stop)))]
    return OptionTable(
        offsets=table.offsets[clusters.start : clusters.stop + 1] - rows.start,
        groups=groups - rows.start,
        farthest=table.farthest[clusters],
        options=options,
        heading=table.heading[rows],
        path=table.path[rows],
    )
