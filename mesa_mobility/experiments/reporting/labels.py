"""What parameters and figures are called in the report of an experiment."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from typing import TYPE_CHECKING

from mesa_mobility.crowd.presets.naming import number_named
from mesa_mobility.errors import MobilityError
from mesa_mobility.experiments.experiment import model_class
from mesa_mobility.plugins.parameters import descriptions

if TYPE_CHECKING:
    from mesa_mobility.experiments.experiment import Experiment

_UNITS = {
    "metres": "m",
    "seconds": "s",
    "m/s": "m/s",
    "persons/m2": "persons/m²",
    "degrees": "degrees",
}

_UNIT = re.compile(rf"(?:^|, |\bin )({'|'.join(map(re.escape, _UNITS))})(?=[;,.]? |[;,.]?$)")
"""The unit in the description of a parameter: "width of both doors, metres."."""


def labels_of(experiment: Experiment) -> dict[str, str]:
    """Labels by column: those that the experiment gives, else parameters with their units."""
    meant = meanings_of(experiment)
    found = {}
    for name in (*experiment.fixed, *experiment.design.column_types()):
        unit = _unit_of_number(name) if "." in name else _unit_said(meant.get(name, ""))
        if unit:
            found[name] = f"{name.replace('.', ' ').replace('_', ' ')} ({unit})"
    return found | dict(experiment.report.labels)


def meanings_of(experiment: Experiment) -> Mapping[str, str]:
    """What each parameter means, as the model's documentation says; empty if not installed."""
    with suppress(MobilityError):
        return descriptions(model_class(experiment.model))
    return {}


def _unit_said(meaning: str) -> str:
    found = _UNIT.search(meaning)
    return _UNITS[found.group(1)] if found else ""


def _unit_of_number(name: str) -> str:
    with suppress(MobilityError):
        known = number_named(name)
        if known is not None and known.range is not None:
            return known.range.unit
    return ""
