"""Small groups walk side by side."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Deciding, Desired, Range, Tactic, World
from mesa_mobility.floorplan import lines_of_sight

# Largest group that walks in one row; those of larger ones are seen to fall apart.
_MOST = 4

# Metres beyond which a member has been left behind, or is on a way of their own.
_NEAR = 4.0

# Speed below which somebody sets off, or is held up and takes any way on, m/s.
_WALKS = 0.4

# Seconds ahead to which members are taken to walk on as they do.
_SOON = 0.4

# Metres within which somebody gets to their place in the row, and the most by which they turn
# aside, radians.
_WITHIN, _TURN = 1.5, 0.5

# Seconds within which a member behind or ahead gets to their place, and the shares of their pace
# between which they do so.
_CATCHES_UP, _LEAST, _FASTEST = 1.5, 0.5, 1.3


class WalkingAbreast(Tactic):
    """Members of groups of two to four walk side by side, slower than alone.

    Each aims at a place in a row at right angles to their way, about the middle of those members
    who are near and in view and go to the same place. Those in the middle walk a little behind, so
    that threes form a V and fours a U. Members who are held up, or have a wall in their way, walk
    as if alone. The group is slower than its slowest member by ``slower`` for each further one.
    Larger groups walk as without this behaviour.

    Moussaid, Perozo, Garnier, Helbing and Theraulaz (2010, PLoS ONE 5: e10047) found groups of N
    to walk at 1.26 - 0.04 N m/s where there is room, and to bend into a V or a U.

    Args:
        distance: metres between two members side by side.
        behind: metres by which those in the middle walk behind the outer ones.
        slower: m/s for each member besides the first.

    Raises:
        ModelError: a number out of range.
    """

    name = "walking_abreast"
    after = "speed_rules"

    _model: World

    def __init__(
        self,
        distance: Annotated[float, Range(0.0, unit="m", above=True)] = 0.75,
        behind: Annotated[float, Range(0.0, unit="m")] = 0.15,
        slower: Annotated[float, Range(0.0, unit="m/s")] = 0.04,
    ) -> None:
        self.distance, self.behind, self.slower = distance, behind, slower

    def bind(self, model: World) -> None:
        """Keep the model, whose people's velocities count."""
        self._model = model

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Turn members of small groups towards their places, and let them walk in step."""
        inside = deciding.inside
        at = inside.places(deciding.pedestrians)
        others = _companions(inside.groups, inside.destinations, inside.distances, at)
        crowd, rows = self._model.crowd, inside.pedestrians
        velocities = np.column_stack([crowd.vx[rows], crowd.vy[rows]])
        walks = np.hypot(*velocities[at].T) >= _WALKS
        who = np.flatnonzero((others >= 0).any(axis=1) & walks)
        if desired.newcomers or not len(who):
            return
        others, here = others[who], deciding.positions[who]
        ahead = desired.points[who] - here
        away = np.hypot(*ahead.T)
        ex, ey = (ahead / np.maximum(away, 1e-9)[:, None]).T

        # Where the others will soon be, seen from oneself: along the way, and to its left.
        looks = deciding.pedestrians[who].repeat(others.shape[1])
        there = inside.seen_by(looks, rows[others.ravel()]).reshape(*others.shape, 2)
        there -= here[:, None]
        near = (others >= 0) & (np.hypot(there[..., 0], there[..., 1]) <= _NEAR)
        i, j = np.nonzero(near)
        near[i, j] = lines_of_sight(deciding.site.plan, here[i], here[i] + there[i, j])
        soon = there + _SOON * (velocities[others] - velocities[at[who]][:, None])
        along = np.where(near, soon[..., 0] * ex[:, None] + soon[..., 1] * ey[:, None], 0.0)
        left = np.where(near, soon[..., 1] * ex[:, None] - soon[..., 0] * ey[:, None], 0.0)

        # Places are given from right to left, as members walk now.
        size = 1 + near.sum(axis=1)
        earlier = (left < 0.0) | ((left == 0.0) & (others < at[who][:, None]))
        place = (near & earlier).sum(axis=1)
        inner = (place > 0) & (place < size - 1)
        back = self.behind * (np.maximum(size - 2, 0) / size - inner)
        forward = along.sum(axis=1) / size + back
        aside = left.sum(axis=1) / size + (place - (size - 1) / 2.0) * self.distance

        pace = desired.speeds[who]
        slowest = np.where(near, inside.preferred_speeds[others], np.inf).min(axis=1)
        pace = np.where(size > 1, np.minimum(pace, slowest) - self.slower * (size - 1), pace)
        pace = np.maximum(pace, 0.1 * desired.speeds[who])
        speeds = np.clip(pace + forward / _CATCHES_UP, _LEAST * pace, _FASTEST * pace)
        desired.speeds = desired.speeds.copy()
        desired.speeds[who] = np.where(size > 1, speeds, desired.speeds[who])

        angle = np.clip(np.arctan2(aside, _WITHIN), -_TURN, _TURN)
        c, s = np.cos(angle), np.sin(angle)
        turned = np.column_stack([c * ex - s * ey, s * ex + c * ey])
        step = np.minimum(away, _WITHIN)[:, None]
        clear = lines_of_sight(deciding.site.plan, here, here + step * turned)
        aims = (size > 1) & clear & (away > _WITHIN)
        desired.points = desired.points.copy()
        desired.points[who[aims]] = (here + away[:, None] * turned)[aims]


def _companions(
    groups: NDArray[np.int64],
    destinations: NDArray[np.int32],
    to_go: NDArray[np.float64],
    at: NDArray[np.int64],
) -> NDArray[np.int64]:
    """(n, 3) indices of the others in the groups of those ``at`` some indices, -1 for none.

    Args:
        groups: (m,) number of each one's group, 0 for none.
        destinations: (m,) where each goes; a group has a part for each destination.
        to_go: (m,) metres; inf for those without a route.
        at: (n,) indices of those who are asked for.
    """
    found = np.full((len(at), _MOST - 1), -1)
    members = np.flatnonzero((groups > 0) & np.isfinite(to_go))
    if not len(members):
        return found
    both = np.column_stack([groups, destinations])[members]
    _, part, counts = np.unique(both, axis=0, return_inverse=True, return_counts=True)
    part = part.reshape(-1)
    rows = np.full((len(counts), _MOST), -1)
    order = np.argsort(part, kind="stable")
    number = np.arange(len(members)) - np.repeat(np.cumsum(counts) - counts, counts)
    small = counts[part[order]] <= _MOST
    rows[part[order][small], number[small]] = members[order][small]

    part_of = np.full(len(groups), -1)
    part_of[members] = part
    own = part_of[at]
    together = np.where((own >= 0)[:, None], rows[own], -1)
    together[together == at[:, None]] = -1
    # Of the places for all members one is empty: one's own.
    together = -np.sort(-together, axis=1)[:, : _MOST - 1]
    found[:] = together
    return found
