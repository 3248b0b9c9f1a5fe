"""One run of an experiment, and the row of the store that it gives."""

from __future__ import annotations

import json
import math
import socket
import time
import warnings
from collections.abc import Mapping, Sequence
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
    SERIES,
    STALLED,
    TIMED_OUT,
    Row,
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
        doors: whether rows have figures of doors, rooms and clearing times.
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
        row |= _figures(model, set(row), occupancy=setup.occupancy)
        if setup.doors and _has_pedestrians(model):
            row |= _of_places(model)
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
    return BLOCKED if _has_pedestrians(model) and model.blocked else DONE


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
    text = _plain(one_line(error))
    return text if len(text) <= _LONGEST_ERROR else text[:_LONGEST_ERROR] + "..."


def _plain(text: str) -> str:
    """A text that files can hold; names of files may have bytes that are no letters."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


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
    if _has_pedestrians(made):
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
    if _has_pedestrians(model):
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
    if _has_pedestrians(model):
        found.append(without_weight(model.terms, [each.name for each in model.pedestrian_types]))
    return "; ".join(dict.fromkeys(filter(None, found))) or None


def _has_pedestrians(model: Any) -> bool:
    from mesa_mobility.crowd import PedestrianModel

    return isinstance(model, PedestrianModel)


def _figures(model: Any, taken: set[str], *, occupancy: bool) -> Row:
    """Figures of a run: its summary, or else the last values that it has collected."""
    if hasattr(model, "summary"):
        summary: Mapping[str, Any] = model.summary()
    else:
        collected = model.datacollector.model_vars
        summary = {name: values[-1] if values else None for name, values in collected.items()}
    row: Row = {}
    for name, value in summary.items():
        value = value.item() if hasattr(value, "item") and not hasattr(value, "__len__") else value
        if isinstance(value, int) and not isinstance(value, bool):
            value = float(value)  # as the store has it; one without end is an error of the run
        if isinstance(value, str):
            value = _plain(value)
        if value is None or isinstance(value, bool | float | str):
            row[f"summary_{name}" if name in taken or name in SERIES else str(name)] = value
    if not _has_pedestrians(model):
        return row
    more = _by_type(model)
    if "blocked" in summary:
        more["blocked"] = float(len(summary["blocked"]))
    row |= {f"summary_{n}" if n in taken else n: v for n, v in more.items()}
    if occupancy:
        row["occupancy"] = [people for _, people in summary["occupancy"]]
    return row


def _of_places(model: Any) -> Row:
    """Clearing times, and figures of doors and rooms, by names such as ``door.east.flow_per_s``."""
    from mesa_mobility.results import Trajectories, clearing, rooms_of
    from mesa_mobility.results.engineering.summary import figures_of_places

    plan = getattr(model, "building", None) or model.floor_plan
    tracks, rooms = Trajectories.of(model), rooms_of(plan)
    row: Row = {}
    for times in clearing(tracks, plan, rooms).reset_index().to_dict("records"):
        where = "" if times["kind"] == "floor" else f"{times['kind']}.{times['place']}."
        for name in ("t50_s", "t95_s", "t100_s"):
            row[where + name] = None if math.isnan(times[name]) else float(times[name])
    found = figures_of_places(tracks, plan, rooms)
    for kind, places in (("door", found["doors"]), ("room", found["rooms"])):
        for place, figures in places.items():
            for name, value in figures.items():
                row[f"{kind}.{place}.{name}"] = None if value is None else float(value)
    return row


def _by_type(model: Any) -> Row:
    """How long people of each type took, where all are out, and the flow of those who are."""
    crowd, count = model.crowd, model.population.count
    left = ~crowd.active[:count]
    seconds = crowd.active_frames[:count] / model.frame_rate
    types = []
    for number in sorted(set(crowd.type_index[:count].tolist())):
        of = crowd.type_index[:count] == number
        times = seconds[of & left]
        # Of those who are out alone, the times of the slowest would be missing.
        out = len(times) == int(of.sum())
        types.append(
            {
                "type": int(number),
                "people": int(of.sum()),
                "left": len(times),
                "mean_s": float(times.mean()) if out else None,
                "longest_s": float(times.max()) if out else None,
            }
        )
    times = seconds[left]
    flow = None
    # Times inside are times of leaving where everybody has been there from the start.
    if len(times) > 1 and not len(model.sources) and times.max() > times.min():
        flow = (len(times) - 1) / float(times.max() - times.min())
    return {
        "types": types,
        "mean_time_inside_s": float(times.mean()) if count and left.all() else None,
        "flow_per_s": flow,
    }
