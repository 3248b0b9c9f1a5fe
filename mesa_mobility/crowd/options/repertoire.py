"""Movement options of all maps of a model, stacked for compiled functions."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility._once import cached_once
from mesa_mobility.compiled.kept_arrays import Arrays, kept_arrays
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.kept_options import DTYPES, check_options
from mesa_mobility.crowd.options.option_groups import OptionGroups, make_groups
from mesa_mobility.crowd.options.table import (
    OPTION,
    OptionTable,
    Parts,
    boxes,
    stack_tables,
    unstacked,
)
from mesa_mobility.mobility import MobilityMap


@dataclass(frozen=True, eq=False)
class Repertoire:
    """Capabilities of several maps, with consecutive numbers of clusters and options.

    Attributes:
        capabilities: one for each map: those of the pedestrian types, then others.
        table: their options.
        groups: the options in groups, with the extent of each.
        first_cluster: (maps,) number of each map's first cluster.
        first_option: (maps,) row of each map's first option.
        standing: (maps,) number of each map's standing cluster.
        reach: by map, greatest distance of an option from its start, metres.
        extent: by map, upper bound of the distance between two points of one option, metres.
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

    def capability_of(self, cluster: int) -> tuple[Capability, int]:
        """The capability with a cluster, and the number of the cluster in it."""
        number, own = within_maps(np.array([cluster]), self.first_cluster)
        return self.capabilities[int(number[0])], int(own[0])


def within_maps(
    numbers: NDArray[np.integer], firsts: NDArray[np.integer]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Maps to which numbers of clusters or options belong, and the numbers there.

    Args:
        numbers: (n,) at least 0.
        firsts: (maps,) the first of each map.

    Returns:
        (n,) number of the map, and (n,) number in this map.
    """
    of = np.searchsorted(firsts, numbers, side="right").astype(np.int64) - 1
    return of, numbers.astype(np.int64) - firsts[of]


@cached_once(maxsize=4)
def repertoire(
    maps: tuple[MobilityMap, ...],
    durations: tuple[int, ...],
    shares: tuple[tuple[float, ...], ...] = (),
    most_acceleration: float | None = None,
) -> Repertoire:
    """The repertoire of these maps; models with the same maps share it.

    Args:
        maps: those of the types, and others.
        durations: option durations in frames.
        shares: shortened copies, as for ``Capability``.
        most_acceleration: of an option, m/s2, as for ``Capability``.

    Raises:
        ModelError: a cluster has no option of these durations.
    """
    numbers = durations, shares, most_acceleration

    def lay_out() -> tuple[Repertoire, Arrays]:
        arrays = _laid_out(maps, *numbers)
        return _of_arrays(maps, arrays), arrays

    def take(arrays: Arrays) -> Repertoire:
        check_options(arrays, maps)
        return _of_arrays(maps, arrays)

    origins = [each.origin for each in maps]
    if None in origins:
        return lay_out()[0]
    return kept_arrays("options", (origins, numbers), DTYPES, lay_out, take)


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
    capabilities = [own[map_] for map_ in maps]
    table = stack_tables([each.table for each in capabilities])
    spanned = boxes(table.path)
    options = np.cumsum([0] + [len(each.table.options) for each in capabilities[:-1]])
    widths = np.hypot(*(spanned[:, 2:] - spanned[:, :2]).T)
    parts = Parts(
        *(np.concatenate(each) for each in zip(*(c.parts for c in capabilities), strict=True))
    )
    return {
        **_named("table", table),
        **_named("groups", make_groups(table, spanned)),
        **_named("parts", parts),
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

    columns, parts = named("table"), Parts(**named("parts"))
    columns["options"] = columns["options"].view(OPTION).view(np.recarray)
    table = OptionTable(**columns)
    clusters = np.cumsum([0] + [each.n_clusters for each in maps])
    rows = table.offsets[clusters]
    tables = unstacked(table, rows[:-1], clusters[:-1])
    capabilities = tuple(
        Capability.of_table(map_, parts.taken(slice(*own)), laid_out)
        for map_, own, laid_out in zip(maps, pairwise(rows.tolist()), tables, strict=True)
    )
    return Repertoire(
        capabilities=capabilities,
        table=table,
        groups=OptionGroups(**named("groups")),
        first_cluster=clusters[:-1].astype(np.int32),
        first_option=rows[:-1].astype(np.int64),
        standing=(clusters[:-1] + [each.standing for each in capabilities]).astype(np.int32),
        reach=np.array([each.longest_reach for each in capabilities]),
        extent=arrays["extent"],
    )
