"""Rules in the report of a run: parameters of the model, and behaviours with their numbers."""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

from mesa_mobility.crowd.model_files import find_model
from mesa_mobility.crowd.presets.naming import numbers_of
from mesa_mobility.errors import MobilityError
from mesa_mobility.plugins.parameters import descriptions
from mesa_mobility.plugins.registry import load_behavior
from mesa_mobility.reports.html import Page
from mesa_mobility.reports.run.texts import in_words


def add_parameters(page: Page, model: str, given: Mapping[str, Any]) -> None:
    """Add the parameters of a model with their meaning.

    Args:
        page: to add them to.
        model: its name.
        given: values by parameter.
    """
    if not given:
        return
    meant = meanings(model)
    page.table(
        f"Parameters of the model “{in_words(model)}”",
        ["parameter", "value", "meaning"],
        [[in_words(name), said(value), meant.get(name, "")] for name, value in given.items()],
    )


def add_rules(
    page: Page, rules: Mapping[str, Any], added: Sequence[str] = (), changed: str = ""
) -> None:
    """Add the behaviours of a preset with what they do and their numbers.

    Args:
        page: to add them to.
        rules: as the summary of a run has them.
        added: names of behaviours beside the preset.
        changed: a sentence on the numbers that are not those of the preset.
    """
    if not rules:
        return
    settings = rules.get("settings") or {}
    rows = [
        [*_named(name), f"weight\N{NO-BREAK SPACE}{weight:g}", _numbers(name, settings.get(name))]
        for name, weight in (rules.get("terms") or {}).items()
    ]
    parts = [(name, "tactic") for name in rules.get("tactics") or ()]
    if rules.get("target_choice"):
        parts.append((rules["target_choice"], "choice of exit"))
    rows += [[*_named(name), part, _numbers(name, settings.get(name))] for name, part in parts]
    rows += [[*_named(name), "added to the preset", ""] for name in added]
    page.table(
        f"Behaviour of the people: preset “{rules.get('name', '-')}”",
        ["behaviour", "what it does", "part", "numbers that the preset sets"],
        rows,
        f"{changed} People choose the movement with the least sum of costs; a weight is the factor "
        "of a cost in this sum. Before that, tactics say where and how fast they want to go. The "
        "documentation of mesa-mobility defines each behaviour and compares the preset with "
        "measured crowds (“Verification and validation”, “Known limits”).".strip(),
    )


def meanings(model: str) -> dict[str, str]:
    """What each parameter of a model means, as its documentation says; empty if not installed."""
    with suppress(MobilityError):
        return descriptions(find_model(model))
    return {}


def said(value: Any) -> str:
    """A value of a parameter as a reader expects it."""
    if value is None:
        return "not given"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _named(name: str) -> tuple[str, str]:
    """A behaviour in words, and the first sentence of its documentation."""
    label, _, weight = name.partition("=")
    words = in_words(label) + (f" (weight {weight})" if weight else "")
    with suppress(MobilityError):
        text = inspect.getdoc(load_behavior(label.partition("[")[0])) or ""
        return words, " ".join(text.split("\n\n")[0].split())
    return words, ""


def _numbers(name: str, values: Mapping[str, Any] | None) -> str:
    """Settings of a behaviour with their units."""
    units: dict[str, str] = {}
    with suppress(MobilityError):
        known = numbers_of(load_behavior(name.partition("[")[0]))
        units = {key: each.range.unit for key, each in known.items() if each.range is not None}
    return "; ".join(
        f"{in_words(key)} {said(value)} {units.get(key, '')}".strip()
        for key, value in (values or {}).items()
    )
