"""Whether what a model has recorded, according to a checkpoint, is a run of its people."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.errors import ContentError
from mesa_mobility.human_limits import FASTEST_SPRINT

_ROUNDING = 1e-6
"""Metres and radians."""


def check_recording(
    recorded: Mapping[str, NDArray[Any]],
    crowd: Crowd,
    frame: int,
    shifts: NDArray[np.float64],
) -> None:
    """Check the order of a recording, its end, and how far people go from frame to frame.

    Args:
        recorded: the columns, see ``Recorder.arrays``.
        crowd: the crowd now.
        frame: now.
        shifts: (k, 2) metres from sheet to sheet, by which people may go at once.

    Raises:
        ContentError: naming the first row that cannot be.
    """
    when, who = recorded["frame"].astype(np.int64), recorded["person"].astype(np.int64)
    order = when * (1 + who.max(initial=0)) + who
    _check(np.diff(order, prepend=-1) > 0, "expected frames in order, and in each its people")
    _check(when <= frame, "is later than now")
    now = when == frame
    for name in ("x", "y", "heading"):
        there = getattr(crowd, name)[who]
        _check(~now | (np.abs(recorded[name] - there) <= _ROUNDING), f"{name} is not that of now")
    track = np.lexsort((when, who))
    same = (np.diff(who[track]) == 0) & (np.diff(when[track]) == 1)
    dx, dy = np.diff(recorded["x"][track]), np.diff(recorded["y"][track])
    steps = np.hypot(dx, dy)
    for x, y in shifts:
        steps = np.minimum(steps, np.hypot(dx - x, dy - y))
    most = max(FASTEST_SPRINT, float(crowd.agenda["speed"].max(initial=0.0))) / FRAMES_A_SECOND
    walks = np.ones(len(who), dtype=np.bool_)
    walks[track[1:]] = ~same | (steps <= most + _ROUNDING)
    _check(walks, f"is more than {most:.2f} m from the frame before")


def _check(fits: NDArray[np.bool_], text: str) -> None:
    if not fits.all():
        raise ContentError(f"recorder, row {int(np.argmin(fits))}: {text}")
