"""Files of presets: TOML that people write, and that calibrations and estimates write."""

from __future__ import annotations

import math
import os
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import Any

from mesa_mobility.crowd.presets.naming import WEIGHT, named
from mesa_mobility.crowd.presets.preset import Preset
from mesa_mobility.crowd.presets.provenance import Provenance
from mesa_mobility.errors import MobilityError, ModelError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.plugins.registry import did_you_mean
from mesa_mobility.schema import Flag, Kind, Real, Several, Text, Whole, check

SUFFIX = ".toml"

MOST_BYTES = 1_000_000
"""Of a file; those that ship have a thousand."""

_REQUIRED: dict[str, Kind] = {
    "name": Text(),
    "target_choice": Text(),
    "tactics": Several(Text()),
    "durations": Several(Whole(1)),
    "hard_bodies": Flag(),
    "terms": Several(Text(), dict, values=Real()),
}
_OPTIONAL: dict[str, Kind] = {
    "group_pace": Text(),
    "shares": Several(Several(Real(0.0, 1.0))),
    "most_acceleration": Real(0.0),
    "settings": Several(Text(), dict, values=Several(Text(), dict)),
    "provenance": Several(Text(), dict),
}
_ABSENT: dict[str, Any] = {"group_pace": None, "shares": (), "most_acceleration": None}
_PROVENANCE = ("date", "command", "data", "likelihoods", "figures")


def read_preset(path: str | os.PathLike[str]) -> Preset:
    """Read a preset from a TOML file, and look at all that it says.

    Raises:
        ModelError: no such file, no TOML, an unknown, missing or wrong entry, a behaviour that is
            not installed, or a number out of range.
    """
    file = Path(path)
    try:
        size = file.stat().st_size
        if size > MOST_BYTES:
            raise ModelError(f"{file}: has {size} bytes, expected at most {MOST_BYTES}")
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise ModelError(f"{file}: no such file, expected a preset in TOML") from None
    except OSError as error:
        raise ModelError(f"{file}: cannot be read: {error.strerror or error}") from error
    except ValueError as error:
        raise ModelError(f"{file}: is not TOML: {' '.join(str(error).split())}") from error
    preset = parse_preset(text, f"{file}", file.name)
    try:
        preset.behaviours()
    except MobilityError as error:
        raise ModelError(f"{file}: {error}") from error
    return preset


def parse_preset(text: str, where: str, source: str) -> Preset:
    """The preset that a TOML text describes; its behaviours are not looked for.

    Args:
        text: the content of a file.
        where: its name, for errors.
        source: of the preset's numbers.

    Raises:
        ModelError: no TOML, or an unknown, missing or wrong entry.
    """
    try:
        values = tomllib.loads(text)
    # Beside its own error the reader lets through those of numbers and nesting without end.
    except (ValueError, RecursionError) as error:
        raise ModelError(f"{where}: is not TOML: {' '.join(str(error).split())}") from error
    known = {**_REQUIRED, **_OPTIONAL}
    _check_names(values, list(known), where)
    for name in _REQUIRED:
        if name not in values:
            raise ModelError(f"{where}: has no {name}, expected {', '.join(_REQUIRED)}")
    for name, value in values.items():
        check(value, known[name], f"{where}: {name}", error=ModelError)
    given = _ABSENT | values
    given["provenance"] = _provenance(values.get("provenance"), where)
    try:
        preset = Preset(**given)
    except ModelError as error:
        raise ModelError(f"{where}: {error}") from error
    return replace(preset, origin=(source, preset.said))


def _provenance(values: Mapping[str, Any] | None, where: str) -> Provenance | None:
    if values is None:
        return None
    _check_names(values, _PROVENANCE, f"{where}: provenance")
    given = dict(values)
    if type(given.get("date")) is date:
        given["date"] = given["date"].isoformat()
    try:
        return Provenance(**given)
    except ModelError as error:
        raise ModelError(f"{where}: {error}") from error


def _check_names(values: Mapping[str, Any], known: list[str] | tuple[str, ...], where: str) -> None:
    for name in values:
        if name not in known:
            meant = did_you_mean(name, dict.fromkeys(known)) or f", expected {', '.join(known)}"
            raise ModelError(f"{where}: unknown entry {name!r}{meant}")


def write_preset(preset: Preset, path: str | os.PathLike[str]) -> None:
    """Write a preset as a TOML file that ``read_preset`` reads, with all numbers that it has.

    Numbers that the preset leaves as a behaviour has them are written, too: the file means the same
    if the behaviour gets other defaults.

    Raises:
        ModelError: the file cannot be written, its name does not end with .toml, a behaviour is
            not installed, or a setting is none that TOML can hold.
    """
    file = Path(path)
    if file.suffix != SUFFIX:
        raise ModelError(f"{file}: expected a name that ends with {SUFFIX}")
    text = preset_text(preset)
    with replacing(file, ModelError) as temporary:
        temporary.write_text(text, encoding="utf-8")


def preset_text(preset: Preset) -> str:
    """A preset as TOML.

    Raises:
        ModelError: a behaviour is not installed, or a setting is none that TOML can hold.
    """
    import tomli_w

    values = {key: value for key, value in preset.numbers().items() if value is not None}
    values.pop("settings")
    values["terms"] = values.pop("terms")  # tables come last
    settings: dict[str, dict[str, Any]] = {name: dict(of) for name, of in preset.settings.items()}
    for name, made, parameter in named(preset.behaviours()):
        behaviour, _, setting = name.partition(".")
        value = getattr(made, parameter.name)
        if setting != WEIGHT and value is not None:
            settings.setdefault(behaviour, {})[setting] = value
    for name, of in settings.items():
        for setting, value in of.items():
            _check_plain(f"{name}.{setting}", value)
    values |= {"settings": settings} if settings else {}
    if preset.provenance is not None:
        values["provenance"] = _provenance_table(preset.provenance)
    return tomli_w.dumps(values)


def _provenance_table(of: Provenance) -> dict[str, Any]:
    table: dict[str, Any] = {"command": of.command} if of.command else {}
    if of.date:
        table["date"] = date.fromisoformat(of.date)
    for name in ("data", "likelihoods", "figures"):
        if values := dict(getattr(of, name)):
            table[name] = values
    return table


def _check_plain(name: str, value: Any) -> None:
    if isinstance(value, list | tuple) and all(isinstance(each, str) for each in value):
        return
    if not isinstance(value, int | float | str) or (isinstance(value, float) and math.isnan(value)):
        raise ModelError(f"{name}: {value!r:.60} cannot be written, expected a number or texts")
