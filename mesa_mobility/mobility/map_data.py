"""The clustered mobility map: the movements possible from each pose.

For each cluster of poses the map holds the movement options that any pose of
the cluster has: where a person could be after 12, 24 or 45 frames, facing
which way, in a pose of which cluster, and the path there (sections 4 and 5 of
the paper).  One map serves all pedestrians of a type.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility._numbers import is_number
from mesa_mobility.errors import MapError
from mesa_mobility.human_limits import FASTEST_SPRINT, SLIMMEST_CORE

SAMPLE_SECONDS = 0.1
"""Time between two samples of a stored path: three frames at 30 Hz."""

CORE_RADIUS = 0.14
"""Radius in metres of the disc that no other body enters, where a map does not say.

In real queues the closest twentieth of neighbours stand 0.27 to 0.30 m apart: half of that.
"""

_BLOCK = 1024
"""Options whose speeds are checked at once: their steps stay in the processor's cache."""


@dataclass(frozen=True, eq=False)
class MapData:
    """The arrays and metadata of a mobility map; see `MobilityMap`."""

    offsets: NDArray[np.int64]
    durations: NDArray[np.int16]
    costs: NDArray[np.float32]
    path_offsets: NDArray[np.int64]
    paths: NDArray[np.float32]
    path_clusters: NDArray[np.uint16]
    mean_poses: NDArray[np.float32]
    centres: NDArray[np.float32]
    sizes: NDArray[np.int64]
    mean_speeds: NDArray[np.float32]
    metadata: Mapping[str, Any] = field(repr=False)

    standing: int = field(default=0, init=False)
    """Number of the standing cluster."""

    file: Path | None = field(default=None, init=False, repr=False, compare=False)
    """The file that it was read from, if any."""

    origin: str | None = field(default=None, init=False, repr=False, compare=False)
    """The digest of all files that it follows from, None for a map that was made in memory."""

    lengths: float = field(default=1.0, init=False, repr=False, compare=False)
    """Factor by which its movements are longer than those of the map with its digest."""

    def __post_init__(self) -> None:
        check_map(self)
        for name, array in vars(self).items():
            if isinstance(array, np.ndarray):  # maps are shared between models
                view = array.view()
                view.setflags(write=False)
                object.__setattr__(self, name, view)

    def __deepcopy__(self, memo: dict[int, Any]) -> MapData:
        """The map itself, since it is immutable."""
        return self

    @property
    def n_clusters(self) -> int:
        """Number of clusters."""
        return len(self.sizes)

    @property
    def n_options(self) -> int:
        """Number of options."""
        return len(self.durations)

    @property
    def pedestrian_type(self) -> str:
        """Name of the pedestrian type that was recorded."""
        return str(self.metadata["pedestrian_type"])

    @property
    def on_wheels(self) -> bool:
        """Whether its options are motion primitives of wheels, which do not slip to the side."""
        return "turn_rates" in self.metadata.get("build", {})

    @property
    def end_points(self) -> NDArray[np.float32]:
        """(m, 2) mobility points: where each option ends."""
        return self.paths[self.path_offsets[1:] - 1, :2]

    @property
    def end_headings(self) -> NDArray[np.float32]:
        """(m,) facing at the mobility point, relative to the start, not wrapped."""
        return self.paths[self.path_offsets[1:] - 1, 2]

    @property
    def end_clusters(self) -> NDArray[np.uint16]:
        """(m,) cluster of the pose in which each option ends."""
        return self.path_clusters[self.path_offsets[1:] - 1]

    @cached_property
    def digest(self) -> str:
        """SHA-256, in hexadecimal, of the options: their clusters, lengths and paths."""
        digest = hashlib.sha256()
        for array in (self.offsets, self.durations, self.path_clusters, self.paths):
            # A map that has just been built may have zeros with a sign; files have none.
            digest.update(np.ascontiguousarray(array + array.dtype.type(0)).tobytes())
        return digest.hexdigest()

    def options_of(self, cluster: int) -> range:
        """Rows of the options of a cluster."""
        return range(int(self.offsets[cluster]), int(self.offsets[cluster + 1]))

    def info(self) -> dict[str, Any]:
        """Figures and provenance, ready for JSON."""
        per_cluster = np.diff(self.offsets)
        frames, counts = np.unique(self.durations, return_counts=True)
        return {
            "clusters": self.n_clusters,
            "options": self.n_options,
            "options_by_frames": {str(f): int(c) for f, c in zip(frames, counts, strict=True)},
            "options_per_cluster": {
                "min": int(per_cluster.min()),
                "median": float(np.median(per_cluster)),
                "max": int(per_cluster.max()),
            },
            "poses_per_cluster": {
                "min": int(self.sizes.min()),
                "median": float(np.median(self.sizes)),
                "max": int(self.sizes.max()),
            },
            **self.metadata,
        }

    def __repr__(self) -> str:
        has = f"{self.n_clusters} clusters, {self.n_options} options"
        return f"<{type(self).__name__} {self.pedestrian_type!r}: {has}>"


