"""Edited options: recorded ones whose way is bent and whose strides are scaled.

Motion path editing (Gleicher 2001): each step of a path is rotated by an angle that grows linearly
with time, and scaled.  The gait stays as it was recorded.  One recorded option thus stands for a
family of options around it, and a minute of recording for a crowd.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

HORIZON = 45
"""Frames over which the turn of an edit is given."""

SAMPLE_EVERY = 3
"""Frames between the samples of a path."""


@dataclass(frozen=True)
class Edit:
    """One way to edit an option.

    Attributes:
        turn: how far the path is bent to the left within 45 frames, radians.
        stride: factor of the length of each step.
    """

    turn: float
    stride: float

    @property
    def cost(self) -> float:
        """What an edit adds to the cost of the option: 0.1 for 10 degrees, 0.3 for 15 %."""
        return 0.1 * abs(self.turn) / np.deg2rad(10.0) + 0.3 * abs(self.stride - 1.0) / 0.15

    @property
    def turn_rate(self) -> float:
        """Radians that it turns a path within a sample."""
        return self.turn * SAMPLE_EVERY / HORIZON


def rotations(edit: Edit, samples: int) -> NDArray[np.float64]:
    """(samples, 2) cosine and sine of how each step is rotated, in its middle, times the stride."""
    angle = edit.turn_rate * (np.arange(samples) + 0.5)
    return np.column_stack([edit.stride * np.cos(angle), edit.stride * np.sin(angle)])


def edit_paths(paths: NDArray[np.floating], edit: Edit) -> NDArray[np.float64]:
    """Bend and scale paths.

    Args:
        paths: (m, s, 3) x, y in metres and heading in radians every 3 frames, start left out.
        edit: what to do with them.

    Returns:
        (m, s, 3) paths in the same form.
    """
    steps = np.diff(paths[..., :2].astype(np.float64), axis=1, prepend=0.0)
    c, s = rotations(edit, paths.shape[1]).T
    bent = np.empty(paths.shape)
    bent[..., 0] = np.cumsum(c * steps[..., 0] - s * steps[..., 1], axis=1)
    bent[..., 1] = np.cumsum(s * steps[..., 0] + c * steps[..., 1], axis=1)
    bent[..., 2] = paths[..., 2] + edit.turn_rate * np.arange(1, paths.shape[1] + 1)
    return bent


def grid(turns: Sequence[float], strides: Sequence[float]) -> tuple[Edit, ...]:
    """All edits with one of these turns, degrees in 45 frames, and one of these strides."""
    return tuple(
        Edit(np.deg2rad(turn), stride)
        for turn in turns
        for stride in strides
        if (turn, stride) != (0.0, 1.0)
    )


TURNS_DEG = (-20.0, -10.0, 0.0, 10.0, 20.0)
STRIDES = (0.7, 0.85, 1.0, 1.15, 1.3)
EDITS = grid(TURNS_DEG, STRIDES)
"""Edits of the options of every map but those for stairs; their extent was chosen on clips left
out."""


@dataclass(frozen=True)
class Editing:
    """Which options of a map are edited, and how.

    Attributes:
        turns_deg: turns, degrees in 45 frames.
        strides: factors of the length of each step.
        frames: durations of the options that are edited.
    """

    turns_deg: tuple[float, ...] = TURNS_DEG
    strides: tuple[float, ...] = STRIDES
    frames: tuple[int, ...] = (HORIZON,)

    @property
    def edits(self) -> tuple[Edit, ...]:
        """All edits with one of the turns and one of the strides."""
        return grid(self.turns_deg, self.strides)


ON_FLOORS = Editing()
ON_STAIRS = Editing((-60.0, -40.0, -20.0, 0.0, 20.0, 40.0, 60.0), (1.0,), (12, 24, 45))
"""On stairs the stride is the tread. Nobody was recorded who turns there: without edits of short
options people could not steer."""
