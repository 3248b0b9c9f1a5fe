"""The tab on which a floor plan is drawn."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import solara

from mesa_mobility.dashboard.board.drawing import drawing_of
from mesa_mobility.dashboard.board.pages import picture_of
from mesa_mobility.dashboard.widgets.text import heading
from mesa_mobility.errors import MobilityError


@solara.component_vue("board.vue")
def _Sheet(
    answer: dict[str, Any],
    page: dict[str, Any],
    event_drawn: Callable[[dict[str, Any]], None] | None = None,
    event_turned: Callable[[dict[str, Any]], None] | None = None,
) -> None:
    """The sheet to draw on; what is to be saved goes to ``event_drawn``, and ``answer`` comes back.

    Args:
        answer: its number, the ``text`` of the file, ``notes`` and a ``problem``.
        page: of a PDF: its number, the ``picture``, all ``pages`` and a ``problem``.
        event_drawn: called with the ``shapes`` and the ``name`` of the drawing.
        event_turned: called with the ``data`` of a PDF and the ``page`` to draw over.
    """


@solara.component
def Board() -> None:
    """A board for floor plans: drawn on a grid over a picture, and saved as GeoJSON."""
    answer, set_answer = solara.use_state({"number": 0, "text": "", "notes": [], "problem": ""})
    page, set_page = solara.use_state({"number": 0, "picture": "", "pages": 0, "problem": ""})

    def save(what: dict[str, Any]) -> None:
        said: dict[str, Any] = {"number": what.get("number", 0), "text": "", "notes": []}
        try:
            drawing = drawing_of(what.get("shapes"), what.get("name", ""))
            said |= {"text": json.dumps(drawing.to_geojson(), indent=1), "notes": drawing.notes}
            said["problem"] = ""
        except MobilityError as error:
            said["problem"] = str(error)
        set_answer(said)

    def turn(what: dict[str, Any]) -> None:
        said: dict[str, Any] = {"number": what.get("number", 0), "problem": ""}
        try:
            said |= picture_of(what.get("data"), what.get("page"))
        except MobilityError as error:
            said["problem"] = str(error)
        set_page(said)

    heading(2, "Drawing board", hidden=True)
    _Sheet(answer=answer, page=page, event_drawn=save, event_turned=turn)
