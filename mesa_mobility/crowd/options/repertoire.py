"""Movement options of all pedestrian types of a model, stacked for compiled functions."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility._once import cached_once
from mesa_mobility.compiled.kept_arrays import Arrays, kept_arrays
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.option_groups import CLUSTER, OptionGroups, make_groups
from mesa_mobility.crowd.options.table import (
    OPTION,
    OptionTable,
    Parts,
    boxes,
    stack_tables,
    unstacked,
)
from mesa_mobility.mobility import MobilityMap

_KINDS: dict[str, Any] = {
    "table.offsets": "i8",
    "table.groups": "i8",
    "table.farthest": "f8",
    "table.options": OPTION,
    "table.heading": "f4",
    "table.path": "f4",
    "groups.clusters": CLUSTER,
    "groups.first": "i8",
    "groups.ends": "f8",
    "groups.at": "f4",
    "groups.lanes": "f4",
    "parts.rows": "i8",
    "parts.share": "f8",
    "parts.clusters": "i8",
    "first_cluster": "i4",
    "first_option": "i8",
    "standing": "i4",
    "reach": "f8",
    "extent": "f8",
}

_DTYPES = {name: np.dtype(kind) for name, kind in _KINDS.items()}


@dataclass(frozen=True, eq=False)
class Repertoire:
    """Capabilities of several types, with consecutive numbers of clusters and options.

    Attributes:
        capabilities: one for each type.
        table: their options.
        groups: the options in groups, with the extent of each.
        first_cluster: (types,) number of each type's first cluster.
        first_option: (types,) row of each type's first option.
        standing: (types,) number of each type's standing cluster.
        reach: by type, greatest distance of an option from its start, metres.
        extent: by type, upper bound of the distance between two points of one option, metres.
    """

    capabilities: tuple[Capability, ...]
    table: OptionTable
    groups: OptionGroups
    first_cluster: NDArray[np.int32]
    first_option: NDArray[np.int64]
    standing: NDArray[np.int32]
    reach: NDArray[np.float64]
    extent: NDArray[np.float64]

    def __deepcopy__(self, memo: dict[int, Any]) -> Repertoire:
        """Itself: models share it, and its arrays are aligned for compiled functions."""
        return self


@cached_once(maxsize=4)
def repertoire(
    maps: tuple[MobilityMap, ...],
    durations: tuple[int, ...],
    shares: tuple[tuple[float, ...], ...] = (),
    most_acceleration: float | None = None,
) -> Repertoire:
    """The repertoire of these maps; models with the same maps share it.

    Args:
        maps: one for each type.
        durations: option durations in frames.
        shares: shortened copies, as for ``Capability``.
        most_acceleration: of an option, m/s2, as for ``Capability``.

    Raises:
        ModelError: a cluster has no option of these durations.
    """
    numbers = durations, shares, most_acceleration

    def lay_out() -> Arrays:
        return _laid_out(maps, *numbers)

    origins = [each.origin for each in maps]
    if None in origins:
        return _of_arrays(maps, lay_out())
    return _of_arrays(maps, kept_arrays("options", (origins, numbers), _DTYPES, lay_out))


def _laid_out(
    maps: tuple[MobilityMap, ...],
    durations: tuple[int, ...],
    shares: tuple[tuple[float, ...], ...],
    most_acceleration: float | None,
) -> dict[str, NDArray[Any]]:
    """The arrays of a repertoire, by name."""
    own = {
        map_: Capability(map_, durations, shares, most_acceleration) for map_ in dict.fromkeys(maps)
    }
    capabilities = tuple(own[map_] for map_ in maps)
    table = stack_tables([each.table for each in capabilities])
    spanned = boxes(table.path)
    clusters = np.cumsum([0] + [each.n_clusters for each in capabilities], dtype=np.int64)[:-1]
    options = np.cumsum([0] + [len(each.table.options) for each in capabilities], dtype=np.int64)[
        :-1
    ]
    standing = clusters + [each.standing for each in capabilities]
    widths = np.hypot(*(spanned[:, 2:] - spanned[:, :2]).T)
    parts = Parts(
        *(np.concatenate(each) for each in zip(*(c.parts for c in capabilities), strict=True))
    )
    return {
        **_named("table", table),
        **_named("groups", make_groups(table, spanned)),
        **_named("parts", parts),
        "first_cluster": clusters.astype(np.int32),
        "first_option": options.astype(np.int64),
        "standing": standing.astype(np.int32),
        "reach": np.array([each.longest_reach for each in capabilities]),
        "extent": np.maximum.reduceat(widths, options).astype(np.float64),
    }


def _named(of: str, arrays: OptionTable | OptionGroups | Parts) -> dict[str, NDArray[Any]]:
    # Record arrays have types of their own, which a file does not tell apart.
    return {f"{of}.{name}": np.asarray(each) for name, each in arrays._asdict().items()}


def _of_arrays(maps: tuple[MobilityMap, ...], arrays: Arrays) -> Repertoire:
    """The repertoire of these arrays."""

    def named(of: str) -> dict[str, Any]:
        start = f"{of}."
        return {
            name.removeprefix(start): each
            for name, each in arrays.items()
            if name.startswith(start)
        }

    table, parts = named("table"), Parts(**named("parts"))
    table["options"] = table["options"].view(OPTION).view(np.recarray)
    whole = OptionTable(**table)
    rest = {name: each for name, each in arrays.items() if "." not in name}
    tables = unstacked(whole, rest["first_option"], rest["first_cluster"])
    starts = [*rest["first_option"].tolist(), len(whole.options)]
    capabilities = (
        Capability.of_table(map_, parts.taken(slice(*rows)), own)
        for map_, rows, own in zip(maps, pairwise(starts), tables, strict=True)
    )
    return Repertoire(tuple(capabilities), whole, OptionGroups(**named("groups")), **rest)
