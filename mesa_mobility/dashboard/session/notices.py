"""Warnings that a model gives, shown on the page that made it."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable
from typing import Any

_listeners = threading.local()


def hear(listener: Callable[[str], None]) -> None:
    """Call `listener` with the text of every warning given in this thread from now on."""
    _listeners.of_thread = listener


def hand_out_warnings() -> None:
    """Give the listener of a thread its warnings, each time; other threads' are shown as before."""
    show = warnings.showwarning

    def hand_out(message: Warning | str, *where: Any, **more: Any) -> None:
        listener = getattr(_listeners, "of_thread", None)
        if listener is None:
            show(message, *where, **more)
        else:
            listener(" ".join(str(message).split()))

    warnings.showwarning = hand_out
    warnings.simplefilter("always", UserWarning)
