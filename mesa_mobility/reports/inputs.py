"""Inputs of a run of a model: maps of its people, floor plan, files, preset and population."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from mesa_mobility.crowd.presets.shipped import is_preset_file
from mesa_mobility.plugins.parameters import Parameter
from mesa_mobility.populations import Population
from mesa_mobility.reports.versions import sha256_of


def map_files(model: Any) -> dict[str, dict[str, str | None]]:
    """Name and sha256 of the map file of each type of people, by the type; None for a map made.

    Those of maps for stairs have the names of these maps.
    """
    # Another package's model need not know types.
    used = {kind.name: kind.mobility_map for kind in getattr(model, "pedestrian_types", ())}
    for _, *others in getattr(model, "mobility_maps", ()):
        used |= {each.pedestrian_type: each for each in others}
    found = {}
    for name, map_ in used.items():
        path = map_.file
        found[name] = {
            "file": None if path is None else path.name,
            "sha256": None if path is None else digest_of(path),
        }
    return found


def given_files(taken: Mapping[str, Parameter], values: Mapping[str, Any]) -> dict[str, Path]:
    """Paths of the files that a model's parameters name, by the name of the parameter.

    Args:
        taken: the model's parameters.
        values: the values given, by parameter; other parameters have their defaults.
    """
    found = {}
    for name, parameter in taken.items():
        value = values.get(name, parameter.default)
        if isinstance(value, str | Path) and (
            name == "mobility_map"
            or (name == "preset" and is_preset_file(value))
            or parameter.files is not None
            or Path in parameter.kinds
        ):
            found[name] = Path(value)
    return found


def given_population(taken: Mapping[str, Parameter], values: Mapping[str, Any]) -> Any:
    """The population that a model is made with, as it is given or by default; None without one."""
    known = taken.get("population")
    return values.get("population", known.default) if known is not None else None


def inputs_of(
    model: Any, taken: Mapping[str, Parameter], values: Mapping[str, Any]
) -> dict[str, str]:
    """Every input of a run, by name, with its sha256 where it is a file or a floor plan.

    Args:
        model: the model, or None where it could not be made.
        taken: its parameters.
        values: those given; the others are as by default.
    """
    found = {}
    for name, path in given_files(taken, values).items():
        if path.is_file():
            found[name] = f"{path.name}, sha256 {digest_of(path)}"
    if model is None:
        return found
    for kind, of in map_files(model).items():
        found[f"map of {kind}"] = (
            f"{of['file']}, sha256 {of['sha256']}" if of["file"] else "made by the model"
        )
    # The plane of a building has no GeoJSON of its own.
    if plan := getattr(model, "building", None) or getattr(model, "floor_plan", None):
        text = json.dumps(plan.to_geojson(), sort_keys=True)
        found["floor plan as GeoJSON"] = f"sha256 {hashlib.sha256(text.encode()).hexdigest()}"
    # A model of another package need not have rules.
    if callable(rules := getattr(model, "rules_used", None)):
        found |= rules()
    elif preset := getattr(model, "preset", None):
        found["preset"] = str(preset)
    # A model with a map of its own need not use the population that it has by default.
    given = given_population(taken, values)
    if isinstance(given, str) and len(getattr(model, "pedestrian_types", ())) > 1:
        shares = str(Population.of(given))
        found["population"] = shares if shares == given else f"{given} ({shares})"
    return found


def digest_of(path: Path) -> str:
    """The sha256 of a file, read once while it does not change.

    Raises:
        ResultsError: the file cannot be read.
    """
    try:
        now = path.stat()
    except OSError:
        return sha256_of(path)  # which says what is wrong
    return _digest(path, now.st_mtime_ns, now.st_size)


@lru_cache(maxsize=256)
def _digest(path: Path, changed: int, size: int) -> str:
    return sha256_of(path)
