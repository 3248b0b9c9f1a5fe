"""The player of a saved run, inside the dashboard's page."""

from __future__ import annotations

import solara


@solara.component_vue("browser/saved_run.vue")
def SavedRunFrame(page: str, height: str = "78vh") -> None:
    """The page of a saved run, in a frame that has no access to the page around it.

    Args:
        page: what ``animation.page.page_text`` makes.
        height: of the frame, as CSS says it.
    """
