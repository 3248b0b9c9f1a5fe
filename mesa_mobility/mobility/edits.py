"""Edited options: recorded ones whose way is bent and whose strides are scaled.

Motion path editing (Gleicher 2001): each step of a path is rotated by an angle that grows linearly
with time, and scaled.  The gait stays as it was recorded.  One recorded option thus stands for a
family of options around it, and a minute of recording for a crowd.
"""

from __future__ import annotations

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


def edit_paths(paths: NDArray[np.floating], edit: Edit) -> NDArray[np.float64]:
    """Bend and scale paths.

    Args:
        paths: (m, s, 3) x, y in metres and heading in radians every 3 frames, start left out.
        edit: what to do with them.

    Returns:
        (m, s, 3) paths in the same form.
    """
    steps = np.diff(paths[..., :2].astype(np.float64), axis=1, prepend=0.0)
    samples = np.arange(paths.shape[1])
    rate = edit.turn * SAMPLE_EVERY / HORIZON
    angle = rate * (samples + 0.5)  # of the middle of each step
    c, s = edit.stride * np.cos(angle), edit.stride * np.sin(angle)
    bent = np.empty(paths.shape)
    bent[..., 0] = np.cumsum(c * steps[..., 0] - s * steps[..., 1], axis=1)
    bent[..., 1] = np.cumsum(s * steps[..., 0] + c * steps[..., 1], axis=1)
    bent[..., 2] = paths[..., 2] + rate * (samples + 1)
    return bent


def _grid(turns: tuple[float, ...], strides: tuple[float, ...]) -> tuple[Edit, ...]:
    return tuple(
        Edit(np.deg2rad(turn), stride)
        for turn in turns
        for stride in strides
        if (turn, stride) != (0.0, 1.0)
    )


TURNS_DEG = (-20.0, -10.0, 0.0, 10.0, 20.0)
STRIDES = (0.7, 0.85, 1.0, 1.15, 1.3)
EDITS = _grid(TURNS_DEG, STRIDES)
"""Edits of the options of every map; their extent was chosen on clips left out."""
