"""Around the dashboard: language of the page, link past the controls, drawer on a phone."""

from __future__ import annotations

from mesa_mobility.dashboard.views.canvases import canvas_component


@canvas_component("page_frame.vue")
def PageFrame() -> None:
    """Names the page's language and its menu, and gives it a link to the crowd at its head.

    The page is dark where the browser prefers dark pages. On a narrow page the drawer of controls
    starts closed.
    """
