"""The mobility map, read from its file and written to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from mesa_mobility._numbers import is_number
from mesa_mobility._once import cached_once
from mesa_mobility.errors import MapError
from mesa_mobility.files.read_once import read_once
from mesa_mobility.mobility.kept_map import read_kept_map
from mesa_mobility.mobility.map_data import MapData
from mesa_mobility.mobility.mapfile import shipped_map_path, write_map

LENDER = "able_bodied"
"""The map that ships of which others borrow what they lack."""

LEAST_TREAD, MOST_TREAD = 0.1, 1.0
"""Metres."""


@dataclass(frozen=True, eq=False, repr=False)
class MobilityMap(MapData):
    """Movement options of all clusters of one pedestrian type.

    Everything is relative to the person at the start of the option: x forwards,
    y to the left, heading counter-clockwise; metres and radians.  Row counts:
    k clusters, m options, p path samples.

    Attributes:
        offsets: (k + 1,) int64; options of cluster c are ``offsets[c]:offsets[c + 1]``.
        durations: (m,) int16; frames at 30 Hz.
        costs: (m,) float32; cost of the option's path in the motion graph.
        path_offsets: (m + 1,) int64; samples of option i are
            ``path_offsets[i]:path_offsets[i + 1]``, one each 3 frames, start left out.
        paths: (p, 3) float32; x, y, heading.
        path_clusters: (p,) uint16; cluster of the pose at each sample.
        mean_poses: (k, 9, 3) float32; mean joint positions (``mobility.poses.POSE_JOINTS``).
        centres: (k, 36) float32; pose features of the cluster centres.
        sizes: (k,) int64; poses behind each cluster.
        mean_speeds: (k,) float32; mean root speed of these poses, m/s.
        metadata: type, body, build parameters and the provenance of every clip.

    Examples:
        >>> from mesa_mobility import MobilityMap
        >>> able_bodied = MobilityMap.load()
        >>> able_bodied.n_clusters, able_bodied.n_options
        (157, 316175)
        >>> first, after = able_bodied.offsets[able_bodied.standing :][:2]
        >>> sorted(set(able_bodied.durations[first:after].tolist()))
        [12, 24, 45]
    """

    def save(self, path: str | Path) -> None:
        """Write the map file; see ``mobility.mapfile``."""
        write_map(self, path)

    @classmethod
    def load(cls, path: str | Path | None = None) -> MobilityMap:
        """Read a map file; without a path, the able-bodied map that ships.

        Raises:
            MapError: the file is missing, damaged, of another version or inconsistent.
        """
        path = Path(shipped_map_path(LENDER) if path is None else path)
        found = read_once(path, cls._read)
        object.__setattr__(found, "file", path)
        return found

    @classmethod
    def _read(cls, path: Path) -> MobilityMap:
        return read_kept_map(path, cls, lender=shipped_map_path(LENDER), lend=cls.load)

    @classmethod
    def named(cls, name: str) -> MobilityMap:
        """A map that ships with the package.

        Raises:
            MapError: there is no such map.
        """
        return cls.load(shipped_map_path(name))

    def for_treads(self, tread: float) -> MobilityMap:
        """A map of people on stairs for treads of this depth: strides are as long as a tread.

        Movements take the same time. A map that does not say for which treads it is stays as it is.

        Args:
            tread: metres.

        Raises:
            MapError: the metadata have something else than the depth of a tread.
        """
        derived = self.metadata.get("derived", {})
        own = derived.get("tread_m", tread) if isinstance(derived, Mapping) else tread
        if not (is_number(own) and LEAST_TREAD <= own <= MOST_TREAD):
            raise MapError(
                f"mobility map of {self.pedestrian_type!r}: metadata 'tread_m' is {own!r:.40}, "
                f"expected {LEAST_TREAD:g} to {MOST_TREAD:g} m"
            )
        return _lengthened(self, round(tread / own, 4))


@cached_once(maxsize=16)
def _lengthened(map_: MobilityMap, lengths: float) -> MobilityMap:
    """A map whose movements are longer by a factor, in the same time; itself for a factor of 1."""
    if lengths == 1.0:
        return map_
    factor = np.float32(lengths)
    made = replace(
        map_,
        paths=map_.paths * np.array([factor, factor, 1.0], dtype=np.float32),
        mean_speeds=map_.mean_speeds * factor,
    )
    origin = None if map_.origin is None else f"{map_.origin} x {lengths:g}"
    for name, value in (("file", map_.file), ("origin", origin), ("lengths", lengths)):
        object.__setattr__(made, name, value)
    # Its options are those of the map with this digest, and so are their poses.
    vars(made)["digest"] = map_.digest
    return made
