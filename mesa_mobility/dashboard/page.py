"""The page that `mesa-mobility dashboard` serves."""

from __future__ import annotations

import solara

from mesa_mobility.dashboard.app import Dashboard

opening = "doorway"


@solara.component
def Page() -> None:
    """The dashboard, on the model that the command named."""
    Dashboard(opening)
