"""What an experiment is run with, as its store keeps it."""

from __future__ import annotations

import ast
import hashlib
import inspect
from collections.abc import Mapping, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from mesa_mobility.crowd.model_files import is_model_file, path_and_name
from mesa_mobility.errors import MapError, ModelError
from mesa_mobility.experiments.experiment import (
    INDEPENDENT,
    Experiment,
    model_class,
    model_name,
)
from mesa_mobility.plugins.parameters import parameters as parameters_of
from mesa_mobility.populations import Population
from mesa_mobility.reports.inputs import digest_of, given_files, given_population
from mesa_mobility.reports.versions import machine, versions


def session_of(experiment: Experiment, executor: Any) -> dict[str, Any]:
    """What an experiment is run with: versions, maps and model file."""
    return {
        "began": datetime.now(UTC).isoformat(timespec="seconds"),
        "executor": executor if isinstance(executor, str) else type(executor).__name__,
        "machine": machine(),
        "versions": versions(),
        "inputs": _inputs(experiment),
    }


def check_goes_on(store: str, before: Mapping[str, Any], said: Mapping[str, Any]) -> None:
    """Raise ModelError unless an experiment may add its runs to those of a store.

    Args:
        store: its name, for the message.
        before: definition of the experiment whose runs are there.
        said: definition of the one to be run.
    """
    # Stores that were made without a word on seeds hold independent ones.
    before = {"seeds": INDEPENDENT, **before}
    for key in ("model", "seed", "seeds", "max_seconds"):
        if before.get(key) != said.get(key) and not (
            key == "model" and _is_same_file(str(before["model"]), str(said["model"]))
        ):
            raise ModelError(
                f"{store}: holds runs with {key} {before.get(key)}, got {said.get(key)}; "
                "expected another store"
            )


def check_inputs(store: str, sessions: Sequence[Mapping[str, Any]], now: Mapping[str, Any]) -> None:
    """Raise ModelError where a map, model file or source differs from that of earlier runs.

    Args:
        store: its name, for the message.
        sessions: those before.
        now: the session that begins.
    """
    before = {name: digest for each in sessions for name, digest in each["inputs"].items()}
    for name, digest in sorted(now["inputs"].items()):
        if before.get(name, digest) != digest:
            raise ModelError(
                f"{store}: holds runs with another {name} (sha256 {before[name][:16]}...), got "
                f"{digest[:16]}...; expected the same, or another store"
            )


def _is_same_file(one: str, other: str) -> bool:
    """Whether two models are of one file, from wherever; its content is compared elsewhere."""
    if not (is_model_file(one) and is_model_file(other)):
        return False
    (file, name), (other_file, other_name) = path_and_name(one), path_and_name(other)
    return file.name == other_file.name and name == other_name


def _inputs(experiment: Experiment) -> dict[str, str]:
    """The sha256 of the files and the source that results depend on, by name."""
    from mesa_mobility.mobility.mapfile import shipped_map_path

    name = model_name(experiment.model)
    kind = model_class(experiment.model)
    taken = parameters_of(kind)
    files: dict[str, Path] = {}
    sources = {}
    if is_model_file(name):
        files["model file"], _ = path_and_name(name)
    elif ":" in name:  # the others are of installed packages, which have versions
        with suppress(OSError, TypeError):  # of what has been typed at a prompt
            sources["source of the model"] = hashlib.sha256(_source(kind).encode()).hexdigest()
    maps = {"able_bodied"}
    for index in range(len(experiment.design)):
        point = experiment.point(index)
        for given, path in given_files(taken, point).items():
            files[f"{'map' if given == 'mobility_map' else given} {path}"] = path
        with suppress(ModelError):  # which is an error of the runs
            if population := given_population(taken, point):
                maps |= {each for each in Population.of(population).shares if isinstance(each, str)}
    for each in maps:
        with suppress(MapError):
            files[f"map {each}"] = shipped_map_path(each)
    return {label: digest_of(files[label]) for label in sorted(files)} | sources


def _source(kind: type) -> str:
    """The text of a class in its module's file as it is now.

    From Python 3.13 on ``inspect.getsource`` of a class reads the lines where it stood when it
    was imported: other ones, once something above it has changed.
    """
    module = inspect.getmodule(kind)
    if getattr(module, "__file__", None) is None:  # a notebook keeps the text of its cells
        return inspect.getsource(kind)
    text = inspect.getsource(module)  # type: ignore[arg-type]
    body: list[ast.stmt] = ast.parse(text).body
    for name in kind.__qualname__.split("."):
        found = [node for node in body if isinstance(node, ast.ClassDef) and node.name == name]
        if not found:  # made by a call, or inside a function
            return inspect.getsource(kind)
        body = found[-1].body
    node = found[-1]
    first = min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)])
    return "".join(text.splitlines(keepends=True)[first - 1 : node.end_lineno])
