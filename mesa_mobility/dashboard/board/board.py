"""The tab on which a floor plan is drawn."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import solara

from mesa_mobility.dashboard.board.drawing import plan_of
from mesa_mobility.dashboard.widgets.text import heading
from mesa_mobility.errors import MobilityError


@solara.component_vue("board.vue")
def _Sheet(
    answer: dict[str, Any], event_drawn: Callable[[dict[str, Any]], None] | None = None
) -> None:
    """The sheet to draw on; what is to be saved goes to ``event_drawn``, and ``answer`` comes back.

    Args:
        answer: its number, the ``text`` of the file, ``notes`` and a ``problem``.
        event_drawn: called with the ``shapes`` and the ``name`` of the drawing.
    """


@solara.component
def Board() -> None:
    """A board for floor plans: drawn on a grid over a picture, and saved as GeoJSON."""
    answer, set_answer = solara.use_state({"number": 0, "text": "", "notes": [], "problem": ""})

    def save(what: dict[str, Any]) -> None:
        said: dict[str, Any] = {"number": what.get("number", 0), "text": "", "notes": []}
        try:
            plan, notes = plan_of(what.get("shapes"), what.get("name", ""))
            said |= {"text": json.dumps(plan.to_geojson(), indent=1), "notes": notes}
            said["problem"] = ""
        except MobilityError as error:
            said["problem"] = str(error)
        set_answer(said)

    heading(2, "Drawing board", hidden=True)
    _Sheet(answer=answer, event_drawn=save)
