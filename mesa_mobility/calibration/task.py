"""Checks what a calibration is asked for, and describes it in texts and numbers for a file."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from mesa_mobility.calibration.names import measured_of, name_of, scenario_name
from mesa_mobility.calibration.settings import Distance, Free, HeldOut, Search, Seeds
from mesa_mobility.crowd.presets.files import preset_text
from mesa_mobility.crowd.presets.naming import (
    MOST_ACCELERATION,
    MOST_ACCELERATION_NAME,
    as_value,
    named,
    number_named,
    unknown,
)
from mesa_mobility.crowd.presets.preset import Preset
from mesa_mobility.crowd.presets.shipped import preset_of
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.registry import did_you_mean

Distances = Sequence[Callable[[Any, Any], float] | Distance]


@dataclass(frozen=True)
class Compared:
    """A scenario, what was measured, and how both are compared.

    Attributes:
        simulates: text of the function or model.
        measures: text of the measured data.
        distances: the distances.
        functions: JSON of the text of each distance's function by the distance's name.
        held_out: whether the scenario is kept from the search, to check its result.
    """

    simulates: str
    measures: str
    distances: tuple[Distance, ...]
    functions: str
    held_out: bool


@dataclass(frozen=True)
class Task:
    """A calibration.

    Attributes:
        scenarios: what is simulated and compared, by the scenario's name.
        free: the free numbers, which the search may change, each with its bounds and start.
        seeds: of the runs.
        search: settings of the search.
        preset: values of all numbers that are not free.
        files: sha256 of each file with measured data, by the file's name without its folder.
    """

    scenarios: Mapping[str, Compared]
    free: tuple[Free, ...]
    seeds: Seeds
    search: Search
    preset: Preset
    files: Mapping[str, str]

    def names(self, *, held_out: bool) -> list[str]:
        """Names of the held-out scenarios, which the search does not see, or of the others."""
        return [name for name, each in self.scenarios.items() if each.held_out == held_out]

    @property
    def start(self) -> dict[str, float]:
        """The value of each free number at which the search starts, by name."""
        return {each.name: float(each.start or 0.0) for each in self.free}

    def definition(self) -> dict[str, Any]:
        """What a store keeps: all that results depend on, except the number of evaluations."""
        return {
            "scenarios": {
                name: {
                    "simulates": each.simulates,
                    "measures": each.measures,
                    "distances": json.loads(each.functions),
                    "weights": {of.name: float(of.weight) for of in each.distances},
                    "held_out": each.held_out,
                }
                for name, each in self.scenarios.items()
            },
            "free": [
                {
                    "name": each.name,
                    "bounds": list(each.bounds),
                    "start": each.start,
                    "log": each.log,
                }
                for each in self.free
            ],
            "seeds": {
                "each": self.seeds.each,
                "held_out": self.seeds.held_out,
                "first": self.seeds.first,
            },
            "search": {
                "candidates": self.search.candidates,
                "spread": float(self.search.spread),
                "max_seconds": self.search.max_seconds,
                "time_limit": self.search.time_limit,
            },
            "preset": self.preset.digest,
            "files": dict(self.files),
        }


def task_of(
    scenarios: Mapping[str, Any],
    data: Mapping[str, Any],
    *,
    free: Sequence[str | Free],
    distances: Distances | Mapping[str, Distances],
    seeds: Seeds,
    search: Search,
) -> Task:
    """A calibration, checked; see ``calibrate`` for the arguments.

    Raises:
        ModelError: anything that does not fit.
        ResultsError: a file that cannot be read.
    """
    preset = preset_of(search.preset)
    if not isinstance(scenarios, Mapping) or not scenarios:
        raise ModelError(f"scenarios: got {scenarios!r:.60}, expected functions or models by name")
    if not isinstance(data, Mapping):
        raise ModelError(f"data: got {data!r:.60}, expected measured data by scenario")
    for what, names in (("data", data), ("distances", distances)):
        _check_scenarios(what, names, scenarios)
    compared: dict[str, Compared] = {}
    files: dict[str, str] = {}
    for name, scenario in scenarios.items():
        given = data[name]
        held_out = isinstance(given, HeldOut)
        found = measured_of(given.data if held_out else given, f"data of {name}")
        for file, digest in found.files.items():
            if files.setdefault(file, digest) != digest:
                raise ModelError(f"data: two files are named {file}, expected names of their own")
        own = _distances(distances[name] if isinstance(distances, Mapping) else distances)
        functions = {each.name: name_of(each.function, "distances") for each in own}
        compared[name] = Compared(
            scenario_name(scenario, f"scenario {name}"),
            found.text,
            own,
            json.dumps(functions),
            held_out,
        )
    if all(each.held_out for each in compared.values()):
        raise ModelError("data: all are held out, expected some that the search sees")
    return Task(compared, _free(free, preset), seeds, search, preset, files)


def _check_scenarios(what: str, names: object, scenarios: Mapping[str, Any]) -> None:
    """Raise ModelError unless these are the names of the scenarios."""
    if not isinstance(names, Mapping):
        return
    for name in names:
        if name not in scenarios:
            known = f", there are {', '.join(scenarios)}"
            meant = did_you_mean(str(name), dict.fromkeys(scenarios)) or known
            raise ModelError(f"{what}: no scenario {name!r}{meant}")
    if missing := [name for name in scenarios if name not in names]:
        raise ModelError(f"{what}: lacks scenario {missing[0]!r}, expected all scenarios")


def _distances(given: Any) -> tuple[Distance, ...]:
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise ModelError(f"distances: got {given!r:.60}, expected a list of functions")
    found = tuple(each if isinstance(each, Distance) else Distance(each) for each in given)
    names = [each.name for each in found]
    if not found:
        raise ModelError("distances: got none, expected functions")
    if twice := [name for name in names if names.count(name) > 1]:
        raise ModelError(f"distances: two are named {twice[0]!r}, expected names of their own")
    return found


def _free(given: Sequence[str | Free], preset: Preset) -> tuple[Free, ...]:
    """The free numbers with their bounds and starts."""
    if isinstance(given, str) or not isinstance(given, Iterable) or not list(given):
        raise ModelError(f"free: got {given!r:.60}, expected a list such as ['headway.time']")
    declared = {name: (made, each) for name, made, each in named(preset.behaviours())}
    values = preset.parameters()
    found: list[Free] = []
    for one in given:
        free = one if isinstance(one, Free) else Free(one)
        if free.name in [each.name for each in found]:
            raise ModelError(f"free: {free.name} is there twice")
        if free.name not in values and free.start is None:
            raise ModelError(f"free: {unknown(free.name, values)}")
        parameter = None
        if free.name == MOST_ACCELERATION_NAME:
            parameter = MOST_ACCELERATION
        elif free.name in declared:
            parameter = declared[free.name][1]
        else:
            parameter = number_named(free.name)
        start = values.get(free.name) if free.start is None else free.start
        bounds = parameter.range if parameter is not None else None
        high = free.high
        if high is None and bounds is not None and not free.name.endswith(".weight"):
            high = bounds.high
        low = free.low
        if low is None and bounds is not None and not free.name.endswith(".weight"):
            low = bounds.low
        if low is None or high is None:
            raise ModelError(
                f"free: {free.name} has no {'low' if low is None else 'high'} end, expected "
                f"Free({free.name!r}, low, high)"
            )
        for value in (low, high):
            as_value(f"free: {free.name}", parameter, value)
        if not isinstance(start, int | float):
            raise ModelError(f"free: {free.name} is {start!r:.60} at first, expected a number")
        # Checks the whole again, the start included.
        found.append(replace(free, low=float(low), high=float(high), start=float(start)))
    return tuple(found)


def rules_text(task: Task) -> str:
    """The preset of a calibration as its runs get it."""
    return preset_text(replace(task.preset, provenance=None))
