"""Feeds: values that go to a widget many times a second, without rendering the page.

With a reactive value Solara renders the whole page, which takes some milliseconds in the thread of
the run. A feed writes to one property of one widget.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import solara
from ipywidgets import Widget


class Feed:
    """Sends values to one property of a widget.

    Args:
        name: the property's name.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._value: dict[str, Any] = {}
        self._widget: Widget | None = None
        # The run writes while the page is rendered: the last value must be the last one sent.
        self._lock = threading.RLock()

    @property
    def value(self) -> dict[str, Any]:
        """The last value written."""
        return self._value

    def set(self, value: dict[str, Any]) -> None:
        """Write to the widget, or keep the value until there is one."""
        with self._lock:
            self._value = value
            if self._widget is not None:
                setattr(self._widget, self._name, value)

    def attach(self, widget: Widget | None) -> None:
        """Write to this widget from now on; None detaches the feed."""
        with self._lock:
            self._widget = widget
            if widget is not None:
                setattr(widget, self._name, self._value)


@solara.component
def Fed(feed: Feed, canvas: Callable[..., solara.Element], **properties: Any) -> solara.Element:
    """A canvas to whose widget a feed writes.

    The canvas is the root of this component. A container whose arguments equal the previous ones is
    not rendered again and keeps its old element, so the widget of a new one could not be found.

    Args:
        feed: writes to the property of its name.
        canvas: makes the element.
        properties: arguments of ``canvas``, without the one that the feed writes.
    """
    element = canvas(**properties)

    def attach() -> Callable[[], None]:
        feed.attach(solara.get_widget(element))
        return lambda: feed.attach(None)

    # Each time the component is rendered: its widget may be another one.
    solara.use_effect(attach, None)
    return element
