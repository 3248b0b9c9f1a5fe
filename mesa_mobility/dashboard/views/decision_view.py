"""One pedestrian's decision: its options and their costs by term."""

from __future__ import annotations

from typing import Any

from mesa_mobility.dashboard.views.canvases import canvas_component


@canvas_component("decision_view.vue", "plan/floor.js", "options.js")
def DecisionCanvas(
    floor: dict[str, Any],
    decision: dict[str, Any] = {},  # noqa: B006
) -> None:
    """The view; nothing is selected where ``decision`` is empty.

    Args:
        floor: what ``serialization.floor`` makes.
        decision: what ``decision.described`` makes; left out where a feed writes it.
    """
