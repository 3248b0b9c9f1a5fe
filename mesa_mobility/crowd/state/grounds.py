"""Grounds: level floors, and stairs up and down, on each of which people walk by another map."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.crowd.options.capability import ALIKE
from mesa_mobility.crowd.options.repertoire import Repertoire, within_maps
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.types.pedestrian_type import PedestrianType
from mesa_mobility.floorplan import SpeedZone
from mesa_mobility.mobility import MobilityMap

LEVEL = 0
"""Number of the ground without stairs."""

_TREAD_DIGITS = 2
"""Treads count as equally deep if they are so to the centimetre."""

_NO_WAY = 1e-6
"""Metres to a target that is where the person is."""


class GroundMaps:
    """The maps of all types on all grounds of a floor plan.

    Stairs are the speed zones with treads and a direction. Grounds are the level floor, then up and
    down stairs, in the order of the depths of their treads.

    Args:
        zones: those of the floor plan.
        types: the pedestrian types.

    Attributes:
        stairs: (zone, number of the ground up, of the ground down) of each part of stairs.
        maps: those of the types, then those for stairs alone.
        used: (grounds, types) number in ``maps`` of the map by which people walk.
        first_rows: (types, maps) number of the first option of each map among those of all maps of
            a type, its own first; -1 for maps of others.

    Raises:
        MapError: a map of stairs that does not say for which treads it is.
    """

    def __init__(self, zones: Sequence[SpeedZone], types: Sequence[PedestrianType]) -> None:
        stairs = [each for each in zones if each.is_stair]
        treads = sorted({round(each.tread, _TREAD_DIGITS) for each in stairs})
        first = {tread: 1 + 2 * k for k, tread in enumerate(treads)}
        self.stairs = []
        for zone in stairs:
            up = first[round(zone.tread, _TREAD_DIGITS)]
            self.stairs.append((zone, up, up + 1))
        maps = [each.mobility_map for each in types]
        numbers: dict[tuple[str, float], int] = {}
        used = [list(range(len(types)))]
        for tread in treads:
            for up in (True, False):
                own = []
                for number, kind in enumerate(types):
                    map_ = kind.on_stairs(tread, up=up)
                    if map_ is kind.mobility_map:
                        own.append(number)
                        continue
                    # Types may have read the same map at different times.
                    key = map_.digest, map_.lengths
                    if numbers.setdefault(key, len(maps)) == len(maps):
                        maps.append(map_)
                    own.append(numbers[key])
                used.append(own)
        self.maps: tuple[MobilityMap, ...] = tuple(maps)
        self.used = np.array(used, dtype=np.int64)
        self.first_rows = np.full((len(types), len(maps)), -1, dtype=np.int64)
        for column in range(len(types)):
            row = 0
            for number in self.of_type(column):
                self.first_rows[column, number] = row
                row += maps[number].n_options

    def of_type(self, number: int) -> list[int]:
        """Numbers of the maps by which people of a type walk, their own first."""
        return list(dict.fromkeys(self.used[:, number].tolist()))

    def longest(self, of_maps: NDArray[np.float64]) -> NDArray[np.float64]:
        """(types,) the greatest of (maps,) values over the maps of each type."""
        greatest: NDArray[np.float64] = of_maps[self.used].max(axis=0)
        return greatest


class Grounds:
    """Changes the maps of people who come to another ground.

    Args:
        known: the maps.
        repertoire: the options of ``known.maps``.
        ahead_s: seconds ahead of people at which the ground counts.
    """

    def __init__(self, known: GroundMaps, repertoire: Repertoire, ahead_s: float) -> None:
        self.known, self._ahead_s = known, ahead_s
        self._first_cluster = repertoire.first_cluster
        self._nearest: NDArray[np.int32] | None = None
        if known.stairs:
            self._nearest = nearest_clusters(repertoire)

    def __deepcopy__(self, memo: dict[int, Any]) -> Grounds:
        """Itself, since it never changes."""
        return self

    def change(self, rows: NDArray[np.int64], crowd: Crowd) -> None:
        """Let people walk by the maps of the ground to which they come.

        This is where their velocity leads them within ``ahead_s``. They go on from the pose that
        is most like theirs.

        Args:
            rows: (n,) people who decide, with their targets.
            crowd: the crowd.
        """
        if self._nearest is None:
            return
        wanted = self.known.used[self._ground(rows, crowd), crowd.type_index[rows]]
        clusters = crowd.cluster[rows]
        changed = within_maps(clusters, self._first_cluster)[0] != wanted
        crowd.cluster[rows[changed]] = self._nearest[wanted[changed], clusters[changed]]

    def _ground(self, rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.int64]:
        """(n,) number of the ground of each of the people in ``rows``."""
        x = crowd.x[rows] + self._ahead_s * crowd.vx[rows]
        y = crowd.y[rows] + self._ahead_s * crowd.vy[rows]
        ways = np.column_stack(
            [crowd.target_x[rows] - crowd.x[rows], crowd.target_y[rows] - crowd.y[rows]]
        )
        nowhere = np.hypot(*ways.T) < _NO_WAY
        headings = crowd.heading[rows[nowhere]]
        ways[nowhere] = np.column_stack([np.cos(headings), np.sin(headings)])
        found = np.full(len(rows), LEVEL, dtype=np.int64)
        for zone, up, down in self.known.stairs:
            there = shapely.intersects_xy(zone.area, x, y)
            if there.any():
                climbs = ways[there] @ np.asarray(zone.downhill) < 0.0
                found[there] = np.where(climbs, up, down)
        return found


def nearest_clusters(repertoire: Repertoire) -> NDArray[np.int32]:
    """For each map, the cluster that is most like each cluster of all maps.

    Movements from it begin with nearly the same velocity, and of those clusters its pose is the
    nearest. People who stand go on standing.

    Returns:
        (maps, clusters) numbers of clusters.
    """
    known = repertoire.capabilities
    velocities = np.concatenate([each.first_velocities[0] for each in known])
    poses = np.concatenate([each.map.centres for each in known])
    ends = np.append(repertoire.first_cluster, len(velocities)).tolist()
    found = np.empty((len(known), len(velocities)), dtype=np.int32)
    for number, (first, last) in enumerate(pairwise(ends)):
        mean, spread = known[number].first_velocities
        off = np.hypot(np.linalg.norm(velocities[:, None] - mean[None], axis=2), spread[None])
        apart = np.linalg.norm(poses[:, None] - poses[None, first:last], axis=2)
        apart[off > off.min(axis=1)[:, None] + ALIKE] = np.inf
        found[number] = first + np.argmin(apart, axis=1)
        found[number, repertoire.standing] = repertoire.standing[number]
    return found
