"""Mesa's clock, in seconds on all its versions.

Mesa 3.3 has no time, 3.4 adds 1 a step, and from 3.5 on steps are events, 1.0 apart. A model tells
its time in each step; where steps are events, these are moved as well.
"""

from __future__ import annotations

from dataclasses import replace
from types import MethodType
from typing import Any

from mesa_mobility.crowd.options.table import FRAME_SECONDS

EARLY = 1e-6
"""Seconds by which a step comes before its end: sums of tenths, which ``run_for`` works with, may
fall short of it by the rounding."""


def scheduled_events(model: object) -> int:
    """Events that a model of a newer Mesa has to come; models of Mesa 3.3 keep none."""
    owner = getattr(model, "_scheduler", model)
    events = getattr(owner, "_event_list", ())
    return len(events) if hasattr(events, "__len__") else 0


def tell_time(model: Any) -> None:
    """Set a model's ``time`` to its seconds.

    Mesa 3.4's simulators, gone in 3.5, count steps in it: they keep theirs.
    """
    if getattr(model, "_simulator", None) is None or hasattr(model, "_default_schedule"):
        model.time = model.elapsed


def set_clock(model: Any) -> None:
    """Let the next step come when its frames are over, and each other one after it.

    Does nothing where Mesa has no events.
    """
    steps: Any = getattr(model, "_default_schedule", None)
    if steps is None:
        return
    steps.stop()
    steps.schedule = replace(
        steps.schedule, start=model.time + _interval(model), interval=_interval
    )
    steps.start()
    # Mesa's own goes on by 1.0.
    model.step = MethodType(_step, model)


def _interval(model: Any) -> float:
    """Seconds until the next step; the frames that one has may change at any time."""
    return model.elapsed + model.frames_per_step * FRAME_SECONDS - EARLY - model.time


def _step(model: Any) -> None:
    """Go on to the end of the next step, with all events before it."""
    model._advance_time(model._default_schedule.next_scheduled_time)
    tell_time(model)
