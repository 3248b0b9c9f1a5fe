"""One run of an experiment, and the row of the store that it gives."""

from __future__ import annotations

import json
import socket
import time
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from os import getpid
from typing import Any

from mesa_mobility.crowd.presets.given import Given
from mesa_mobility.crowd.presets.naming import EXPERIMENT, is_number_name
from mesa_mobility.errors import ModelError
from mesa_mobility.experiments.design.points import Point, point_key, run_name, seed_of_run
from mesa_mobility.experiments.experiment import model_class
from mesa_mobility.experiments.storing.rows import (
    BLOCKED,
    DONE,
    FAILED,
    STALLED,
    TIMED_OUT,
    Row,
)
from mesa_mobility.experiments.workers.figures import (
    figures_by_place,
    figures_of,
    has_pedestrians,
    plain,
)
from mesa_mobility.plugins.parameters import parameters as parameters_of
from mesa_mobility.reports.inputs import inputs_of
from mesa_mobility.runs.jobs import one_line

_LONGEST_ERROR = 500


class TimedOut(Exception):
    """A run has taken longer than its limit."""


@dataclass(frozen=True)
class Setup:
    """What all runs of an experiment share; sent to workers with each batch.

    Attributes:
        model: class, or name of a model.
        seed: of the experiment.
        common_seeds: whether runs of one number have the same seed at all points.
        max_seconds: simulated seconds at most, or None.
        time_limit: seconds of real time at most, or None.
        occupancy: whether rows keep the occupancy.
        trajectories: whether trajectories are written.
        doors: whether rows have figures of doors, rooms, levels, stairs, lifts and clearing times.
        column_types: name of the Arrow type of each parameter.
        store: path or URL.
        may_end: whether the process may be ended where a run does not return to Python in time.
    """

    model: type | str
    seed: int
    common_seeds: bool
    max_seconds: float | None
    time_limit: float | None
    occupancy: bool
    trajectories: bool
    doors: bool
    column_types: dict[str, str]
    store: str
    may_end: bool


def run_once(setup: Setup, point: Point, replication: int) -> tuple[Row, Any]:
    """Run a model at a point; whatever goes wrong is in the row.

    Returns:
        The row, and the model, or None where it could not be made.
    """
    row = first_columns(setup, point, replication)
    wall, cpu = time.perf_counter(), time.process_time()
    model = None
    try:
        with rules_of(point).followed():
            record = setup.trajectories or setup.doors
            # The row has warnings, since a run may be far from those who read them.
            with warnings.catch_warnings(record=True) as said:
                warnings.simplefilter("always", UserWarning)
                model = make_model(setup.model, point, row["seed"], record=record)
            taken = _class(setup.model)[1]
            row["inputs"] = json.dumps(inputs_of(model, taken, point), sort_keys=True)
            row["warning"] = _warning(model, [str(each.message) for each in said])
            _advance(model, setup, wall)
        row["status"] = _status(model)
        row |= figures_of(model, set(row), occupancy=setup.occupancy)
        if setup.doors and has_pedestrians(model):
            row |= figures_by_place(model)
    except TimedOut as error:
        row |= {"status": TIMED_OUT, "error": str(error)}
    except KeyboardInterrupt:
        raise
    # A model of somebody else may fail in any way, and end with SystemExit as a script does.
    except BaseException as error:
        row |= {"status": FAILED, "error": _short(error)}
    row["wall_s"] = time.perf_counter() - wall
    row["cpu_s"] = time.process_time() - cpu
    return row, model


def _status(model: Any) -> str:
    """The status of a run that has ended."""
    if getattr(model, "stalled", False):
        return STALLED
    return BLOCKED if has_pedestrians(model) and model.blocked else DONE


def first_columns(setup: Setup, point: Point, replication: int) -> Row:
    """The columns of a row that are known before the run; it counts as failed until it is not."""
    key = point_key(point)
    return {
        "run": run_name(key, replication),
        "point": key,
        "replication": replication,
        "seed": seed_of_run(setup.seed, None if setup.common_seeds else key, replication),
        "status": FAILED,
        "error": None,
        "began": time.time(),
        "wall_s": 0.0,
        "cpu_s": 0.0,
        "worker": _this_process(getpid()),
        **point,
    }


def _short(error: BaseException) -> str:
    """An error on one line that a file can hold, and not all of a long one."""
    text = plain(one_line(error))
    return text if len(text) <= _LONGEST_ERROR else text[:_LONGEST_ERROR] + "..."


@lru_cache(maxsize=8)
def _this_process(pid: int) -> str:
    return f"{socket.gethostname()}:{pid}"


@lru_cache(maxsize=8)
def _class(model: type | str) -> tuple[type, dict[str, Any]]:
    kind = model_class(model)
    return kind, parameters_of(kind)


def make_model(model: type | str, point: Point, seed: int, *, record: bool = False) -> Any:
    """The model of a run, before its first step. Rules of the point must be followed meanwhile.

    Args:
        model: class, or name of a model.
        point: all parameters.
        seed: of the run.
        record: whether it records its trajectories.
    """
    kind, taken = _class(model)
    keywords: dict[str, Any] = {k: v for k, v in point.items() if not is_number_name(k)}
    for name, value in keywords.items():
        # A text for a parameter that takes none stands for a value, as with --set.
        known = taken.get(name)
        if isinstance(value, str) and known is not None and known.kinds and str not in known.kinds:
            keywords[name] = known.convert(value)
    if record:
        keywords["record"] = True
    made = kind(**keywords, rng=seed)
    if has_pedestrians(made):
        # Those of behaviours that the model has beside its preset's.
        made.set_parameters(rules_of(point).values, EXPERIMENT)
    return made


def rules_of(point: Point) -> Given:
    """The numbers of behaviours at a point."""
    values = {name: value for name, value in point.items() if is_number_name(name)}
    return Given(None, values, EXPERIMENT)


def _advance(model: Any, setup: Setup, began: float) -> None:
    def check(*_: Any) -> None:
        taken = time.perf_counter() - began
        if setup.time_limit is not None and taken > setup.time_limit:
            raise TimedOut(f"took longer than {setup.time_limit:g} s")

    check()
    if has_pedestrians(model):
        with warnings.catch_warnings():
            # The row has it, and is read where the run is not.
            warnings.filterwarnings("ignore", "no behaviour has a weight above 0")
            model.run(max_seconds=setup.max_seconds, progress=check)
        return
    if setup.max_seconds is not None:
        raise ModelError("max_seconds: the model has no simulated seconds, expected none")
    while model.running:
        model.step()
        check()


def _warning(model: Any, said: Sequence[str]) -> str | None:
    """The warnings of a model: those that it gave when it was made, and of its weights."""
    from mesa_mobility.crowd.costs.terms import without_weight

    found: list[str | None] = list(said)
    if has_pedestrians(model):
        found.append(without_weight(model.terms, [each.name for each in model.pedestrian_types]))
    return "; ".join(dict.fromkeys(filter(None, found))) or None
