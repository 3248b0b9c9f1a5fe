"""An experiment: a model, points of its parameter space, replications and a seed."""

from __future__ import annotations

import inspect
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from mesa_mobility.crowd.model_files import find_model
from mesa_mobility.crowd.presets.naming import as_value, is_number_name, number_named
from mesa_mobility.errors import ModelError
from mesa_mobility.experiments.convergence import Precision
from mesa_mobility.experiments.design.designs import Design, Grid
from mesa_mobility.experiments.design.points import (
    ARROW_TYPES,
    Point,
    Value,
    check_whole,
    plain_value,
)
from mesa_mobility.experiments.report_options import ReportOptions
from mesa_mobility.experiments.storing.rows import SERIES
from mesa_mobility.plugins.parameters import parameters as parameters_of
from mesa_mobility.plugins.registry import did_you_mean

Kept = Literal["occupancy", "trajectories", "doors"]
KEPT = ("occupancy", "trajectories", "doors")

Seeds = Literal["independent", "common"]
INDEPENDENT, COMMON = "independent", "common"

MOST_RUNS = 10_000_000

_LONGEST = 1e9
"""Seconds: thirty years."""


@dataclass(frozen=True)
class Experiment:
    """Runs of a model over points of its parameter space, each with several seeds.

    The seed of a run is derived from the experiment's seed, the point's values and the number of
    the replication, and from nothing else. With common seeds the point's values do not count: runs
    of one number have the same seed at all points (common random numbers). Executors, the order of
    runs, interruptions, and points or replications added later change no result.

    Args:
        model: a class, the name of an installed model, ``FILE.py``, ``FILE.py:NAME`` or
            ``module:NAME``. Its constructor takes ``rng``.
        parameters: a design, or values by name, which are a ``Grid``.
        replications: runs of each point, or "auto": as many as ``precision`` takes.
        seed: of the experiment, from 0 on.
        fixed: values of parameters that are the same in all runs.
        max_seconds: simulated seconds at most; runs that take longer end with people inside.
        time_limit: seconds of real time that a run may take; then it counts as timed out.
        keep: beside the figures of each run, its "occupancy" (people inside each second), its
            "trajectories", and figures of its "doors", rooms, levels, stairs, lifts and clearing
            times.
        precision: with ``replications="auto"``, what is to be known how well.
        name: title of the report.
        seeds: "independent", or "common" to compare points run by run; see ``compare``.
        report: figures that the report shows.

    Raises:
        ModelError: a value out of range, an unknown parameter, or one that is fixed and varies.
    """

    model: type | str
    parameters: Design | Mapping[str, Any] = field(default_factory=dict)
    replications: int | Literal["auto"] = 1
    seed: int = 0
    fixed: Mapping[str, Value] = field(default_factory=dict)
    max_seconds: float | None = None
    time_limit: float | None = None
    keep: tuple[Kept, ...] = ()
    precision: Precision = field(default_factory=Precision)
    name: str = ""
    seeds: Seeds = "independent"
    report: ReportOptions = field(default_factory=ReportOptions)

    def __post_init__(self) -> None:
        put = object.__setattr__
        if isinstance(self.parameters, Mapping):
            put(self, "parameters", Grid(self.parameters))
        put(self, "fixed", {name: plain_value(name, v) for name, v in self.fixed.items()})
        if isinstance(self.keep, str):
            raise ModelError(f"experiment: keep is {self.keep!r}, expected a list")
        put(self, "keep", tuple(self.keep))
        if not isinstance(self.name, str):
            raise ModelError(f"experiment: name is {self.name!r}, expected text")
        if self.replications != "auto":
            check_whole(
                "experiment: replications", self.replications, 1, math.inf, '1 or more, or "auto"'
            )
        check_whole("experiment: seed", self.seed, 0, math.inf, "0 or more")
        if self.seeds not in (INDEPENDENT, COMMON):
            raise ModelError(
                f"experiment: seeds is {self.seeds!r}, expected {INDEPENDENT} or {COMMON}"
            )
        most = self.precision.most if self.replications == "auto" else self.replications
        if len(self.design) * most > MOST_RUNS:
            raise ModelError(
                f"experiment: {len(self.design)} points of {most} replications, expected at most "
                f"{MOST_RUNS:,} runs"
            )
        for name in ("max_seconds", "time_limit"):
            _check_seconds(name, getattr(self, name))
        for each in self.keep:
            if each not in KEPT:
                raise ModelError(
                    f"experiment: keep has {each!r}, expected {', '.join(KEPT[:-1])} or {KEPT[-1]}"
                )
        if both := set(self.fixed) & set(self.design.column_types()):
            raise ModelError(f"experiment: {sorted(both)[0]} is both fixed and varied")

    @property
    def design(self) -> Design:
        """The points that vary."""
        assert not isinstance(self.parameters, Mapping)
        return self.parameters

    @property
    def keeps_occupancy(self) -> bool:
        """Whether runs keep the number of people inside each second."""
        return "occupancy" in self.keep or (
            self.replications == "auto" and self.precision.occupancy is not None
        )

    def point(self, index: int) -> Point:
        """All parameters of a point: those that are fixed, then those that vary."""
        return {**self.fixed, **self.design[index]}

    def column_types(self) -> dict[str, str]:
        """Name of the Arrow type of each parameter."""
        fixed = {name: ARROW_TYPES.get(type(value), "string") for name, value in self.fixed.items()}
        return {**fixed, **self.design.column_types()}


