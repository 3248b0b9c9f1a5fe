"""The crowd in three dimensions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mesa_mobility.animation.page import STAGE_SCRIPTS
from mesa_mobility.dashboard.views.canvases import canvas_component


@canvas_component(
    "body_view.vue",
    "between.js",
    "frames.js",
    "past.js",
    "plan/curves.js",
    "plan/people.js",
    "sheets.js",
    "steering.js",
    *(f"{name}.js" for name in ("three.bundle", *STAGE_SCRIPTS)),
)
def BodyCanvas(
    floor: dict[str, Any],
    poses: str,
    solid: dict[str, Any] = {},  # noqa: B006
    frame: dict[str, Any] = {},  # noqa: B006
    selected: int = -1,
    height: str = "62vh",
    event_seen: Callable[[int], None] | None = None,
    event_pick: Callable[[dict[str, Any]], None] | None = None,
    event_steer: Callable[[dict[str, Any]], None] | None = None,
    event_play: Callable[[Any], None] | None = None,
) -> None:
    """The canvas.

    Args:
        floor: what ``serialization.floor`` makes.
        poses: what ``Bodies.bundle`` makes.
        solid: what ``drawn_building`` makes of a building; left out for a floor plan.
        frame: what ``serialization.frame`` makes with bodies; left out where a feed writes it.
        selected: row of the person to mark and to follow, or -1.
        height: of the canvas, as CSS says it.
        event_seen: called with the number of a frame when the page has got it.
        event_pick: called with ``{"row": row, "run": number}``: the person that was clicked, or -1,
            and the run that was shown then.
        event_steer: called with ``{"row": row, "direction": [x, y], "run": number}`` when keys that
            steer somebody are pressed or let go; the direction is None when all are.
        event_play: called when the space bar is to start or to pause time.
    """
