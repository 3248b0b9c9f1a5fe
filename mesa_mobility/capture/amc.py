"""Reading AMC files: the motion of an ASF skeleton.

With ``C`` the rotation of a bone's own axes against the file's and ``M`` the rotation that the
frame gives about those axes, the bone turns by ``C M C^-1`` against its parent.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mesa_mobility.capture.asf import ROOT, AsfSkeleton, Bone, read_asf
from mesa_mobility.capture.motion import root_to_world, to_world
from mesa_mobility.capture.recording import Recording, check_size
from mesa_mobility.capture.text import quote, read_bytes, table, text_lines, whole_number
from mesa_mobility.errors import CaptureError

FRAME_RATE = 120.0
"""Frame rate of CMU's files, Hz; the format does not store one."""


def read_amc(
    path: str | Path,
    *,
    asf: str | Path | None = None,
    unit_to_m: float,
    frame_rate: float = FRAME_RATE,
) -> Recording:
    """Read a y-up AMC file.

    Args:
        path: the file.
        asf: the ASF file of the skeleton. By default it is looked for in the same folder: the
            subject's (``16.asf`` for ``16_11.amc``), the clip's, or the only one.
        unit_to_m: metres in one unit of the file.
        frame_rate: frames a second, which the format does not store.

    Returns:
        The recording in the z-up world.  Joints are named after the bones that start there.

    Raises:
        CaptureError: one of the files is missing, truncated, no AMC or ASF, or has numbers that
            are not finite; a frame lacks a bone, has one twice or with too few values.
    """
    path = Path(path)
    return parse_amc(read_bytes(path), path, asf=asf, unit_to_m=unit_to_m, frame_rate=frame_rate)


def parse_amc(
    data: bytes,
    path: Path,
    *,
    asf: str | Path | None = None,
    unit_to_m: float,
    frame_rate: float = FRAME_RATE,
) -> Recording:
    """Read the content of an AMC file; ``path`` gives the name and stands in errors."""
    rig = read_asf(find_asf(path) if asf is None else asf, unit_to_m=unit_to_m)
    motion, degrees = _read_motion(text_lines(data, path), rig, str(path))
    identity = np.tile([0.0, 0.0, 0.0, 1.0], (len(motion[ROOT]), 1))
    rotations = [
        _rotation(bone, motion[name], degrees) if bone.dof else identity
        for name, bone in rig.bones.items()
    ]
    rotations += [identity] * (len(rig.skeleton) - len(rotations))
    rotations[0] = root_to_world(rotations[0])
    position = np.zeros((len(identity), 3))
    for column, channel in enumerate(rig.bones[ROOT].dof):
        if channel.startswith("t"):
            position[:, "xyz".index(channel[1])] = motion[ROOT][:, column] * unit_to_m
    return Recording(
        path.stem, rig.skeleton, frame_rate, to_world(position), np.stack(rotations, axis=1)
    )


def find_asf(path: Path) -> Path:
    """The skeleton that belongs to an AMC file, by the rules of :func:`read_amc`.

    Raises:
        CaptureError: there is none, or several and none by name.
    """
    found = sorted(p for p in path.parent.iterdir() if p.suffix.lower() == ".asf")
    for name in (path.stem, path.stem.split("_")[0]):
        for candidate in found:
            if candidate.stem == name:
                return candidate
    if len(found) == 1:
        return found[0]
    seen = ", ".join(p.name for p in found) or "no .asf file"
    expected = f"{path.stem.split('_')[0]}.asf"
    raise CaptureError(f"{path}: AMC without its ASF, expected {expected} beside it, found {seen}")


def _rotation(bone: Bone, values: NDArray[np.float64], degrees: bool) -> NDArray[np.float64]:
    """(F, 4) rotation of a bone against its parent."""
    turns = [(i, channel[1]) for i, channel in enumerate(bone.dof) if channel.startswith("r")]
    if not turns:
        return np.tile([0.0, 0.0, 0.0, 1.0], (len(values), 1))
    # Lower-case letters: about fixed axes, in the order of the channels.
    order = "".join(axis for _, axis in turns)
    moved = Rotation.from_euler(order, values[:, [i for i, _ in turns]], degrees=degrees)
    return (bone.axis * moved * bone.axis.inv()).as_quat()


BoneRow = tuple[int, str]
"""Line number and the text behind the name of a bone."""


def _read_motion(
    lines: list[str], rig: AsfSkeleton, where: str
) -> tuple[dict[str, NDArray[np.float64]], bool]:
    """(F, channels) of every bone that has channels, and whether angles are in degrees."""
    degrees = rig.degrees
    widths = {name: len(bone.dof) for name, bone in rig.bones.items() if bone.dof}
    frames: list[dict[str, BoneRow]] = []
    number, begun = 0, 0
    for line, raw in enumerate(lines, start=1):
        words = raw.split()
        if not words or words[0].startswith("#"):
            continue
        if words[0].startswith(":"):
            if words[0].upper() in (":DEGREES", ":RADIANS"):
                degrees = words[0].upper() == ":DEGREES"
        elif len(words) == 1 and words[0].isdecimal():
            if frames:
                _require_all(frames[-1], widths, f"{where}, line {begun}")
                expected = number + 1
            number, begun = whole_number(words[0], f"{where}, line {line}"), line
            if frames and number != expected:
                raise CaptureError(f"{where}, line {line}: frame {number}, expected {expected}")
            frames.append({})
            check_size(len(frames), len(rig.skeleton), f"{where}, line {line}")
        else:
            _add(words, frames, widths, line, where)
    if not frames:
        raise CaptureError(f"{where}: no frames (truncated?)")
    _require_all(frames[-1], widths, f"{where}, line {begun}")
    return {
        name: table([frame[name] for frame in frames], width, where)
        for name, width in widths.items()
    }, degrees


def _add(
    words: list[str],
    frames: list[dict[str, BoneRow]],
    widths: dict[str, int],
    line: int,
    where: str,
) -> None:
    name = words[0]
    if not frames:
        raise CaptureError(
            f"{where}, line {line}: {quote(' '.join(words))}, expected the number of a frame"
        )
    if name not in widths:
        raise CaptureError(
            f"{where}, line {line}: {quote(name)}, expected a bone that has channels in the ASF"
        )
    if name in frames[-1]:
        raise CaptureError(f"{where}, line {line}: bone {quote(name)} occurs twice in the frame")
    frames[-1][name] = (line, " ".join(words[1:]))


def _require_all(frame: dict[str, BoneRow], widths: dict[str, int], where: str) -> None:
    if len(frame) < len(widths):
        missing = ", ".join(name for name in widths if name not in frame)
        raise CaptureError(f"{where}: frame without {missing} (truncated?)")
