"""What a file of laid-out options must hold, since compiled code trusts it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from mesa_mobility.compiled.kept_arrays import Arrays
from mesa_mobility.compiled.simd import WIDE
from mesa_mobility.crowd.options.option_groups import CLUSTER, GROUP_SIZE, LANE_FIELDS
from mesa_mobility.crowd.options.table import LEVELS, LONGEST_MOVEMENT, OPTION, SAMPLES
from mesa_mobility.errors import ContentError
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.schema import Array, Members, Records, check

_FAR = 100.0
"""Metres that no option covers, radians by which none turns, and m/s of none."""

_METRES = Array("f4", (), -_FAR, _FAR)

_OPTION_FIELDS = {
    **dict.fromkeys(("x", "y"), _METRES),
    **dict.fromkeys(("ux", "uy"), Array("f4", (), -1.0, 1.0)),
    **dict.fromkeys(("speed", "stride", "reach"), Array("f4", (), 0.0, _FAR)),
    "frames": Array("i2", (), 1, LONGEST_MOVEMENT),
    "cluster": Array("u2", (), 0, below="clusters"),
}

_CLUSTER_FIELDS = {
    "first": Array("i8", (), 0, below="groups"),
    "last": Array("i8", (), 1, below="groups+1"),
    "stay": Array("i8", (), -1, below="groups"),
    "whole": Array("f8", (4,), -_FAR, _FAR),
    "reach": Array("f8", (len(LEVELS),), 0.0, _FAR),
    "spans": Array("f4", (4, len(LEVELS)), -_FAR, _FAR),
}

_MEMBERS: dict[str, Array | Records] = {
    "table.offsets": Array("i8", ("clusters+1",), 0, below="options+1", rising=True),
    "table.groups": Array("i8", ("groups",), 0, below="options", rising=True),
    "table.farthest": Array("f8", ("clusters",), 0.0, _FAR),
    "table.options": Records(OPTION, _OPTION_FIELDS, ("options",)),
    "table.heading": Array("f4", ("options",), -_FAR, _FAR),
    "table.path": Array("f4", ("options", 3, SAMPLES), -_FAR, _FAR),
    "groups.clusters": Records(CLUSTER, _CLUSTER_FIELDS, ("clusters",)),
    "groups.first": Array("i8", ("groups+1",), 0, below="options+1", rising=True),
    "groups.ends": Array("f8", (9, "groups"), -_FAR, _FAR),
    "groups.at": Array("f4", (len(LEVELS), 3, f"groups+{WIDE}"), -_FAR, _FAR),
    "groups.lanes": Array("f4", ("groups", LANE_FIELDS, GROUP_SIZE), -_FAR, _FAR),
    "parts.rows": Array("i8", ("options",), 0),
    "parts.share": Array("f8", ("options",), 0.0, 1.0),
    "parts.clusters": Array("i8", ("options",), 0, below="clusters"),
    "extent": Array("f8", ("maps",), 0.0, 2.0 * _FAR),
}

DTYPES = {name: np.dtype(kind.dtype) for name, kind in _MEMBERS.items()}


def check_options(arrays: Arrays, maps: Sequence[MobilityMap]) -> None:
    """Raise ContentError unless laid-out options are in range, and fit each other and the maps.

    Args:
        arrays: those of ``DTYPES``.
        maps: whose options they are.
    """
    sizes = {
        "maps": len(maps),
        "clusters": sum(each.n_clusters for each in maps),
        "options": len(arrays["table.options"]),
        "groups": len(arrays["table.groups"]),
    }
    check(arrays, Members(_MEMBERS), "options", sizes)
    _check_groups(arrays)
    clusters = np.cumsum([0] + [each.n_clusters for each in maps])
    for map_, (first, last) in zip(maps, pairwise(clusters.tolist()), strict=True):
        options = slice(*arrays["table.offsets"][[first, last]].tolist())
        _check_parts(arrays, map_, options, first)


def _check_groups(arrays: Arrays) -> None:
    """Refuse groups that are not those of the clusters and of the options."""
    offsets, starts = arrays["table.offsets"], arrays["groups.first"]
    clusters = arrays["groups.clusters"]
    spans = np.searchsorted(starts, offsets)
    stays = clusters["stay"] >= 0
    _refuse_unless(
        starts[0] == offsets[0] == 0 and starts[-1] == offsets[-1] == len(arrays["table.options"]),
        np.diff(starts).max() <= GROUP_SIZE,
        np.array_equal(arrays["table.groups"], starts[:-1]),
        np.array_equal(starts[spans], offsets),
        np.array_equal(clusters["first"], spans[:-1]),
        np.array_equal(clusters["last"], spans[1:]),
        (clusters["stay"] >= clusters["first"])[stays].all(),
        (clusters["stay"] < clusters["last"])[stays].all(),
    )


def _check_parts(arrays: Arrays, map_: MobilityMap, options: slice, first: int) -> None:
    """Refuse options that are not of their map, whose first cluster has this number."""
    laid_out, rows = arrays["table.options"][options], arrays["parts.rows"][options]
    clusters = arrays["parts.clusters"][options]
    _refuse_unless(
        rows.max() < map_.n_options,
        clusters.max() < map_.n_clusters,
        np.array_equal(laid_out["cluster"], clusters + first),
    )
    _refuse_unless(np.array_equal(laid_out["frames"], map_.durations[rows]))


def _refuse_unless(*fit: Any) -> None:
    if not all(fit):
        raise ContentError("options: their groups, clusters and paths do not fit each other")
