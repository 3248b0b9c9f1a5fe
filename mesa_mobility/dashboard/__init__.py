"""The dashboard: a page on which a behaviour is tried, watched and understood.

Needs the extra ``viz``. Names are imported when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mesa_mobility.dashboard.app import Dashboard
    from mesa_mobility.dashboard.solara_viz import make_crowd_view

_MODULES = {"Dashboard": "app", "make_crowd_view": "solara_viz"}

__all__ = ["Dashboard", "make_crowd_view"]


def __getattr__(name: str) -> Any:
    # Mesa's visualization takes a second to load; the dashboard does without.
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