def check_map(map_: MapData) -> None:
    """Check that the arrays of a map fit together.

    Raises:
        MapError: naming the array, what it holds and what was expected.
    """
    for name in ("sizes", "durations", "paths"):
        if getattr(map_, name).ndim != (2 if name == "paths" else 1):
            shape = getattr(map_, name).shape
            raise MapError(f"mobility map array {name!r}: shape {shape}, expected a row an entry")
    k, m, p = map_.n_clusters, map_.n_options, len(map_.paths)
    if k < 1 or m < 1:
        raise MapError(
            f"mobility map with {k} clusters and {m} options: expected at least one each"
        )
    shapes = {
        "offsets": (k + 1,),
        "costs": (m,),
        "path_offsets": (m + 1,),
        "paths": (p, 3),
        "path_clusters": (p,),
        "mean_poses": (k, 9, 3),
        "centres": (k, 36),
        "mean_speeds": (k,),
        "sizes": (k,),
    }
    for name, shape in shapes.items():
        found = getattr(map_, name).shape
        if found != shape:
            raise MapError(f"mobility map array {name!r}: shape {found}, expected {shape}")
    for name in ("costs", "paths", "mean_poses", "centres", "mean_speeds"):
        if not np.isfinite(getattr(map_, name)).all():
            raise MapError(f"mobility map array {name!r}: not finite, expected finite numbers")
    _check_offsets("offsets", map_.offsets, m)
    _check_offsets("path_offsets", map_.path_offsets, p)
    if (map_.mean_speeds < 0.0).any() or (map_.costs < 0.0).any():
        raise MapError("mobility map: negative costs or mean speeds, expected 0 or more")
    if (map_.sizes < 1).any():
        raise MapError(
            f"mobility map cluster {int(np.argmin(map_.sizes))}: no poses, expected some"
        )
    if map_.path_clusters.size and int(map_.path_clusters.max()) >= k:
        raise MapError(
            f"mobility map array 'path_clusters': {int(map_.path_clusters.max())}, "
            f"expected less than {k}"
        )
    samples = np.diff(map_.path_offsets)
    if (map_.durations < 1).any() or (samples * 3 != map_.durations).any():
        row = int(np.argmax((samples * 3 != map_.durations) | (map_.durations < 1)))
        raise MapError(
            f"mobility map option {row}: {int(samples[row])} samples for "
            f"{int(map_.durations[row])} frames, expected one each 3 frames"
        )
    _check_speeds(map_)
    _check_metadata(map_.metadata)


def _check_speeds(map_: MapData) -> None:
    # Without this limit a damaged file makes the search and its grids reach for kilometres.
    for first in range(0, map_.n_options, _BLOCK):
        offsets = map_.path_offsets[first : first + _BLOCK + 1]
        paths = map_.paths[offsets[0] : offsets[-1]]
        starts = offsets[:-1] - offsets[0]
        with np.errstate(over="ignore"):
            steps = paths.copy()
            steps[1:] -= paths[:-1]
            steps[starts] = paths[starts]
            squares = steps[:, 0] ** 2 + steps[:, 1] ** 2
        fastest = int(np.argmax(squares))
        speed = math.hypot(*steps[fastest, :2]) / SAMPLE_SECONDS
        # Rounding to the steps of the file may add a little.
        if speed > FASTEST_SPRINT + 0.01:
            row = first + int(np.searchsorted(starts, fastest, side="right")) - 1
            raise MapError(
                f"mobility map option {row}: moves at {speed:.1f} m/s, "
                f"expected at most {FASTEST_SPRINT:g}"
            )


def _check_metadata(metadata: Mapping[str, Any]) -> None:
    if not isinstance(metadata.get("pedestrian_type"), str):
        raise MapError("mobility map metadata: no 'pedestrian_type', expected a name")
    if not isinstance(metadata.get("build", {}), Mapping):
        raise MapError("mobility map metadata: 'build' has no members, expected some by name")
    rate = metadata.get("frame_rate_hz", 30.0)
    if rate != 30.0:
        raise MapError(f"mobility map metadata: 'frame_rate_hz' is {rate!r}, expected 30")
    body = metadata.get("body", {})
    radius = body.get("core_radius_m", CORE_RADIUS) if isinstance(body, Mapping) else None
    if not (is_number(radius) and SLIMMEST_CORE <= radius < 1.0):
        raise MapError(
            "mobility map metadata: expected 'body' with a 'core_radius_m' of "
            f"{SLIMMEST_CORE} to 1 m"
        )


def _check_offsets(name: str, offsets: NDArray[np.int64], total: int) -> None:
    if offsets[0] != 0 or offsets[-1] != total or (np.diff(offsets) < 1).any():
        raise MapError(f"mobility map array {name!r}: expected to rise strictly from 0 to {total}")
