"""What was read, said so that a wrong unit shows at once: clips, people, units, and heights."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mesa_mobility.capture import Recording
from mesa_mobility.capture.manifest import UNKNOWN_TYPE

HEIGHTS_M = (0.9, 2.3)
"""How tall people come out, from a small child to a tall adult, from the lowest joint to the
highest."""

UNITS = {
    1.0: "metre",
    0.01: "centimetre",
    0.0254: "inch",
    0.0254 / 0.45: "inch / 0.45",
    0.001: "millimetre",
}
"""Names of the units in use, by their metres."""

EVERY = 10
"""Frames from one whose height is measured to the next."""


@dataclass(frozen=True)
class Summary:
    """What recordings hold.

    Attributes:
        clips: files.
        heights: height of each person in metres, by session and subject, or by skeleton where a
            folder has no manifest.
        units: clips by unit of length, and by whether the manifest says so or it was guessed.
        frame_rates: clips by frames a second of the file.
    """

    clips: int
    heights: dict[str, float]
    units: dict[str, int]
    frame_rates: dict[str, int]

    @property
    def lines(self) -> list[str]:
        """For people to read."""
        low, high = min(self.heights.values()), max(self.heights.values())
        tall = f"{low:.2f} m" if round(low, 2) == round(high, 2) else f"{low:.2f} to {high:.2f} m"
        return [
            f"{_many(self.clips, 'clip', 'clips')} of "
            f"{_many(len(self.heights), 'person', 'people')}, "
            f"{tall} tall from the lowest joint to the highest",
            f"unit of length: {_counts(self.units)}",
            f"frames a second: {_counts(self.frame_rates)}",
        ]

    @property
    def warnings(self) -> list[str]:
        """One line for each person of a height that nobody has."""
        low, high = HEIGHTS_M
        return [
            f"{name} comes out {height:.2f} m tall, expected {low:g} to {high:g} m: the unit of "
            "length may be another, which a manifest can say"
            for name, height in self.heights.items()
            if not low <= height <= high
        ]

    def answer(self) -> dict[str, Any]:
        """Ready for JSON."""
        return {
            "clips": self.clips,
            "people": len(self.heights),
            "heights_m": {name: round(each, 2) for name, each in self.heights.items()},
            "units": self.units,
            "frames_a_second": self.frame_rates,
            "warnings": self.warnings,
        }


def summary_of(recordings: Sequence[Recording]) -> Summary:
    """Summarise recordings as they were read, before they are scaled.

    Args:
        recordings: with the clips that they came from; at least one.
    """
    heights: dict[str, list[float]] = defaultdict(list)
    units, rates, files, skeletons = Counter[str](), Counter[str](), set(), dict[bytes, str]()
    for recording in recordings:
        clip = recording.clip
        # The root's offset is where a file begins, and of no body.
        offsets = np.round(recording.skeleton.offsets[1:], 3).tobytes()
        name = skeletons.setdefault(offsets, f"person {len(skeletons) + 1}")
        if clip is not None and clip.subject:
            name = f"{clip.subject} of {clip.session}"
        heights[name].append(_height(recording))
        if clip is not None and clip.path not in files:
            files.add(clip.path)
            source = "guessed" if clip.type == UNKNOWN_TYPE else "as the manifest says"
            units[f"{_unit(clip.unit_to_m)}, {source}"] += 1
            rates[f"{clip.native_fps:g}"] += 1
    middles = {name: float(np.median(each)) for name, each in heights.items()}
    return Summary(len(files) or len(recordings), middles, dict(units), dict(rates))


def _height(recording: Recording) -> float:
    """From the lowest joint to the highest, median of the frames, metres."""
    some = replace(
        recording,
        root_position=recording.root_position[::EVERY],
        rotations=recording.rotations[::EVERY],
    )
    return float(np.median(np.ptp(some.positions()[..., 2], axis=1)))


def _unit(metres: float) -> str:
    named = [name for unit, name in UNITS.items() if abs(metres / unit - 1.0) < 1e-3]
    return f"{metres:g} m ({named[0]})" if named else f"{metres:g} m"


def _many(number: int, one: str, several: str) -> str:
    return f"{number} {one if number == 1 else several}"


def _counts(counts: dict[str, int]) -> str:
    if len(counts) == 1:
        return next(iter(counts))
    return "; ".join(f"{name} in {_many(n, 'clip', 'clips')}" for name, n in counts.items())
