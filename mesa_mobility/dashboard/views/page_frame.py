"""Around the dashboard: language of the page, link past the controls, drawer on a phone."""

from __future__ import annotations

from collections.abc import Callable

from mesa_mobility.dashboard.views.canvases import canvas_component


@canvas_component("page_frame.vue")
def PageFrame(title: str, event_told: Callable[[bool], None] | None = None) -> None:
    """Names the page's language and its menu; a heading and a link to the crowd are at its head.

    The page is dark where the browser prefers dark pages. On a narrow page the drawer of controls
    starts closed.

    Args:
        title: the page's heading.
        event_told: called with whether the page is dark, first and when that changes.
    """
