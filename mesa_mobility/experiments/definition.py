"""Experiments as files: TOML that people write, and the JSON that stores keep and reports print."""

from __future__ import annotations

import json
import os
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from mesa_mobility.crowd.model_files import is_model_file
from mesa_mobility.errors import ModelError
from mesa_mobility.experiments.convergence import OccupancyConvergence, Precision
from mesa_mobility.experiments.design.designs import (
    Design,
    Grid,
    LatinHypercube,
    SobolSequence,
    Table,
)
from mesa_mobility.experiments.design.sensitivity import MorrisTrajectories, SaltelliSamples
from mesa_mobility.experiments.experiment import Experiment, model_name
from mesa_mobility.experiments.report_options import ReportOptions
from mesa_mobility.plugins.registry import did_you_mean

_SCALARS = (
    "name",
    "model",
    "seed",
    "seeds",
    "replications",
    "max_seconds",
    "time_limit",
    "keep",
)
_TABLES = ("fixed", "precision", "report")
_SESSION = {"began": str, "executor": str, "machine": str, "versions": dict, "inputs": dict}
_DESIGNS: dict[str, Callable[[Any], Design]] = {
    Grid.kind: Grid,
    Table.kind: Table,
    LatinHypercube.kind: lambda values: LatinHypercube(**values),
    SobolSequence.kind: lambda values: SobolSequence(**values),
    SaltelliSamples.kind: lambda values: SaltelliSamples(**values),
    MorrisTrajectories.kind: lambda values: MorrisTrajectories(**values),
}


def read_experiment(path: str | os.PathLike[str]) -> Experiment:
    """Read an experiment from a file: TOML, or JSON as reports print it if its name ends so.

    A model in a Python file is looked for beside this file, and is known by its whole path, so that
    the definition means the same elsewhere.

    Raises:
        ModelError: no such file, neither TOML nor JSON, or not an experiment.
    """
    file = Path(path)
    form, loads = ("JSON", json.loads) if file.suffix == ".json" else ("TOML", tomllib.loads)
    try:
        values = loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise ModelError(f"{file}: no such file, expected an experiment in {form}") from None
    except OSError as error:
        raise ModelError(f"{file}: cannot be read: {error.strerror or error}") from error
    # Beside its own error the reader lets through those of numbers and nesting without end.
    except (ValueError, RecursionError) as error:
        raise ModelError(f"{file}: is not {form}: {' '.join(str(error).split())}") from error
    if not isinstance(values, dict):
        raise ModelError(f"{file}: is not an experiment, expected an object in JSON")
    model = values.get("model")
    if isinstance(model, str) and is_model_file(model):
        values["model"] = os.fspath((file.parent / model).absolute())
    try:
        return from_definition(values)
    except ModelError as error:
        raise ModelError(f"{file}: {error}") from error


def from_definition(values: Mapping[str, Any]) -> Experiment:
    """An experiment from what a file says.

    Raises:
        ModelError: an unknown key, a missing or wrong value, or several designs.
    """
    known = [*_SCALARS, *_TABLES, *_DESIGNS]
    for key in values:
        if key not in known:
            raise ModelError(
                f"unknown key {key!r}{did_you_mean(key, dict.fromkeys(known))}; "
                f"expected {', '.join(known)}"
            )
    if not isinstance(values.get("model"), str):
        raise ModelError(f"model is {values.get('model')!r}, expected the name of a model")
    given = [kind for kind in _DESIGNS if kind in values]
    if len(given) > 1:
        raise ModelError(f"has the designs {' and '.join(given)}, expected one")
    for key in (*_TABLES, *given):
        wanted: type = list if key == Table.kind else dict
        if not isinstance(values.get(key, wanted()), wanted):
            raise ModelError(f"{key}: expected {'tables' if wanted is list else 'a table'}")
    keywords: dict[str, Any] = {key: values[key] for key in _SCALARS if key in values}
    keywords["fixed"] = values.get("fixed", {})
    keywords["precision"] = _made("precision", _precision, values.get("precision", {}))
    report = values.get("report", {})
    keywords["report"] = _made("report", lambda each: ReportOptions(**each), report)
    if given:
        keywords["parameters"] = _made(given[0], _DESIGNS[given[0]], values[given[0]])
    return Experiment(**keywords)


def check_definition(values: Mapping[str, Any]) -> None:
    """Raise KeyError or TypeError where what a store keeps lacks something."""
    if not isinstance(values["experiment"], dict) or not values["sessions"]:
        raise TypeError("expected an experiment and its sessions")
    for session in values["sessions"]:
        for key, kind in _SESSION.items():
            if not isinstance(session[key], kind):
                raise TypeError(f"{key} is {session[key]!r}")


def to_definition(experiment: Experiment) -> dict[str, Any]:
    """What a file says of an experiment; ``from_definition`` makes the same one of it."""
    said: dict[str, Any] = {key: getattr(experiment, key) for key in _SCALARS}
    said["model"] = model_name(experiment.model)
    said["keep"] = list(experiment.keep)
    said["fixed"] = dict(experiment.fixed)
    said["precision"] = experiment.precision.definition()
    said["report"] = experiment.report.definition()
    said[experiment.design.kind] = experiment.design.definition()
    return said


def _precision(values: Mapping[str, Any]) -> Precision:
    keywords = dict(values)
    occupancy = keywords.pop("occupancy", {})
    if occupancy is not False and not isinstance(occupancy, dict):
        raise ModelError(f"occupancy is {occupancy!r}, expected a table or false")
    curve = None if occupancy is False else OccupancyConvergence(**occupancy)
    return Precision(occupancy=curve, **keywords)


def _made(key: str, maker: Callable[[Any], Any], values: Any) -> Any:
    try:
        return maker(values)
    except TypeError as error:
        # Python's own words for a missing or unknown keyword say which.
        raise ModelError(f"{key}: {str(error).partition('() ')[2] or error}") from error
