"""Find movements in a recording that no human can make, and the parts between them.

A marker that is lost, swapped or mislabelled moves the body by decimetres within one frame.  Such
frames are found by the motion that hips and legs would have had to make:

- Speed.  A body moves no faster than the fastest sprint ever measured.  A swinging foot moves about
  twice as fast as the body.
- Turning.  The fastest spin on ice took 0.175 s a turn (342 a minute, Guinness World Records 2015).
- Change of velocity.  Feet on the ground cannot speed up the body by much more than gravity would,
  as friction limits them.  Steps, soft tissue and markers shake the hips by up to 87 m/s2 and the
  feet by up to 174 m/s2 in 183 recordings of people who walk, run and turn; what lies well above
  is no movement.

All are taken at 30 Hz, whatever the recording's own rate is: noise of a millimetre means next to
nothing at 30 Hz and 30 m/s2 at 120 Hz.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.capture.legs import leg_joints
from mesa_mobility.capture.recording import Recording
from mesa_mobility.capture.transforms import resample, trim
from mesa_mobility.human_limits import FASTEST_SPRINT

FRAME_RATE = 30.0
"""Frames a second at which jumps are looked for."""

HIPS_SPEED, LEGS_SPEED = FASTEST_SPRINT, 25.0
"""Highest speeds in m/s of the point between the hips, and of hips, knees, ankles and toes."""

HIPS_ACCELERATION, LEGS_ACCELERATION = 100.0, 250.0
"""Highest rates in m/s2 at which the same may change their velocity from one frame to the next."""

TURN_RATE = 36.0
"""Highest turn rate in rad/s of the line through both hips."""

_PARTS = ("hips", *(f"{s} {j}" for s in ("left", "right") for j in ("hip", "knee", "ankle", "toe")))
_SPEEDS = np.array([HIPS_SPEED] + [LEGS_SPEED] * 8)
_ACCELERATIONS = np.array([HIPS_ACCELERATION] + [LEGS_ACCELERATION] * 8)


@dataclass(frozen=True)
class Jumps:
    """Where joints jump.

    Attributes:
        spoilt: (F,) bool; frames that jump, or lie next to one that does.
        frames: (k,) int64; the worst frame of each run of spoilt ones, ascending.
        reason: description of the first jump, in one line; empty if there is none.
    """

    spoilt: NDArray[np.bool_]
    frames: NDArray[np.int64]
    reason: str


def find_jumps(legs: NDArray[np.float64]) -> Jumps:
    """Find the frames at 30 Hz in which joints jump: move as no human can.

    Speeds, changes of velocity and the turn rate of the hips are compared with what people can do.

    Args:
        legs: (F, 8, 3) positions in metres of hip, knee, ankle and toe, left, then right.
    """
    hips = 0.5 * (legs[:, 0] + legs[:, 4])
    velocity = np.diff(np.concatenate([hips[:, None], legs], axis=1), axis=0) * FRAME_RATE
    across = legs[:, 0] - legs[:, 4]
    angle = np.arctan2(
        np.linalg.norm(np.cross(across[:-1], across[1:]), axis=1),
        np.sum(across[:-1] * across[1:], axis=1),
    )
    speed = _of_frames(np.linalg.norm(velocity, axis=2))
    turn = _of_frames(angle[:, None] * FRAME_RATE)
    acceleration = np.zeros_like(speed)
    acceleration[1:-1] = np.linalg.norm(np.diff(velocity, axis=0), axis=2) * FRAME_RATE
    excess = np.concatenate(
        [speed / _SPEEDS, turn / TURN_RATE, acceleration / _ACCELERATIONS], axis=1
    )
    worst = excess.max(axis=1)
    spoilt = worst > 1.0
    edges = np.flatnonzero(np.diff(spoilt, prepend=False, append=False))
    frames = [a + int(np.argmax(worst[a:b])) for a, b in edges.reshape(-1, 2).tolist()]
    reason = _reason(excess[frames[0]]) if frames else ""
    return Jumps(spoilt, np.array(frames, dtype=np.int64), reason)


def _of_frames(steps: NDArray[np.float64]) -> NDArray[np.float64]:
    """(F, k) the larger value of the steps, (F - 1, k), before and after each frame."""
    padded = np.pad(steps, ((1, 1), (0, 0)))
    return np.maximum(padded[:-1], padded[1:])


def _reason(excess: NDArray[np.float64]) -> str:
    """Description of a frame's jump, from its row of ``excess``; speeds are reported first."""
    speeds, turn, accelerations = excess[:9], float(excess[9]), excess[10:]
    part = int(np.argmax(speeds if speeds.max() > 1.0 else accelerations))
    who = f"the {_PARTS[part]} {'move' if part == 0 else 'moves'}"
    if speeds.max() > 1.0:
        limit = _SPEEDS[part]
        return f"{who} at {speeds[part] * limit:.1f} m/s, expected at most {limit:g}"
    if turn > 1.0:
        return f"the hips turn at {turn * TURN_RATE:.0f} rad/s, expected at most {TURN_RATE:g}"
    limit = _ACCELERATIONS[part]
    return f"{who} with {accelerations[part] * limit:.0f} m/s2, expected at most {limit:g}"


@dataclass(frozen=True)
class Parts:
    """The parts of a recording between its jumps.

    Attributes:
        ranges: (first frame, frame after the last) of each part, ascending.
        jumps: the frames at which the recording jumps, ascending.
        reason: description of the first jump, in one line; empty if there is none.
    """

    ranges: tuple[tuple[int, int], ...]
    jumps: tuple[int, ...]
    reason: str


def sound_parts(recording: Recording, shortest: int) -> Parts:
    """Cut a recording where it jumps; see :func:`find_jumps`.

    Args:
        recording: at any frame rate; frames are counted at this rate.
        shortest: frames at 30 Hz that a part must have; shorter ones are left out.

    Raises:
        CaptureError: the legs of the skeleton are not known by name.
    """
    legs = leg_joints(recording.skeleton)
    joints = [*legs.left, *legs.right]
    ratio = recording.frame_rate / FRAME_RATE
    sound: list[tuple[int, int]] = []
    jumps: dict[int, str] = {}
    pending = [(0, recording.frames)]
    while pending:
        start, stop = pending.pop()
        sampled = resample(trim(recording, start, stop), FRAME_RATE)
        found = find_jumps(sampled.positions()[:, joints])
        if not found.spoilt.any():
            sound.append((start, stop))
            continue
        at = (start + np.round(found.frames * ratio)).astype(int).tolist()
        jumps |= dict.fromkeys(at, "") | {at[0]: found.reason}
        # Resampling a part starts from its own first frame, which may give other frames at 30 Hz:
        # check it again.
        edges = np.flatnonzero(np.diff(~found.spoilt, prepend=False, append=False))
        for first, after in edges.reshape(-1, 2).tolist():
            if after - first >= shortest:
                begin = start + math.ceil(first * ratio - 1e-6)
                last = start + math.floor((after - 1) * ratio + 1e-6)
                pending.append((begin, stop if after == sampled.frames else last + 1))
    order = sorted(jumps)
    return Parts(tuple(sorted(sound)), tuple(order), jumps[order[0]] if order else "")
