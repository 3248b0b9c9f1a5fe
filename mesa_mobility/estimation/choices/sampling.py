"""Which choices are looked at, and when."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.errors import ModelError
from mesa_mobility.estimation.choices.places import Places


@dataclass(frozen=True, kw_only=True)
class Sampling:
    """Which choices are looked at, and which of their options.

    Attributes:
        frames: durations of choices in frames of the simulation, of those that the preset's options
            have; by default the two longest. They take turns.
        interval: seconds between two instants at which everybody's choice is looked at.
        most: most choices; more are thinned out at random.
        alternatives: options drawn uniformly from those available, beside the observed one.
        poses: clusters among whose options a choice is: head tracks do not show the pose.
        speeds: values that stand for the distribution of free speeds of people whose own is
            not known.
        history: seconds of earlier frames of which a velocity is the mean.
        seed: of all that is drawn.
    """

    frames: Sequence[int] = ()
    interval: float = 0.5
    most: int = 2500
    alternatives: int = 120
    poses: int = 4
    speeds: int = 3
    history: float = 0.8
    seed: int = 1

    def with_frames(self, durations: Sequence[int]) -> Sampling:
        """The same with durations of a preset's options.

        Args:
            durations: of the options, frames.

        Raises:
            ModelError: another duration is asked for.
        """
        known = sorted(durations)
        for each in self.frames:
            if each not in known:
                expected = ", ".join(map(str, known))
                raise ModelError(
                    f"sampling: {each} frames, expected durations of the preset's options: "
                    f"{expected}"
                )
        return self if self.frames else replace(self, frames=tuple(known[-2:]))


class Situation(NamedTuple):
    """A moment at which some people choose.

    Attributes:
        frame: of the tracks.
        duration: of the choices, frames of the simulation.
        people: (c,) indices of the people.
    """

    frame: float
    duration: int
    people: NDArray[np.int64]


def situations(
    of: Places,
    chosen: Sampling,
    between: tuple[float, float] | None,
    rng: np.random.Generator,
) -> list[Situation]:
    """The moments and who chooses then: those seen long enough before and after."""
    first, last = between or (of.first, of.last)
    step = chosen.interval * of.rate
    frames = np.round(np.arange(max(first, of.first), min(last, of.last) + 1e-9, step))
    durations = [chosen.frames[at % len(chosen.frames)] for at in range(len(frames))]
    found = []
    for frame, duration in zip(frames.tolist(), durations, strict=True):
        seen = [of.at(frame), of.at(frame - chosen.history * of.rate)]
        seen.append(of.at(frame + duration / FRAMES_A_SECOND * of.rate))
        people = np.flatnonzero(~np.isnan(np.sum(seen, axis=(0, 2))))
        if len(people):
            found.append(Situation(frame, duration, people.astype(np.int64)))
    total = sum(len(each.people) for each in found)
    if total <= chosen.most:
        return found
    kept = np.sort(rng.choice(total, chosen.most, replace=False))
    bounds = np.cumsum([0] + [len(each.people) for each in found])
    thinned = []
    for each, a, b in zip(found, bounds[:-1], bounds[1:], strict=True):
        own = kept[(kept >= a) & (kept < b)] - a
        if len(own):
            thinned.append(each._replace(people=each.people[own]))
    return thinned
