"""Fields that a page's reader sets: texts, numbers with a slider, lists, switches.

The browser has the value of a field until it is told to the server, and shows what the server says
of it only while the field has no focus (``field.vue``).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import solara

from mesa_mobility.plugins.annotations import Range


@solara.component_vue("field.vue")
def _Field(
    control: dict[str, Any],
    label: str,
    text: str,
    event_done: Callable[[str], None],
    help: str = "",
    error: str = "",
    says: str = "",
    quiet: bool = False,
) -> None: ...


@solara.component
def Choice(
    label: str,
    values: list[str],
    value: str,
    change: Callable[[str], None],
    description: str = "",
    error: str = "",
    quiet: bool = False,
) -> None:
    """A list to choose from, with what it is for below it.

    Args:
        label: its name.
        values: what is offered.
        value: the one that is chosen.
        change: called with another one.
        description: what it is for.
        error: what is wrong with the value, or "".
        quiet: whether the description is shown under the pointer alone.
    """
    _Field(
        control={"kind": "list", "items": values},
        label=label,
        text=value,
        event_done=change,
        help=description,
        error=error,
        quiet=quiet,
    )


@solara.component
def TextField(
    label: str,
    text: str,
    change: Callable[[str], None],
    error: str = "",
    description: str = "",
    says: str = "",
    quiet: bool = False,
    limits: Range | None = None,
    whole: bool = False,
) -> None:
    """A field that reports its text on Enter, or when it loses the focus.

    Args:
        label: its name on the page.
        text: what it holds.
        change: called with another text.
        error: what is wrong with the text, or "".
        description: what it is for.
        says: its name where the label alone does not tell it from others.
        quiet: whether the description is shown under the pointer alone.
        limits: adds a slider over these numbers; the field takes others, too.
        whole: whether the slider gives whole numbers.
    """
    slider = None
    if limits is not None:
        slider = {"low": limits.low, "high": limits.high, "whole": whole}
    _Field(
        control={"kind": "text", "limits": slider},
        label=label,
        text=text,
        event_done=change,
        help=description,
        error=error,
        says=says or label,
        quiet=quiet,
    )


@solara.component
def Switch(
    label: str,
    on: bool,
    change: Callable[[bool], None],
    description: str = "",
    error: str = "",
    quiet: bool = False,
) -> None:
    """A box to tick; arguments as those of `Choice`."""
    _Field(
        control={"kind": "switch"},
        label=label,
        text=str(on),
        event_done=lambda text: change(text == "True"),
        help=description,
        error=error,
        quiet=quiet,
    )
