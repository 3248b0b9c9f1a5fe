"""The query of a page's address: the run's key, and how the run was set up."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from urllib.parse import parse_qsl, urlencode

import solara

from mesa_mobility.crowd.costs.terms import is_weight

SET, WEIGHT, OFF = "set.", "weight.", ",off"


@dataclass(frozen=True)
class Start:
    """The settings in a page's address.

    Attributes:
        run: key of the run to continue, or "".
        model: name of the model, or "" for the page's own.
        texts: by name, the texts of parameters that differ from their defaults.
        behaviours: name -> (on, weight) of behaviours that were changed.
        choice: name of the target choice if it was changed, or "".
    """

    run: str = ""
    model: str = ""
    texts: Mapping[str, str] = field(default_factory=dict)
    behaviours: Mapping[str, tuple[bool, float]] = field(default_factory=dict)
    choice: str = ""


def read(query: str) -> Start:
    """The settings in the query of an address; unknown parts are ignored."""
    found: dict[str, str] = {}
    texts: dict[str, str] = {}
    behaviours: dict[str, tuple[bool, float]] = {}
    for name, value in parse_qsl(query, keep_blank_values=True):
        if name.startswith(SET):
            texts[name.removeprefix(SET)] = value
        elif name.startswith(WEIGHT):
            try:
                weight = float(value.removesuffix(OFF))
            except ValueError:
                continue
            if is_weight(weight):
                behaviours[name.removeprefix(WEIGHT)] = (not value.endswith(OFF), weight)
        else:
            found[name] = value
    return Start(
        found.get("run", ""), found.get("model", ""), texts, behaviours, found.get("where", "")
    )


def write(start: Start) -> str:
    """The query of an address from which ``read`` gives the same settings."""
    pairs = {"run": start.run, "model": start.model, "where": start.choice}
    parts = [(name, value) for name, value in pairs.items() if value]
    parts += [(f"{SET}{name}", text) for name, text in start.texts.items()]
    parts += [
        (f"{WEIGHT}{name}", f"{weight!r}{'' if on else OFF}")
        for name, (on, weight) in start.behaviours.items()
    ]
    return urlencode(parts)


@solara.component_vue("address.vue")
def _Address(query: str) -> None: ...


@solara.component
def Address(query: str) -> None:
    """Show a query in the browser's address, without an entry in its history."""
    _Address(query=query)
