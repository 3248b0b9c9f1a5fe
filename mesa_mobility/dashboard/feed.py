"""What goes to a widget many times a second, past the drawing of the page.

A reactive value has Solara go over every widget of the page, which takes some milliseconds and
the thread of the run. A feed writes to one property of one widget.
"""

from __future__ import annotations

from typing import Any

import solara
from ipywidgets import Widget


class Feed:
    """One property of a widget, for whoever holds the feed to write to.

    Args:
        name: of the property.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._value: dict[str, Any] = {}
        self._widget: Widget | None = None

    @property
    def value(self) -> dict[str, Any]:
        """What was written last."""
        return self._value

    def set(self, value: dict[str, Any]) -> None:
        """Write to the widget, or keep it for the widget that is still to come."""
        self._value = value
        if self._widget is not None:
            setattr(self._widget, self._name, value)

    def attach(self, widget: Widget | None) -> None:
        """Write to this widget from now on; to none."""
        self._widget = widget
        if widget is not None:
            setattr(widget, self._name, self._value)


def use_feed(element: solara.Element, feed: Feed) -> None:
    """Let a feed write to the widget of an element; its property must not be given as argument."""

    def attach() -> Any:
        feed.attach(solara.get_widget(element))
        return lambda: feed.attach(None)

    # Whenever the component is drawn: its widget may be another one.
    solara.use_effect(attach, None)
