"""Distributions that speeds and times are drawn from, built or read from a text.

A crowd is drawn in strata: its members share out the distribution among them, so that even a
small crowd has the spread of the distribution. Runs differ in which people are fast, not in how
many. SciPy is loaded when the first one is drawn.
"""

from mesa_mobility.distributions.base import Distribution
from mesa_mobility.distributions.empirical import Empirical
from mesa_mobility.distributions.parametric import (
    Constant,
    Gamma,
    LogNormal,
    Normal,
    TruncatedNormal,
    Uniform,
    Weibull,
)
from mesa_mobility.distributions.texts import parse

__all__ = [
    "Constant",
    "Distribution",
    "Empirical",
    "Gamma",
    "LogNormal",
    "Normal",
    "TruncatedNormal",
    "Uniform",
    "Weibull",
    "parse",
]
