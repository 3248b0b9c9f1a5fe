"""The pose bank: the full-body poses behind the options of a mobility map."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.bodies.rotations import matrices
from mesa_mobility.bodies.skeleton import COUNTERPARTS, TURN_OF, TURNING
from mesa_mobility.errors import MapError
from mesa_mobility.schema import Real, Text, Whole, check

QUATERNION_STEP = 1.0 / 32767
"""Quaternions are stored as 16-bit integers: to 0.004 degrees."""

HEIGHT_STEP = 0.0001
"""Heights are stored in tenths of a millimetre."""

STRIDE_STEP = 0.01

_PIECE = 1 << 14

_MIRROR = np.array([-1.0, 1.0, -1.0, 1.0])
"""A rotation seen in a mirror along y, as factors of its quaternion."""

OTHER_SIDE = np.array([TURN_OF[int(COUNTERPARTS[j])] for j in TURNING])
"""(17,) place among ``TURNING`` of each joint's counterpart."""


@dataclass(frozen=True, eq=False)
class BankData:
    """What a pose bank holds; see `PoseBank`."""

    rotations: NDArray[np.int16]
    heights: NDArray[np.int16]
    contacts: NDArray[np.uint8]
    clips: NDArray[np.int64]
    offsets: NDArray[np.int64]
    frames: NDArray[np.int16]
    poses: NDArray[np.int32]
    strides: NDArray[np.uint8]
    cluster_poses: NDArray[np.int32]
    metadata: Mapping[str, Any] = field(repr=False)

    def __post_init__(self) -> None:
        check_bank(self)
        for name, array in vars(self).items():
            if isinstance(array, np.ndarray):
                view = array.view()
                view.setflags(write=False)
                object.__setattr__(self, name, view)

    def __deepcopy__(self, memo: dict[int, Any]) -> BankData:
        """The bank itself, since it is immutable."""
        return self

    @property
    def n_options(self) -> int:
        """Number of options of the map."""
        return len(self.strides)

    @property
    def pedestrian_type(self) -> str:
        """Name of the pedestrian type."""
        return str(self.metadata["pedestrian_type"])

    @property
    def scale(self) -> float:
        """Size of the bodies, as a multiple of the neutral skeleton's."""
        return float(self.metadata.get("scale", 1.0))

    def check_map(self, digest: str) -> None:
        """Refuse poses of another map than that of this digest.

        Raises:
            MapError: as said.
        """
        own = self.metadata["map_digest"]
        if own != digest:
            raise MapError(f"poses of the map {own[:12]}, expected those of the map {digest[:12]}")

    @cached_property
    def last_of_clip(self) -> NDArray[np.int64]:
        """(p,) row of the last pose of each pose's clip."""
        return np.repeat(self.clips[1:] - 1, np.diff(self.clips))

    def later(self, numbers: NDArray[np.integer], by: NDArray[np.integer]) -> NDArray[np.int64]:
        """Numbers of the poses so many frames later, or of the last of the clip."""
        rows, mirrored = np.divmod(np.asarray(numbers, dtype=np.int64), 2)
        return 2 * np.clip(rows + by, 0, self.last_of_clip[rows]) + mirrored

    def turns(self, numbers: NDArray[np.integer]) -> NDArray[np.float64]:
        """(n, 17, 3, 3) turns of the joints in the poses of these numbers."""
        rows, mirrored = np.divmod(np.asarray(numbers, dtype=np.int64), 2)
        found = self.rotations[rows] * QUATERNION_STEP
        other = found[:, OTHER_SIDE] * _MIRROR
        return matrices(np.where((mirrored == 1)[:, None, None], other, found))

    def pelvis_heights(self, numbers: NDArray[np.integer]) -> NDArray[np.float64]:
        """(n,) heights of the pelvis in these poses, metres, before ``scale``."""
        return self.heights[np.asarray(numbers) // 2] * HEIGHT_STEP

    def bearing(self, numbers: NDArray[np.integer]) -> NDArray[np.bool_]:
        """(n, 4) whether left ankle and toe, right ankle and toe bear on the floor."""
        rows, mirrored = np.divmod(np.asarray(numbers, dtype=np.int64), 2)
        found = (self.contacts[rows, None] >> np.arange(4)) & 1 == 1
        return np.where((mirrored == 1)[:, None], found[:, [2, 3, 0, 1]], found)

    def source_of(self, number: int) -> tuple[str, int, bool]:
        """Clip of a pose, its frame at 30 Hz there, and whether it is mirrored."""
        row, mirrored = divmod(int(number), 2)
        clip = int(np.searchsorted(self.clips, row, side="right")) - 1
        name = self.metadata["clips"][clip]["clip"]
        return str(name), row - int(self.clips[clip]), bool(mirrored)


def check_bank(bank: BankData) -> None:
    """Check that the arrays of a bank fit together.

    Raises:
        MapError: naming the array and what was expected.
    """
    p, m, q = (np.atleast_1d(each).shape[0] for each in (bank.rotations, bank.strides, bank.frames))
    shapes = {
        "strides": (m,),
        "rotations": (p, len(TURNING), 4),
        "heights": (p,),
        "contacts": (p,),
        "offsets": (m + 1,),
        "frames": (q,),
        "poses": (q,),
    }
    for name, shape in shapes.items():
        if getattr(bank, name).shape != shape:
            raise MapError(
                f"pose bank array {name!r}: shape {getattr(bank, name).shape}, expected {shape}"
            )
    if p < 1 or m < 1 or bank.cluster_poses.ndim != 1 or len(bank.cluster_poses) < 1:
        raise MapError(f"pose bank of {p} poses and {m} options: expected at least one each")
    for name, total in (("clips", p), ("offsets", q)):
        each = getattr(bank, name)
        if each.ndim != 1 or each[0] != 0 or each[-1] != total or (np.diff(each) < 1).any():
            raise MapError(f"pose bank array {name!r}: expected rising numbers from 0 to {total}")
    for name in ("poses", "cluster_poses"):
        each = getattr(bank, name)
        if each.min() < 0 or each.max() >= 2 * p:
            raise MapError(f"pose bank array {name!r}: expected numbers of the {p} poses")
    if bank.frames[bank.offsets[:-1]].any() or (bank.frames < 0).any():
        raise MapError("pose bank array 'frames': expected each option to begin at frame 0")
    for start in range(0, p, _PIECE):  # in pieces: as floats they would take four times the memory
        quaternions = bank.rotations[start : start + _PIECE] * QUATERNION_STEP
        if np.abs(np.linalg.norm(quaternions, axis=2) - 1.0).max() > 1e-3:
            raise MapError("pose bank array 'rotations': expected quaternions of length 1")
    if not isinstance(bank.metadata.get("map_digest"), str):
        raise MapError("pose bank metadata: no 'map_digest' of the map that it belongs to")
    standing = bank.metadata.get("standing", 0)
    for name, value, kind in (
        ("standing", standing, Whole(below=len(bank.cluster_poses))),
        ("scale", bank.metadata.get("scale", 1.0), Real(0.1, 10.0)),
        ("pedestrian_type", bank.metadata.get("pedestrian_type"), Text()),
    ):
        check(value, kind, f"pose bank metadata, {name}", error=MapError)
    clips = bank.metadata.get("clips")
    if not isinstance(clips, list) or len(clips) != len(bank.clips) - 1:
        raise MapError(
            f"pose bank metadata: expected an entry for each of {len(bank.clips) - 1} clips"
        )
    if not all(isinstance(each, dict) and isinstance(each.get("clip"), str) for each in clips):
        raise MapError("pose bank metadata: expected the name of each clip as its 'clip'")
