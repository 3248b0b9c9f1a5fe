"""Long stairs from recordings of a few steps: each cycle of the gait is repeated, at more cadences.

Recordings of people on stairs are short, since laboratories have stairs of a few steps. But a cycle
of the gait on a stair is like the next: two steps, from where a foot lands until it lands again two
treads on. Cycles are found in the recordings, closed, and repeated. Their strides are scaled to the
tread, since on a stair the stride is the tread. So faster and slower people differ in cadence
alone, and cycles are repeated at several cadences.

The climb is taken out: in a map people walk in a plane. A body keeps its height over the line
through the middles of the treads.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mesa_mobility.capture import Recording, leg_joints, scale
from mesa_mobility.capture.transforms import trim
from mesa_mobility.errors import MapError

CADENCES = (0.6, 0.9, 1.2, 1.6, 2.0, 2.5, 3.0)
"""Steps a second. With treads of 0.29 m people walk 0.17 to 0.87 m/s."""

SECONDS = 6.0
"""Least length of a long stair. The longest options take 1.5 s."""

STILL = 0.2
"""m/s: the toes of a foot that stands are slower."""

LEAST_STANCE = 0.2
"""Seconds that a foot stands at least."""

SAME_PLACE = 0.1
"""Metres: a foot that moves less from one stance to the next has not been lifted."""

LEAST_RISER = 0.1
"""Metres by which a step leads up or down at least."""


@dataclass(frozen=True)
class _Stance:
    """A foot that stands: its first and last frame, the place of its toes in metres, its side."""

    first: int
    last: int
    toes: NDArray[np.float64]
    left: bool


@dataclass(frozen=True, eq=False)
class StairCycle:
    """One cycle of the gait on a stair, two steps.

    Attributes:
        recording: the cycle. It leads along +x, and the last pose is the first one again.
        way: metres in plan.
        rise: metres, below 0 for people who walk down.
    """

    recording: Recording
    way: float
    rise: float

    @property
    def cadence(self) -> float:
        """Steps a second, as recorded."""
        return 2.0 / self.recording.duration

    def repeated(self, tread: float, cadence: float) -> Recording:
        """A long stair of this cycle.

        Args:
            tread: depth of a tread, metres.
            cadence: steps a second.
        """
        of = self.recording
        times = int(np.ceil(SECONDS * cadence / 2.0))
        step = of.root_position[:-1] * [2.0 * tread / self.way, 1.0, 1.0]
        ways = np.arange(times)[:, None, None] * [2.0 * tread, 0.0, 0.0]
        long = replace(
            of,
            name=f"{of.name} at {cadence:g} steps a second",
            root_position=(ways + step).reshape(-1, 3),
            rotations=np.tile(of.rotations[:-1], (times, 1, 1)),
            slope=self.rise / (2.0 * tread),
        )
        return scale(long, time=self.cadence / cadence)


def on_long_stairs(
    recordings: Sequence[Recording], *, up: bool, tread: float
) -> tuple[list[Recording], dict[str, Any]]:
    """Recordings of people on long stairs, and the entries of a map's metadata that say how.

    Args:
        recordings: of people who walk on stairs of a few steps.
        up: whether people walk up, or down.
        tread: depth of a tread, metres.

    Raises:
        MapError: nobody takes three steps one after the other.
    """
    cycles = [each for one in recordings for each in stair_cycles(one) if (each.rise > 0.0) == up]
    direction = "up" if up else "down"
    if not cycles:
        raise MapError(
            f"nobody walks {direction} stairs in these recordings, expected three steps of "
            f"{LEAST_RISER:g} m or more one after the other"
        )
    metadata = {
        "derived": {
            "from": f"{len(cycles)} cycles of the gait {direction} a stair",
            "by": "repeating each cycle, scaling strides to the tread and times to the cadence; "
            "joint angles stay",
            "direction": direction,
            "tread_m": tread,
            "cadences_steps_s": list(CADENCES),
            "recorded": {
                "treads_m": [round(each.way / 2.0, 3) for each in cycles],
                "risers_m": [round(abs(each.rise) / 2.0, 3) for each in cycles],
                "cadences_steps_s": [round(each.cadence, 2) for each in cycles],
            },
        }
    }
    return [each.repeated(tread, c) for each in cycles for c in CADENCES], metadata


def stair_cycles(recording: Recording) -> list[StairCycle]:
    """The cycles of the gait on stairs that a recording shows, up or down."""
    stances = _stances(recording)
    floor = min((each.toes[2] for each in stances), default=0.0)
    found = []
    for three in zip(stances, stances[1:], stances[2:], strict=False):
        rises = [each.toes[2] - _other(each, stances) for each in three]
        alternate = three[0].left == three[2].left != three[1].left
        if alternate and (min(rises) >= LEAST_RISER or max(rises) <= -LEAST_RISER):
            found.append(_closed(recording, three[0], three[2], floor))
    return found


def _stances(recording: Recording) -> list[_Stance]:
    """In the order in which the feet land."""
    legs, places = leg_joints(recording.skeleton), recording.positions()
    found: list[_Stance] = []
    for left, leg in ((True, legs.left), (False, legs.right)):
        toes = places[:, leg[-1]]
        speed = np.linalg.norm(np.gradient(toes, axis=0), axis=1) * recording.frame_rate
        ends = np.flatnonzero(np.diff(speed < STILL, prepend=False, append=False))
        own: list[_Stance] = []
        for first, last in ends.reshape(-1, 2).tolist():
            stance = _Stance(first, last, toes[first:last].mean(axis=0), left)
            if last - first < LEAST_STANCE * recording.frame_rate:
                continue
            if own and np.linalg.norm(stance.toes - own[-1].toes) < SAME_PLACE:
                own[-1] = replace(own[-1], last=last)
            else:
                own.append(stance)
        found += own
    return sorted(found, key=lambda each: each.first)


def _other(of: _Stance, stances: Sequence[_Stance]) -> float:
    """Height of the toes of the other foot when a foot lands; its own if there was no other."""
    before = [each for each in stances if each.left != of.left and each.first < of.first]
    return float((before or [of])[-1].toes[2])


def _closed(recording: Recording, start: _Stance, end: _Stance, floor: float) -> StairCycle:
    """The cycle from one landing of a foot to the next, along +x, its ends alike.

    What differs between the last pose and the first is taken out evenly over the cycle.
    """
    own = trim(recording, start.first, end.first + 1)
    share = np.linspace(0.0, 1.0, own.frames)[:, None]
    rotations = own.rotations.copy()
    for joint in range(rotations.shape[1]):
        each = Rotation.from_quat(rotations[:, joint])
        off = (each[-1].inv() * each[0]).as_rotvec()
        rotations[:, joint] = (each * Rotation.from_rotvec(share * off)).as_quat()
    way, rise = end.toes[:2] - start.toes[:2], float(end.toes[2] - start.toes[2])
    length = float(np.hypot(*way))
    ahead = Rotation.from_euler("z", -np.arctan2(way[1], way[0]))
    rotations[:, 0] = (ahead * Rotation.from_quat(rotations[:, 0])).as_quat()
    # From the toes that have landed, on the line through the treads.
    places = ahead.apply(own.root_position - [*start.toes[:2], start.toes[2] - floor])
    places[:, 2] -= rise / length * places[:, 0]
    missing = places[0] + [length, 0.0, 0.0] - places[-1]
    places += share * missing
    made = replace(own, root_position=places, rotations=rotations)
    return StairCycle(made, length, rise)
