"""Headings, notes and what is read aloud."""

from __future__ import annotations

from typing import Any

import solara


def heading(level: int, text: str, *, hidden: bool = False) -> solara.Element:
    """A heading h1, h2 or h3; one that is ``hidden`` is for screen readers alone."""
    classes = "mm-heading mm-hidden" if hidden else "mm-heading"
    return solara.v.Html(tag=f"h{level}", children=[text], class_=classes)


def status(text: str, classes: str = "") -> solara.Element:
    """Text that a screen reader says when it has changed, after what it is saying."""
    return solara.v.Html(tag="span", children=[text], class_=classes, attributes={"role": "status"})


@solara.component
def Note(text: str, announced: bool = True, children: list[Any] = []) -> None:  # noqa: B006
    """Something to know, with buttons below it; errors are alerts instead.

    Args:
        text: what is said.
        announced: whether a screen reader says it when it appears.
        children: below the text.
    """
    with solara.Div(classes=["mm-note-box"]):
        if announced:
            status(text)
        else:
            solara.Text(text)
        if children:
            solara.Row(gap="8px", children=children)
