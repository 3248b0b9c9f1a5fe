"""What an experiment is run with, as its store keeps it."""

from __future__ import annotations

import hashlib
import inspect
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from mesa_mobility.experiments.experiment import Experiment, model_class, model_name
from mesa_mobility.plugins.model_files import is_model_file
from mesa_mobility.reports.versions import machine, sha256_of, versions


def session_of(experiment: Experiment, executor: Any) -> dict[str, Any]:
    """What an experiment is run with: versions, maps and model file."""
    return {
        "began": datetime.now(UTC).isoformat(timespec="seconds"),
        "executor": executor if isinstance(executor, str) else type(executor).__name__,
        "machine": machine(),
        "versions": versions(),
        "inputs": _inputs(experiment),
    }


def _inputs(experiment: Experiment) -> dict[str, str]:
    """The sha256 of the files and the source that results depend on, by name."""
    from mesa_mobility.mobility.mapfile import shipped_map_path

    files = {"map able_bodied": shipped_map_path("able_bodied")}
    name = model_name(experiment.model)
    kind = model_class(experiment.model)
    sources = {}
    if is_model_file(name):
        files["model file"] = Path(name.partition(".py")[0] + ".py")
    elif ":" in name:  # the others are of installed packages, which have versions
        with suppress(OSError, TypeError):  # of what has been typed at a prompt
            source = inspect.getsource(kind)
            sources["source of the model"] = hashlib.sha256(source.encode()).hexdigest()
    design = experiment.design
    maps = {experiment.fixed.get("mobility_map")}
    if "mobility_map" in design.column_types():
        maps |= {design[index]["mobility_map"] for index in range(len(design))}
    for path in sorted(str(each) for each in maps if isinstance(each, str)):
        files[f"map {path}"] = Path(path)
    return {label: sha256_of(file) for label, file in files.items()} | sources
