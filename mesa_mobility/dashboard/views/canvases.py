"""Components that draw on a canvas, and share how."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any

import solara

import mesa_mobility.animation

_FOLDER = Path(__file__).parent / "browser"
VIEWER = Path(mesa_mobility.animation.__file__).parent / "viewer"

_PART = re.compile(r"^ *(?:<!--|/\*) (\w+\.(?:html|css)) (?:-->|\*/)\n", re.MULTILINE)

SHARED = "assembling.js", "plan/colours.js", "plan/drawing.js"


def canvas_component(
    file: str, *scripts: str
) -> Callable[[Callable[..., None]], Callable[..., solara.Element]]:
    """Make a component of a Vue file in ``browser``, with other scripts at the head of its own.

    A component goes to the browser as one text, which cannot import another. A line that is a
    comment with the name of another file in ``browser`` stands for the text of that file.

    Args:
        file: name of the Vue file; the arguments of the decorated function are its properties.
        scripts: names of what it uses beside ``SHARED``, in ``browser`` or in the viewer that
            plays saved runs.
    """
    paths = [(_FOLDER / name, VIEWER / name) for name in (*SHARED, *scripts)]
    shared = "\n".join(
        (own if own.is_file() else other).read_text(encoding="utf-8") for own, other in paths
    )
    own = _PART.sub(
        lambda found: (_FOLDER / found[1]).read_text(encoding="utf-8"),
        (_FOLDER / file).read_text(encoding="utf-8"),
    )
    template = own.replace("<script>\n", f"<script>\n{shared}\n", 1)

    def decorate(function: Callable[..., None]) -> Callable[..., solara.Element]:
        make = solara.component_vue(f"browser/{file}")(function)

        @wraps(function)
        def component(**properties: Any) -> solara.Element:
            return make(template=template, **properties)

        return component

    return decorate
