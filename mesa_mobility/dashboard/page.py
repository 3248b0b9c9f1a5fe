"""The page that `mesa-mobility dashboard` serves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import solara

from mesa_mobility import PedestrianModel
from mesa_mobility.dashboard.app import Dashboard

opening: str | type[PedestrianModel] = "doorway"
given: Mapping[str, Any] = {}
model_files = False


@solara.component
def Page() -> None:
    """The dashboard, on the model that the command named."""
    Dashboard(opening, given, model_files)
