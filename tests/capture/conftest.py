from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

from mesa_mobility.capture import Recording, Skeleton

SIDE_CHANNELS = "CHANNELS 3 Zrotation Yrotation Xrotation"


def _leg(side: str, x: float) -> str:
    joints = [
        (f"{side}UpLeg", f"{x} 0 0"),
        (f"{side}Leg", "0 -45 0"),
        (f"{side}Foot", "0 -40 0"),
        (f"{side}ToeBase", "0 -8 12"),
    ]
    opening = "".join(
        f"JOINT {name}\n{{\nOFFSET {offset}\n{SIDE_CHANNELS}\n" for name, offset in joints
    )
    return opening + "End Site\n{\nOFFSET 0 0 5\n}\n" + "}\n" * len(joints)


@pytest.fixture(scope="session")
def walker_bvh() -> Callable[..., str]:
    """Text of a BVH in centimetres: hips and two legs, thigh 45 and shank 40 long.

    The root moves 1 cm along the file's Z, the world's x, in each frame.
    """

    def text(frames: int = 50, frame_time: str = "0.0333333") -> str:
        rows = "".join(f"0 90 {k} {'0 ' * 27}\n" for k in range(frames))
        return (
            "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\n"
            "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n"
            f"{_leg('Left', 9)}{_leg('Right', -9)}}}\n"
            f"MOTION\nFrames: {frames}\nFrame Time: {frame_time}\n{rows}"
        )

    return text


@pytest.fixture
def still() -> Callable[..., Recording]:
    """A recording from joint names, parents, offsets and (F, J, 4) rotations."""

    def make(
        names: Sequence[str],
        parents: Sequence[int],
        offsets: Sequence[Sequence[float]],
        rotations: Sequence[Sequence[Sequence[float]]] | None = None,
        root_position: Sequence[Sequence[float]] | None = None,
        frame_rate: float = 30.0,
    ) -> Recording:
        if rotations is None:
            frames = 1 if root_position is None else len(root_position)
            rotations = np.tile([0.0, 0.0, 0.0, 1.0], (frames, len(names), 1))
        if root_position is None:
            root_position = np.zeros((len(rotations), 3))
        return Recording(
            "still", Skeleton(names, parents, offsets), frame_rate, root_position, rotations
        )

    return make


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str, str | bytes], Path]:
    """Write a file and give its path."""

    def put(name: str, content: str | bytes) -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return put
