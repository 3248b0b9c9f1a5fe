"""The pose bank, read from its file and written to it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from mesa_mobility.bodies.bank_data import BankData
from mesa_mobility.bodies.bankfile import read_bank, shipped_banks, write_bank
from mesa_mobility.errors import MapError
from mesa_mobility.files.read_once import read_once


@dataclass(frozen=True, eq=False, repr=False)
class PoseBank(BankData):
    """Poses of one pedestrian type, and the poses that each option goes through.

    A pose has a number: twice its row, and one more for its mirror image. Row counts: p poses,
    c clips, m options, q stretches of recordings, k clusters.

    Attributes:
        rotations: (p, 17, 4) int16; quaternions (x, y, z, w) of ``skeleton.TURNING``, in steps of
            ``QUATERNION_STEP``: turns against the parents, the pelvis's against where the person
            faces.
        heights: (p,) int16; of the pelvis above the floor, in steps of ``HEIGHT_STEP``.
        contacts: (p,) uint8; bits 0 to 3 are set where left ankle, left toe, right ankle and right
            toe bear on the floor.
        clips: (c + 1,) int64; poses of clip i are ``clips[i]:clips[i + 1]``.
        offsets: (m + 1,) int64; stretches of option i are ``offsets[i]:offsets[i + 1]``.
        frames: (q,) int16; frame of the option at which a stretch begins.
        poses: (q,) int32; number of the pose at which it begins; later ones of the clip follow.
        strides: (m,) uint8; factor of the strides of edited options, in hundredths.
        cluster_poses: (k,) int32; number of a typical pose of each cluster.
        metadata: the map's digest, the type, the neutral skeleton, the provenance of each clip.
    """

    def save(self, path: str | Path) -> None:
        """Write the bank's file; see ``bodies.bankfile``."""
        write_bank(self, path)

    @classmethod
    def load(cls, path: str | Path) -> PoseBank:
        """Read a bank's file.

        Raises:
            MapError: the file is missing, damaged, of another version or inconsistent.
        """
        return read_once(path, cls._read)

    @classmethod
    def _read(cls, path: Path) -> PoseBank:
        return read_bank(path, cls)

    @classmethod
    def of(cls, digest: str, path: str | Path | None = None) -> PoseBank:
        """The bank of the map with this digest: the file given, or the one that ships.

        Raises:
            MapError: the file is not of this map, or no bank of it ships.
        """
        if path is not None:
            bank = cls.load(path)
            bank.check_map(digest)
            return bank
        for each in shipped_banks():
            bank = cls.load(each)
            if bank.metadata["map_digest"] == digest:
                return bank
        raise MapError(
            f"no poses of the map {digest[:12]} ship with the package: expected a file of poses, "
            "which `mesa-mobility map poses` writes"
        )
