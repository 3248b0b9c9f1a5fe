"""Functions by their names, so that other processes and later sessions find them."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from importlib import import_module
from pathlib import Path
from typing import Any

from mesa_mobility.crowd.model_files import find_model
from mesa_mobility.errors import ModelError
from mesa_mobility.reports.versions import sha256_of

_PLAIN = (bool, int, float, str, type(None))

MOST_TEXT = 20_000
"""Characters of measured values that are given as they are: every row of the store repeats them."""


def name_of(function: Any, what: str) -> str:
    """The text by which ``called`` finds a function again, with the arguments of a partial.

    Args:
        function: a function or class of a module, or a ``functools.partial`` of one.
        what: what the function is, for errors.

    Raises:
        ModelError: the function cannot be found by a name, or has arguments that are not plain.
    """
    inner, arguments, keywords = function, [], {}
    if isinstance(function, partial):
        inner, arguments, keywords = function.func, list(function.args), dict(function.keywords)
    module, name = getattr(inner, "__module__", None), getattr(inner, "__qualname__", "")
    if not callable(inner) or module is None or not name or _looked_up(module, name) != inner:
        raise ModelError(
            f"{what}: {name or repr(inner)[:60]} cannot be found by its name, expected a function "
            "or class of a module, or a functools.partial of one"
        )
    for value in (*arguments, *keywords.values()):
        if not _is_plain(value):
            raise ModelError(
                f"{what}: {name} is given {value!r:.60}, expected numbers, texts and lists of them"
            )
    given = [arguments, keywords] if arguments or keywords else []
    return f"{module}:{name}" + (f" {json.dumps(given, sort_keys=True)}" if given else "")


def called(text: str) -> Callable[..., Any]:
    """The function that ``name_of`` has named.

    Raises:
        ModelError: there is none.
    """
    found, _, given = text.partition(" ")
    module, _, name = found.partition(":")
    function = _looked_up(module, name)
    if function is None:
        raise ModelError(f"{found}: cannot be imported, expected MODULE:NAME")
    if given:
        arguments, keywords = json.loads(given)
        return partial(function, *arguments, **keywords)
    return function


def scenario_name(scenario: Any, what: str) -> str:
    """The text for a scenario: a function, or the name of a model.

    Raises:
        ModelError: neither.
    """
    if isinstance(scenario, str):
        find_model(scenario)
        return f"model {scenario}"
    return name_of(scenario, what)


@dataclass(frozen=True)
class Measured:
    """Measured data, as a text that other processes read.

    Attributes:
        text: JSON of a file's path, of the name of a function that gives the data, or of the data.
        files: sha256 of the files that these are in, by name.
    """

    text: str
    files: dict[str, str]


def measured_of(data: Any, what: str) -> Measured:
    """Measured data by name.

    Args:
        data: the path of a file, which distances get as a ``Path``; a function without arguments,
            or a ``functools.partial``, that gives the data; or numbers, texts, and lists and
            dictionaries of them.
        what: they are, for errors.

    Raises:
        ModelError: something else, or a file that cannot be read.
        ResultsError: a file that cannot be read.
    """
    if isinstance(data, Path):
        path = data.absolute()
        return Measured(json.dumps({"file": str(path)}), {path.name: sha256_of(path)})
    if callable(data):
        given = data.args + tuple(data.keywords.values()) if isinstance(data, partial) else ()
        paths = [Path(each) for each in given if isinstance(each, str) and Path(each).is_file()]
        files = {path.name: sha256_of(path) for path in paths}
        return Measured(json.dumps({"from": name_of(data, what)}), files)
    try:
        text = json.dumps({"value": data}, allow_nan=False)
    except (TypeError, ValueError):
        raise ModelError(
            f"{what}: got {data!r:.60}, expected a Path, a function, or numbers, texts, and lists "
            "and dictionaries of them"
        ) from None
    if len(text) > MOST_TEXT:
        raise ModelError(
            f"{what}: has {len(text)} characters, expected at most {MOST_TEXT}, or a Path or a "
            "function that reads more"
        )
    return Measured(text, {})


@lru_cache(maxsize=32)
def measured(text: str) -> Any:
    """The measured data of a text, read once in each process."""
    ((kind, value),) = json.loads(text).items()
    if kind == "file":
        return Path(value)
    return called(value)() if kind == "from" else value


def _looked_up(module: str, name: str) -> Any:
    try:
        found = import_module(module)
        for part in name.split("."):
            found = getattr(found, part)
    except (ImportError, AttributeError, ValueError):
        return None
    return found


def _is_plain(value: Any) -> bool:
    if isinstance(value, list | tuple):
        return all(_is_plain(each) for each in value)
    return isinstance(value, _PLAIN)
