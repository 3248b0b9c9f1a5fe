"""From which poses a measured person may have chosen: clusters that enter at their speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.table import FRAME_SECONDS, SAMPLE_FRAMES

SPREAD = 0.25
"""How far the speed at which a cluster enters its options may be from a measured speed, m/s: the
standard deviation of a normal error."""

STANDS = 0.4
"""Speed up to which somebody may stand, m/s."""


@dataclass(frozen=True, eq=False)
class Poses:
    """Clusters of poses of one map, with the speeds at which they begin their options.

    Head tracks show neither the pose nor the phase of the gait.  So a choice is among the options
    of several clusters, drawn with probabilities that fall with the difference of speeds.

    Attributes:
        speeds: (clusters,) m/s.
        standing: number of the standing cluster.
    """

    speeds: NDArray[np.float64]
    standing: int

    @classmethod
    def of(cls, capability: Capability) -> Poses:
        """Those of a capability: medians of the first samples of its whole options."""
        table = capability.table
        first = np.hypot(table.path[:, 0, 1], table.path[:, 1, 1]) / (SAMPLE_FRAMES * FRAME_SECONDS)
        whole = capability.parts.share == 1.0
        speeds = np.empty(capability.n_clusters)
        for cluster in range(capability.n_clusters):
            own = slice(*table.offsets[cluster : cluster + 2])
            speeds[cluster] = np.median(first[own][whole[own]])
        return cls(speeds, capability.standing)

    def draw(self, speed: float, count: int, rng: np.random.Generator) -> NDArray[np.int64]:
        """(count,) different clusters from which somebody may go on who walks at ``speed``, m/s.

        The standing one is always among them for those who are slower than ``STANDS``.
        """
        # Slower steps are shortened copies of those of the slowest clusters that walk.
        off = (self.speeds - speed) / SPREAD
        weights = np.exp(-0.5 * np.minimum(off * off, 50.0))
        # Of the largest of independent exponential clocks: a weighted draw without replacement.
        keys = np.log(rng.random(len(weights))) / weights
        if speed < STANDS:
            keys[self.standing] = np.inf
        drawn: NDArray[np.int64] = np.sort(np.argsort(-keys, kind="stable")[:count])
        return drawn
