"""Skeletons: named joints, their parents and their offsets."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.errors import CaptureError

END = ".end"
"""Suffix of the joint at the free end of a leaf, which files leave without a name."""

MOST_JOINTS = 500
"""Joints of a skeleton; those with fingers and face have some two hundred."""


def check_joints(count: int, where: str) -> None:
    """Refuse more than :data:`MOST_JOINTS` joints.

    Raises:
        CaptureError: as said.
    """
    if count > MOST_JOINTS:
        raise CaptureError(f"{where}: more than {MOST_JOINTS} joints, expected a body")


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A tree of joints.

    Joint ``j`` sits at ``position[parents[j]] + R[parents[j]] @ offsets[j]``, where ``R`` is the
    parent's rotation accumulated from the root.

    Attributes:
        names: (J,) names of the joints, no two alike.
        parents: (J,) int64; index of each joint's parent, which comes before the joint; -1 for
            the root, which is joint 0.
        offsets: (J, 3) float64; metres, in the file's own axes.  The root's is not used.

    Raises:
        CaptureError: the arrays disagree in shape, a name occurs twice, a parent comes after
            its child, or an offset is not finite.
    """

    names: tuple[str, ...]
    parents: NDArray[np.int64]
    offsets: NDArray[np.float64]

    def __post_init__(self) -> None:
        object.__setattr__(self, "names", tuple(self.names))
        object.__setattr__(self, "parents", read_only(self.parents, np.int64))
        object.__setattr__(self, "offsets", read_only(self.offsets, np.float64))
        self._check()

    def _check(self) -> None:
        count = len(self.names)
        if count == 0:
            raise CaptureError("skeleton without joints: expected at least a root")
        if self.parents.shape != (count,) or self.offsets.shape != (count, 3):
            raise CaptureError(
                f"skeleton of {count} joints: parents have shape {self.parents.shape} and offsets "
                f"{self.offsets.shape}, expected ({count},) and ({count}, 3)"
            )
        seen: set[str] = set()
        for name in self.names:
            if name in seen:
                raise CaptureError(f"joint {name!r} occurs twice: expected distinct names")
            seen.add(name)
        if self.parents[0] != -1:
            raise CaptureError(f"joint {self.names[0]!r} comes first: expected the root, parent -1")
        for j in range(1, count):
            if not 0 <= self.parents[j] < j:
                raise CaptureError(
                    f"joint {self.names[j]!r} has parent {self.parents[j]}: expected the index of "
                    f"a joint before it (0 to {j - 1})"
                )
        if not np.isfinite(self.offsets).all():
            j = int(np.flatnonzero(~np.isfinite(self.offsets).all(axis=1))[0])
            raise CaptureError(f"joint {self.names[j]!r} has an offset that is not finite")

    def __len__(self) -> int:
        return len(self.names)

    def index(self, name: str) -> int:
        """Index of a joint.

        Raises:
            CaptureError: no joint has this name.
        """
        try:
            return self.names.index(name)
        except ValueError:
            raise CaptureError(
                f"no joint {name!r}: the skeleton has {', '.join(self.names)}"
            ) from None


def read_only(values: ArrayLike, dtype: type[np.generic]) -> NDArray:
    """A view of an array that refuses to be written to; the caller's own array stays writable."""
    view = np.asarray(values, dtype=dtype).view()
    view.flags.writeable = False
    return view
