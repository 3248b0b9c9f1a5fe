"""The parameters of a model that a page sets, and their conversion from text."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from mesa_mobility import PedestrianModel
from mesa_mobility.crowd import PRESETS
from mesa_mobility.dashboard.session.run_config import Recipe
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.annotations import Files
from mesa_mobility.plugins.parameters import NOT_SETTABLE, Parameter, parameters

SEED = Parameter("rng", (int,), 1)

MAPS = Files("*.npz")

FOLDER = Path.cwd()
"""Folder of the files offered: where the dashboard was started. A page cannot name another."""

ASK_ABOVE = 10_000
"""Numbers above it are confirmed first: so large a crowd takes minutes to make."""

COMMON = {
    "rng": "seed of all random numbers: the same one gives the same run",
    "preset": "rules and weights of decisions: the default ones, or those of the paper",
    "mobility_map": "movements that people are made of: a map of this folder",
    "population": 'types of people, as "mixed" or "able_bodied: 0.9, child: 0.1"',
    "frames_per_step": "frames of 1/30 s that one step advances",
}
"""What parameters of all models are for, where a model's docstring does not say it."""

AT_MOST = 1_000_000
"""Greatest whole number accepted: a million people take some gigabytes."""


def settable(kind: type[PedestrianModel], given: Iterable[str] = ()) -> dict[str, Parameter]:
    """The parameters that the page sets, with preset, map and seed if the model has them.

    Args:
        kind: the model's class.
        given: names of parameters that the page does not set.
    """
    found = {}
    for name, parameter in parameters(kind).items():
        if name in given or name == "record":
            continue
        files = MAPS if name == "mobility_map" else parameter.files
        if name == "rng":
            found[name] = SEED
        elif name == "preset":
            found[name] = Parameter(name, (tuple(PRESETS),), parameter.default)
        elif files is not None:
            names = offered_files(files)
            if names:
                choices = (shown(parameter.default), *names)
                found[name] = Parameter(name, (choices,), parameter.default, files=files)
        # A page cannot read other files of the server.
        elif parameter.kinds and Path not in parameter.kinds:
            found[name] = parameter
    # The model's own parameters come first, those of all models last.
    return dict(sorted(found.items(), key=lambda item: item[0] in NOT_SETTABLE))


def offered_files(files: Files) -> list[str]:
    """Names of such files in the folder that the dashboard was started in."""
    found = {each.name for pattern in files.patterns for each in FOLDER.glob(pattern)}
    return sorted(name for name in found if (FOLDER / name).is_file())


def shown(value: Any) -> str:
    """The text that `Parameter.convert` turns into this value."""
    if value is inspect.Parameter.empty:
        return ""
    return "none" if value is None else str(value)


def value_of(parameter: Parameter, text: str) -> Any:
    """The value that a text stands for on a page.

    Raises:
        ModelError: the text is not what the parameter takes.
    """
    if parameter.files is not None:
        if text == shown(parameter.default):
            return parameter.default
        return str(FOLDER / parameter.convert(text))
    value = parameter.convert(text)
    most = max(AT_MOST, *_known(parameter))
    if isinstance(value, int) and parameter is not SEED and value > most:
        raise ModelError(f"{parameter.name}: got {value}, expected at most {most} on this page")
    return value


def problems(known: Mapping[str, Parameter], texts: Mapping[str, str]) -> dict[str, str]:
    """Error messages of texts, by name of the parameter."""
    found = {}
    for name, text in texts.items():
        try:
            value_of(known[name], text)
        except ModelError as error:
            found[name] = str(error)
    return found


def recipe_of(
    kind: type[PedestrianModel], texts: Mapping[str, str], given: Mapping[str, Any] | None = None
) -> Recipe:
    """The recipe for a model from texts by name of the parameter.

    Args:
        kind: the model's class.
        texts: values that the page sets.
        given: values that it does not set.

    Raises:
        ModelError: a text is not what its parameter takes.
    """
    given = given or {}
    known = settable(kind, given)
    return Recipe(kind, {**given, **{name: value_of(known[name], texts[name]) for name in texts}})


def large(known: Mapping[str, Parameter], recipe: Recipe) -> dict[str, Any]:
    """Values that must be confirmed before the model is made, by name of the parameter."""
    return {
        name: value
        for name, value in recipe.keywords.items()
        if name in known
        and known[name] is not SEED
        and type(value) in (int, float)
        and value > max(ASK_ABOVE, *_known(known[name]))
    }


def blamed(message: str, names: Iterable[str]) -> list[str]:
    """The parameters that the beginning of an error message names."""
    head, colon, _ = message.partition(":")
    words = head.replace(",", " ").split()
    return [name for name in names if name in words] if colon else []


def _known(parameter: Parameter) -> list[float]:
    """Numbers that the annotations say the parameter takes."""
    default = parameter.default if type(parameter.default) in (int, float) else 0.0
    return [default, (parameter.range.high if parameter.range else None) or 0.0]
