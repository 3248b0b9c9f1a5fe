"""The dashboard: a page on which to try and watch behaviours.

Needs the extra ``viz``. Names are imported when they are first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesa_mobility._lazy import names_of

if TYPE_CHECKING:
    from mesa_mobility.dashboard.app import Dashboard as Dashboard
    from mesa_mobility.dashboard.solara_viz import make_crowd_view as make_crowd_view

# Mesa's visualization takes a second to load; the dashboard does without.
__getattr__, __dir__ = names_of(__name__, __file__)
