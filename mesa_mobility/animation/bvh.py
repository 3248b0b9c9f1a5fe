"""Motion of one person as a BVH file, the format of many of the recordings."""

from __future__ import annotations

import os
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mesa_mobility.animation.people import walkers
from mesa_mobility.bodies import BodyMotion
from mesa_mobility.bodies.motion import FRAME_RATE
from mesa_mobility.bodies.skeleton import JOINTS, OFFSETS, PARENTS, TURNING
from mesa_mobility.capture.motion import FILE_TO_WORLD
from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.results.formats.output_format import OutputFormat

if TYPE_CHECKING:
    from mesa_mobility.results.excerpts import Excerpt

UNITS_PER_METRE = 100.0
"""Files hold centimetres."""

_TURNS = "Zrotation Xrotation Yrotation"


class Bvh(OutputFormat):
    """Folder with one BVH file for each person, for tools of motion capture."""

    name = "bvh"
    suffixes = (".bvh",)
    storeys = True

    def write(self, excerpt: Excerpt, path: Path) -> None:
        """Write ``person_NUMBER.bvh`` for each person into a folder; see ``write_bvh``."""
        try:
            path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ResultsError(f"{path}: expected a folder for one file a person") from error
        people = walkers(excerpt.trajectories, excerpt.selection, excerpt.bank, excerpt.building)
        for done, walker in enumerate(people, start=1):
            write_bvh(walker.motion, path / f"person_{walker.person}.bvh")
            excerpt.person_done(done)


def write_bvh(motion: BodyMotion, path: str | os.PathLike[str]) -> None:
    """Write a body's motion as BVH: y up, facing z, centimetres, 30 frames a second.

    Args:
        motion: in successive frames.
        path: the file.

    Raises:
        ResultsError: the file cannot be written.
    """
    lines = ["HIERARCHY", *_joint(0, motion.scale, ""), "MOTION", f"Frames: {len(motion)}"]
    lines.append(f"Frame Time: {1.0 / FRAME_RATE:.7f}")
    turns = motion.local()
    in_file = np.einsum("ji,nkjl,lm->nkim", FILE_TO_WORLD, turns, FILE_TO_WORLD)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # a turn of 90 degrees has several solutions
        angles = Rotation.from_matrix(in_file.reshape(-1, 3, 3)).as_euler("ZXY", degrees=True)
    order = [int(np.flatnonzero(j == TURNING)[0]) for j in _depth_first(0) if j in TURNING]
    angles = angles.reshape(len(motion), len(TURNING), 3)[:, order].reshape(len(motion), -1)
    places = motion.positions[:, 0] @ FILE_TO_WORLD * UNITS_PER_METRE
    rows = np.hstack([places, angles])
    lines += [" ".join(f"{value:.4f}" for value in row) for row in rows.tolist()]
    with replacing(path, ResultsError) as temporary:
        temporary.write_text("\n".join(lines) + "\n", encoding="ascii")


def _children(joint: int) -> NDArray[np.int64]:
    return np.flatnonzero(joint == PARENTS)


def _depth_first(joint: int) -> list[int]:
    return [joint, *(each for child in _children(joint) for each in _depth_first(int(child)))]


def _joint(joint: int, scale: float, indent: str) -> list[str]:
    offset = OFFSETS[joint] @ FILE_TO_WORLD * scale * UNITS_PER_METRE
    place = "OFFSET " + " ".join(f"{value:.4f}" for value in offset.tolist())
    if joint not in TURNING:
        return [f"{indent}End Site", f"{indent}{{", f"{indent}  {place}", f"{indent}}}"]
    root = joint == 0
    channels = f"6 Xposition Yposition Zposition {_TURNS}" if root else f"3 {_TURNS}"
    inside = [
        line for child in _children(joint) for line in _joint(int(child), scale, indent + "  ")
    ]
    return [
        f"{indent}{'ROOT' if root else 'JOINT'} {JOINTS[joint]}",
        f"{indent}{{",
        f"{indent}  {place}",
        f"{indent}  CHANNELS {channels}",
        *inside,
        f"{indent}}}",
    ]
