"""One pose bank of several: people move by several maps, as on level floors and on stairs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mesa_mobility._once import cached_once
from mesa_mobility.bodies.bank import PoseBank


def bank_of_maps(maps: Sequence[tuple[str, float]], given: PoseBank | None = None) -> PoseBank:
    """The poses behind the options of several maps, which are numbered one map after the other.

    Args:
        maps: digest of each map, and the factor of its lengths; first that of the person's type.
        given: poses of the first map; by default those that ship.

    Raises:
        MapError: poses given are of another map, or none ship of one of the maps.
    """
    (digest, _), *others = maps
    own = PoseBank.of(digest) if given is None else given
    own.check_map(digest)
    return _joined(own, tuple((PoseBank.of(each), lengths) for each, lengths in others))


@cached_once(maxsize=16)
def _joined(own: PoseBank, others: tuple[tuple[PoseBank, float], ...]) -> PoseBank:
    """A bank of bodies as large as in the first one, with the poses of the others behind its own.

    Smaller bodies take the same strides: they are longer for them.
    """
    if not others:
        return own
    banks = [own, *(bank for bank, _ in others)]
    factors = [1.0, *(lengths * bank.scale / own.scale for bank, lengths in others)]
    poses = np.cumsum([0, *(len(each.rotations) for each in banks)]).tolist()
    stretches = np.cumsum([0, *(len(each.frames) for each in banks)]).tolist()
    strides = [
        np.clip(np.rint(each.strides * factor), 0, 255).astype(np.uint8)
        for each, factor in zip(banks, factors, strict=True)
    ]

    def after(name: str, firsts: list[int], skipped: int = 0) -> np.ndarray:
        arrays = [getattr(each, name) for each in banks]
        moved = [arrays[0], *(each[skipped:] for each in arrays[1:])]
        return np.concatenate(
            [
                (each + each.dtype.type(first)).astype(each.dtype)
                for each, first in zip(moved, firsts, strict=False)
            ]
        )

    numbers = [2 * each for each in poses]
    return PoseBank(
        rotations=np.concatenate([each.rotations for each in banks]),
        heights=np.concatenate([each.heights for each in banks]),
        contacts=np.concatenate([each.contacts for each in banks]),
        clips=after("clips", poses, 1),
        offsets=after("offsets", stretches, 1),
        frames=np.concatenate([each.frames for each in banks]),
        poses=after("poses", numbers),
        strides=np.concatenate(strides),
        cluster_poses=after("cluster_poses", numbers),
        metadata={
            **own.metadata,
            "clips": [clip for each in banks for clip in each.metadata["clips"]],
        },
    )
