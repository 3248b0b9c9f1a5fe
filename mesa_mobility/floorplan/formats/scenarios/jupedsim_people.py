"""People of JuPedSim's scenarios: distributions with their journeys."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from shapely.geometry.base import BaseGeometry

from mesa_mobility.distributions import Constant, Distribution, Gamma, Normal, Uniform
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats.assembling.values import (
    list_of,
    mapping_of,
    number_of,
    ring_of,
)
from mesa_mobility.floorplan.formats.people import People, Stop, checked, count_of, total_of

LEAST_SPEED, MOST_SPEED = 0.05, 5.0
"""Bounds of speeds, m/s."""

MOST = 10_000
"""Distributions, checkpoints and journeys of a scenario."""


def people_of(config: Mapping[str, Any], where: str, notes: list[str]) -> list[People]:
    """The people of a scenario.

    Args:
        config: its file of settings.
        where: name of that file in messages.
        notes: takes what is left out.

    Raises:
        FloorPlanError: something in it is none.
    """
    parts = {
        kind: mapping_of(config.get(kind), f"{where}: {kind}")
        for kind in ("distributions", "checkpoints", "exits")
    }
    if max(map(len, parts.values())) > MOST:
        raise FloorPlanError(f"{where}: more than {MOST:,} distributions or checkpoints")
    stops = {
        key: _stop(mapping_of(each, f"{where}: {key:.40}"), f"{where}: {key:.40}", notes)
        for key, each in parts["checkpoints"].items()
    }
    journeys = _journeys(config, where)
    found: list[People] = []
    total = 0
    for key, value in parts["distributions"].items():
        at = f"{where}: {key:.40}"
        given = mapping_of(value, at)
        area = ring_of(given.get("coordinates"), at)
        numbers = mapping_of(given.get("parameters"), f"{at}: parameters")
        whole = _number(numbers, area, at)
        total = total_of(total, whole, at)
        ways = [
            (
                str(mapping_of(each, at).get("journey_id")),
                number_of(mapping_of(each, at).get("weight"), at, 1.0),
            )
            for each in list_of(given.get("journey_weights"), at)
        ]
        known = [
            (journeys[name], weight) for name, weight in ways if name in journeys and weight > 0
        ]
        if ways and not known:
            notes.append(f"{key:.40} has no journey that is known: its people go to any exit")
        for k, (sequence, count) in enumerate(_shared(whole, known or [((), 1.0)])):
            if not count:
                continue
            exits = tuple(exit_name(each) for each in sequence if each in parts["exits"])
            found.append(
                People(
                    f"{key:.40}" if k == 0 else f"{key:.40} journey {k + 1}",
                    area,
                    count,
                    _times(numbers, count, at),
                    _spread("v0", numbers, at, 1.3, (LEAST_SPEED, MOST_SPEED), notes),
                    _pre_movement(numbers, at, notes),
                    tuple(stops[each] for each in sequence if each in stops),
                    exits or None,
                )
            )
    return found


def exit_name(key: str) -> str:
    """The name of an exit, which the file may call by a long text."""
    return key[:40] or "exit"


def _journeys(config: Mapping[str, Any], where: str) -> dict[str, tuple[str, ...]]:
    """Stages of each journey by its id."""
    found = {}
    for each in list_of(config.get("journeys_v2"), f"{where}: journeys_v2")[:MOST]:
        journey = mapping_of(each, f"{where}: journeys_v2")
        sequence = list_of(journey.get("sequence"), f"{where}: journeys_v2: sequence")
        found[str(journey.get("id"))] = tuple(str(stage) for stage in sequence[:MOST])
    return found


def _number(numbers: Mapping[str, Any], area: BaseGeometry, at: str) -> int:
    if numbers.get("distribution_mode") == "by_percentage" and numbers.get("percentage"):
        # Of the people who fit beside each other as discs.
        radius = max(number_of(numbers.get("radius"), at, 0.2), 0.05)
        share = number_of(numbers["percentage"], at) / 100
        return count_of(float(int(share * area.area / (math.pi * radius**2))), at)
    return count_of(numbers.get("number", 0) or 0, at)


def _shared(
    whole: int, ways: list[tuple[tuple[str, ...], float]]
) -> list[tuple[tuple[str, ...], int]]:
    """How many of some people go each way: shares rounded so that they add up."""
    weights = np.array([weight for _, weight in ways])
    shares = whole * weights / weights.sum()
    counts = np.floor(shares).astype(int)
    missing = whole - int(counts.sum())
    for k in np.argsort(counts - shares, kind="stable")[:missing]:
        counts[k] += 1
    return [(sequence, int(count)) for (sequence, _), count in zip(ways, counts, strict=True)]


def _times(numbers: Mapping[str, Any], count: int, at: str) -> tuple[float, ...]:
    """When people come: evenly between two times, or all at the start."""
    if numbers.get("use_flow_spawning") is not True:
        return ()
    start = number_of(numbers.get("flow_start_time"), at, 0.0)
    end = number_of(numbers.get("flow_end_time"), at, start)
    if not 0 <= start <= end <= 1e6:
        raise FloorPlanError(f"{at}: people come from {start:g} to {end:g} s, expected 0 to 1e6 s")
    return tuple(np.linspace(start, end, count, endpoint=False).tolist())


def _spread(
    name: str,
    numbers: Mapping[str, Any],
    at: str,
    default: float,
    bounds: tuple[float, float],
    notes: list[str],
) -> Distribution:
    """A number that is the same for all, or normally distributed."""
    mean = number_of(numbers.get(name), f"{at}: {name}", default)
    mean = float(np.clip(mean, *bounds))
    deviation = number_of(numbers.get(f"{name}_std"), f"{at}: {name}_std", 0.0)
    kind = numbers.get(f"{name}_distribution", "constant")
    if kind in ("gaussian", "normal") and deviation > 0:
        return checked(Normal, f"{at}: {name}", mean, deviation, *bounds)
    if kind not in ("constant", "gaussian", "normal"):
        notes.append(f"{name} of {at.rpartition(': ')[2]} is {mean:g}, not {kind!s:.40}")
    return checked(Constant, f"{at}: {name}", mean)


def _pre_movement(numbers: Mapping[str, Any], at: str, notes: list[str]) -> Distribution | None:
    if numbers.get("use_premovement") is not True:
        return None
    kind = numbers.get("premovement_distribution")
    a = numbers.get("premovement_param_a")
    b = numbers.get("premovement_param_b")
    kinds: dict[Any, type[Distribution]] = {"gamma": Gamma, "uniform": Uniform}
    if kind not in kinds or a is None or b is None:
        notes.append(f"left out the pre-movement {kind!s:.40} of {at.rpartition(': ')[2]}")
        return None
    return checked(kinds[kind], f"{at}: pre-movement", number_of(a, at), number_of(b, at))


def _stop(checkpoint: Mapping[str, Any], at: str, notes: list[str]) -> Stop:
    area = ring_of(checkpoint.get("coordinates"), at)
    stay = number_of(checkpoint.get("waiting_time"), f"{at}: waiting_time", 0.0)
    title = at.rpartition(": ")[2]
    if checkpoint.get("enable_throughput_throttling") is True:
        notes.append(f"left out the greatest throughput of {title}")
    if number_of(checkpoint.get("speed_factor"), at, 1.0) != 1.0:
        notes.append(f"left out the speed in {title}")
    if not 0 <= stay <= 86_400:
        raise FloorPlanError(f"{at}: waiting_time {stay:g} s, expected 0 to 86,400 s")
    return Stop(area, stay)
