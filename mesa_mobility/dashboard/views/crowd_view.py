"""The crowd on its floor plan, on a canvas."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from mesa_mobility.dashboard.views.canvases import canvas_component
from mesa_mobility.results.engineering.service import service_limits

SERVICE = service_limits().tolist()


@canvas_component(
    "crowd_view.vue",
    "plan/floor.js",
    "between.js",
    "frames.js",
    "mapped.js",
    "past.js",
    "plan/layer.js",
    "plan/curves.js",
    "plan/gestures.js",
    "plan/people.js",
    "plan/plane.js",
    "sheets.js",
    "steering.js",
    "storeys.js",
    "trails.js",
)
def CrowdCanvas(
    floor: dict[str, Any],
    frame: dict[str, Any] = {},  # noqa: B006
    selected: int = -1,
    service: Sequence[float] = SERVICE,
    height: str = "62vh",
    shortcuts: bool = False,
    event_seen: Callable[[int], None] | None = None,
    event_pick: Callable[[dict[str, Any]], None] | None = None,
    event_toggle: Callable[[dict[str, Any]], None] | None = None,
    event_steer: Callable[[dict[str, Any]], None] | None = None,
    event_play: Callable[[Any], None] | None = None,
) -> None:
    """The canvas; of a building also a choice of storeys and a section.

    Args:
        floor: what ``serialization.floor`` makes.
        frame: what ``serialization.frame`` makes; left out where a feed writes it.
        selected: row of the person to mark, or -1.
        service: greatest densities of the levels of service A to E, persons/m2.
        height: of the canvas, as CSS says it.
        shortcuts: whether keys count also where nothing on the page has the focus.
        event_seen: called with the number of a frame when the page has got it.
        event_pick: called with ``{"row": row, "run": number}``: the person that was clicked, or -1,
            and the run that was shown then.
        event_toggle: called with ``{"opening": name, "run": number}`` or ``{"obstacle": number,
            "run": number}`` when one was clicked.
        event_steer: called with ``{"row": row, "direction": [x, y], "run": number}`` when keys that
            steer somebody are pressed or let go; the direction is None when all are.
        event_play: called when the space bar is to start or to pause time.
    """
