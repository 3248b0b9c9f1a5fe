"""Groups of people who belong together."""

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Deciding, SpeedRule

LEAST_SHARE = 0.2


class WalkTogether(SpeedRule):
    """Members of a group walk at the pace of the slowest and do not run away from one another.

    Members ahead of their group's middle by more than h metres of route slow down, to a fifth of
    the group's pace at 2 h. They never stop, so that nobody waits in a door and blocks the others.
    Members behind by more than h walk at their own pace. h is
    (N - 1) / 2 m for a group of N, the distance beyond which Moussaid et al. (2010, PLoS ONE
    5: e10047) have members drawn to the group's centre, but 1 m at least.

    Only members with the same destination wait for one another. The formation is left to
    the other terms.
    """

    name = "walk_together"

    def speeds(self, deciding: Deciding, speeds: NDArray[np.float64]) -> NDArray[np.float64]:
        """Preferred speeds for now, m/s."""
        inside = deciding.inside
        groups, to_go = inside.groups, inside.distances
        at = inside.places(deciding.pedestrians)
        own = groups[at]
        if not own.any():
            return speeds
        slowest = np.full(groups.max() + 1, np.inf)
        np.minimum.at(slowest, groups, inside.preferred_speeds)

        # A group has a part for each destination, as after the first has crossed a gate.
        members = (groups > 0) & np.isfinite(to_go)
        both = np.column_stack([groups, inside.destinations])[members]
        parts, part = np.unique(both, axis=0, return_inverse=True)
        part = part.reshape(-1)
        size = np.bincount(part, minlength=len(parts))
        middle = np.bincount(part, to_go[members], len(parts)) / size

        part_of = np.full(len(groups), -1)
        part_of[members] = part
        mine = part_of[at]
        with_way = mine >= 0
        ahead, h = np.zeros(len(at)), np.ones(len(at))
        ahead[with_way] = middle[mine[with_way]] - to_go[at][with_way]
        h[with_way] = np.maximum((size[mine[with_way]] - 1) / 2.0, 1.0)

        together = np.minimum(speeds, slowest[own]) * np.clip(2.0 - ahead / h, LEAST_SHARE, 1.0)
        return np.where((own > 0) & (ahead >= -h), together, speeds)
