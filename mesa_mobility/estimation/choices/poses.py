"""From which poses a measured person may have chosen: those in which movements as fast end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.table import OptionTable

BIN = 0.1
"""Width of a class of speeds, m/s."""

STANDS = 0.4
"""Speed up to which people are not taken to face where they walk, m/s: heads sway."""


@dataclass(frozen=True, eq=False)
class Poses:
    """Clusters of poses of one map, by the speed of the movements that end in them.

    Head tracks show neither the pose nor the phase of the gait.  So a choice is among the options
    of several clusters, drawn as often as movements of the person's speed end in them. Shortened
    copies count: in a simulation, most of those who creep are in poses of people who walk.

    Attributes:
        counts: (classes, clusters) movements of each class of speeds that end in each cluster.
    """

    counts: NDArray[np.float64]

    @classmethod
    def of(cls, table: OptionTable, clusters: int) -> Poses:
        """Those of the options in a table."""
        bins = (table.options.speed / BIN).astype(np.int64)
        counts = np.zeros((int(bins.max()) + 1, clusters))
        np.add.at(counts, (bins, table.options.cluster.astype(np.int64)), 1.0)
        return cls(counts)

    def draw(self, speed: float, count: int, rng: np.random.Generator) -> NDArray[np.int64]:
        """At most ``count`` different clusters of somebody who has walked at ``speed``, m/s."""
        counts = self.counts[min(int(speed / BIN), len(self.counts) - 1)]
        known = np.flatnonzero(counts)
        shares = counts[known] / counts[known].sum()
        drawn: NDArray[np.int64] = np.sort(
            rng.choice(known, min(count, len(known)), replace=False, p=shares)
        )
        return drawn