def model_class(model: type | str) -> type:
    """The class of a model.

    Raises:
        ModelError: the model cannot be found, or not be loaded.
    """
    return model if isinstance(model, type) else find_model(model)


def check_parameters(experiment: Experiment) -> None:
    """Raise ModelError if the model does not take a parameter of the experiment, or no ``rng``."""
    from mesa_mobility.experiments.storing.shards import RUN_COLUMNS

    kind = model_class(experiment.model)
    called = model_name(experiment.model)
    taken = parameters_of(kind)
    check_numbers(experiment)
    for name in experiment.column_types():
        if name in ("rng", "record"):
            raise ModelError(f"experiment: {name} is a parameter, but each run is given its own")
        if name in {*RUN_COLUMNS, *SERIES}:
            raise ModelError(
                f"model {called}: parameter {name} is called like a column of the store, expected "
                "another name"
            )
    if any(each.kind is each.VAR_KEYWORD for each in inspect.signature(kind).parameters.values()):
        return
    records = {"trajectories", "doors"} & {*experiment.keep}
    needed = ["rng", *(["record"] if records else [])]
    for name in needed:
        if name not in taken:
            raise ModelError(f"model {called}: its constructor does not take {name}")
    for name in experiment.column_types():
        if is_number_name(name):
            check_follows_rules(kind, called, name)
        elif name not in taken:
            raise ModelError(
                f"model {called}: unknown parameter {name!r}{did_you_mean(name, taken)}"
            )


def check_numbers(experiment: Experiment) -> None:
    """Raise ModelError for an unknown number of a behaviour, or a value that is out of range."""
    names = [name for name in experiment.column_types() if is_number_name(name)]
    known = {name: number_named(name) for name in names}
    for index in range(len(experiment.design)) if names else ():
        point = experiment.point(index)
        for name in names:
            as_value(name, known[name], point[name])


def check_follows_rules(kind: type, called: str, name: str) -> None:
    """Raise ModelError unless a class makes models whose behaviours have numbers."""
    from mesa_mobility.crowd import PedestrianModel

    if not (issubclass(kind, PedestrianModel) or getattr(kind, "makes_models", False)):
        raise ModelError(f"model {called}: has no behaviours, expected no parameter {name!r}")


def model_name(model: type | str) -> str:
    """A model as a file names it."""
    return model if isinstance(model, str) else f"{model.__module__}:{model.__qualname__}"


def _check_seconds(name: str, value: Any) -> None:
    if value is None:
        return
    if isinstance(value, bool) or not isinstance(value, int | float) or not (0 < value <= _LONGEST):
        raise ModelError(
            f"experiment: {name} is {value!r}, expected seconds above 0, at most {_LONGEST:g}"
        )
