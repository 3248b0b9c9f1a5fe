"""Distances between crowds: figures of a simulated and a measured one, with an envelope over seeds.

``compare`` takes the runs of several seeds, one or more measured runs and a ``View``, which says
where and when people count.
"""

from mesa_mobility.results.distances.comparison import Comparison, Distance, Envelope, compare
from mesa_mobility.results.distances.functional import (
    projection_coefficient,
    relative_difference,
    secant_cosine,
)
from mesa_mobility.results.distances.replays import PositionErrors, position_errors
from mesa_mobility.results.distances.view import View

__all__ = [
    "Comparison",
    "Distance",
    "Envelope",
    "PositionErrors",
    "View",
    "compare",
    "position_errors",
    "projection_coefficient",
    "relative_difference",
    "secant_cosine",
]
