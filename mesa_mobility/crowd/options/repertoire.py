"""Movement options of all pedestrian types of a model, stacked for compiled functions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility._once import cached_once
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.option_groups import OptionGroups, make_groups
from mesa_mobility.crowd.options.table import OptionTable, boxes, stack_tables
from mesa_mobility.mobility import MobilityMap


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
    return Repertoire(
        capabilities=capabilities,
        table=table,
        groups=make_groups(table, spanned),
        first_cluster=clusters.astype(np.int32),
        first_option=options.astype(np.int64),
        standing=standing.astype(np.int32),
        reach=np.array([each.longest_reach for each in capabilities]),
        extent=np.maximum.reduceat(np.hypot(*(spanned[:, 2:] - spanned[:, :2]).T), options).astype(
            np.float64
        ),
    )
