"""Random crowds of 20 to 60 people on random plans: of one type, or of many with all that they do.

Each seed is another plan and another crowd. Everybody has a way out that fits their body.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely
from mesa_mobility.behaviors import Counter, Hazard, Hazards, Queueing
from shapely import Polygon

from benchmarks.conflicts.walking import Closure, Walk
from mesa_mobility import FloorPlan, PedestrianModel, PedestrianType, Source, Visit
from mesa_mobility.distributions import Uniform
from mesa_mobility.errors import FloorPlanError, MobilityError, ModelError
from mesa_mobility.populations import Population, presets
from mesa_mobility.verification import Case, case
from mesa_mobility.verification.runs import crowd_model
from mesa_mobility.verification.scenarios.random_plans import SHAPES, Drawn, draw_plan

FEWEST, MOST = 20, 60
LIMIT_S = 600.0
SPACINGS = (0.45, 0.6, 0.8)
"""Metres between people at the start: the first that their bodies allow."""
MORE = 0.1
"""Metres of room that the widest body has on either side in every door on its way."""
PARTS = ("groups", "visits", "queue", "door", "hazard", "source")
"""What a crowd of many types may have besides, each in half of them."""
KEPT = 0.5
"""Metres that people keep from a hazard."""
SERVICE_S = 5.0
TRIES = 300


@dataclass
class Crowd:
    """What a seed has drawn."""

    rng: np.random.Generator
    shares: Population
    widest: float
    drawn: Drawn
    parts: list[str]
    total: int
    text: str
    closures: list[Closure] = field(default_factory=list)
    queueing: Queueing | None = None


def mixed(seed: int, *, kinds: str) -> dict[str, Any]:
    """Figures of a crowd, and what it was, in a few words.

    Args:
        seed: of the plan, the crowd and the run.
        kinds: "one" type, or "many" types with groups, visits, queues, doors that close and open
            again, hazards and sources.
    """
    for attempt in range(TRIES):
        crowd = draw(seed, kinds, attempt)
        try:
            model = _filled(seed, crowd)
            break
        except FloorPlanError as error:  # such as a wall just behind an exit, for a wide type
            refused = error
    else:
        raise refused
    plan, rng = crowd.drawn.plan, crowd.rng
    if "queue" in crowd.parts:
        crowd.queueing = _line(model, crowd)
    _occupy(model, crowd)
    if "door" in crowd.parts:
        names = [each.name for each in (*plan.gates, *plan.exits)]
        closes = float(rng.uniform(2.0, 20.0))
        opens = closes + float(rng.uniform(10.0, 60.0))
        crowd.closures.append(Closure(str(rng.choice(names)), closes, opens))
    walk = Walk(model, LIMIT_S, crowd.closures, crowd.queueing, SERVICE_S)
    figures = walk.run()
    late = f"{crowd.total - figures['people']} people have not come in"
    assert figures["people"] <= crowd.total
    return {
        **figures,
        "too_long": late if figures["people"] < crowd.total else "",
        "what": crowd.text,
    }


def draw(seed: int, kinds: str, attempt: int = 0) -> Crowd:
    """The plan and the crowd of a seed; another one for each attempt."""
    rng = np.random.default_rng([seed, 4, kinds == "many", attempt])
    names = presets()["every_type"].names
    if kinds == "one":
        shares = Population({str(rng.choice(names)): 1.0})
    elif rng.random() < 0.5:
        shares = presets()[str(rng.choice(("every_type", "mixed")))]
    else:
        some = rng.choice(names, size=int(rng.integers(2, 5)), replace=False)
        parts = rng.dirichlet(np.ones(len(some))) * 0.9 + 0.1 / len(some)
        shares = Population(dict(zip(some.tolist(), parts.tolist(), strict=True)))
    widest = max(core_of(name) for name in shares.names)
    shape, both = str(rng.choice(list(SHAPES))), bool(rng.random() < 0.5)
    drawn = _plan(rng, shape, both, widest)
    has = [part for part in PARTS if kinds == "many" and rng.random() < 0.5]
    total = int(rng.integers(FEWEST, MOST + 1))
    who = " + ".join(f"{name} {share:.2f}" for name, share in shares.shares.items())
    text = f"{shape}, {'both ways' if both else 'one way'}, {who}, {', '.join(has) or '-'}"
    return Crowd(rng, shares, widest, drawn, has, total, text)


def core_of(name: str) -> float:
    """Radius of the body of a shipped type, metres."""
    radius = PedestrianType.named(name).core_radius
    assert isinstance(radius, float)
    return radius


def _plan(rng: np.random.Generator, shape: str, both_ways: bool, widest: float) -> Drawn:
    """A plan through whose doors the widest people get, from wherever anybody starts."""
    for _ in range(TRIES):
        drawn = draw_plan(rng, shape, both_ways=both_ways)
        try:
            _check_ways(drawn.plan, drawn, widest)
        except FloorPlanError:
            continue
        return drawn
    raise AssertionError(f"{shape}: no plan for people {2 * widest:g} m wide")


def _filled(seed: int, crowd: Crowd) -> PedestrianModel:
    """A model with its people."""
    choice = _hazards(crowd) if "hazard" in crowd.parts else None
    types = [PedestrianType.named(name) for name in crowd.shares.names]
    keywords: dict[str, Any] = {"pedestrian_types": types}
    if len(types) > 1:
        keywords = {"pedestrian_types": None, "population": crowd.shares}
    model = crowd_model(crowd.drawn.plan, seed, target_choice=choice, **keywords)
    _fill(model, crowd)
    return model


def _hazards(crowd: Crowd) -> Hazards | None:
    """A hazard that leaves everybody a way that keeps from it, where there is a place for one."""
    plan, rng = crowd.drawn.plan, crowd.rng
    for _ in range(TRIES):
        middle = shapely.Point(_place(plan, 0.2, rng))
        within = middle.buffer(float(rng.uniform(0.5, 2.5)), quad_segs=4)
        try:
            beside = plan.altered(obstacles=[within.buffer(KEPT + MORE)])
            _check_ways(beside, crowd.drawn, crowd.widest)
        except FloorPlanError:
            continue
        begins, speed = float(rng.uniform(0.0, 20.0)), float(rng.uniform(0.01, 0.05))
        return Hazards([Hazard(middle, speed=speed, begins=begins, within=within)], margin=KEPT)
    crowd.text += " (no room for the hazard)"
    return None


def _check_ways(plan: FloorPlan, drawn: Drawn, widest: float) -> None:
    """Raise FloorPlanError unless the widest get to each exit from everywhere they start."""
    room = widest + MORE
    free = plan.free.buffer(-room)
    pieces = [piece for piece in getattr(free, "geoms", [free]) if not piece.is_empty]
    for area, exits in drawn.starts:
        goals = [each for each in plan.exits if exits is None or each.name in exits]
        for goal in goals:
            leads = [each for each in pieces if each.distance(goal.line) <= room + 0.01]
            inside = [each for each in pieces if each.intersection(area).area > 0.01]
            if not inside or any(each not in leads for each in inside):
                raise FloorPlanError("somebody has no way out")


def _fill(model: PedestrianModel, crowd: Crowd) -> None:
    """People at the start, as many as have room, and the others from sources."""
    share = crowd.total // len(crowd.drawn.starts)
    count = [share] * len(crowd.drawn.starts)
    count[0] += crowd.total - sum(count)
    for (area, exits), wanted in zip(crowd.drawn.starts, count, strict=True):
        held = wanted // 4 if "source" in crowd.parts else 0
        here = _add(model, crowd, area, exits, wanted - held)
        if here < wanted:
            rate = float(crowd.rng.uniform(0.2, 1.0))
            shares = crowd.shares if len(crowd.shares.names) > 1 else None
            model.add_source(
                Source(area=area, rate=rate, number=wanted - here, exits=exits, population=shares)
            )


def _add(
    model: PedestrianModel,
    crowd: Crowd,
    area: Polygon,
    exits: tuple[str, ...] | None,
    wanted: int,
) -> int:
    """Add so many people to an area, or fewer where there is no room; how many."""
    plan = crowd.drawn.plan
    for spacing in SPACINGS:
        room = plan.free.buffer(-crowd.widest - 0.05).intersection(area).area
        fit = min(wanted, int(0.25 * room / spacing**2))
        if spacing < crowd.widest + 0.2 or not fit:
            continue
        try:
            places = plan.random_points(
                fit, model.rng, within=area, spacing=spacing, clearance=crowd.widest + 0.05,
                avoid=model.population.bodies()[1],
            )  # fmt: skip
            model.add_pedestrians(places, exits=exits)
        except (ModelError, FloorPlanError):  # two wide ones too near to each other
            continue
        return fit
    return 0


def _line(model: PedestrianModel, crowd: Crowd) -> Queueing | None:
    """A line, where people who stand in it leave a way for the widest ones, and its tactic."""
    plan = crowd.drawn.plan
    room = plan.free.buffer(-crowd.widest - 0.2)
    for _ in range(TRIES):
        turn, long = crowd.rng.uniform(0, 2 * np.pi), crowd.rng.uniform(3.0, 5.0)
        head = np.array(_place(plan, crowd.widest + 0.2, crowd.rng))
        line = shapely.LineString([head, head + long * np.array([np.cos(turn), np.sin(turn)])])
        if not room.contains(line):
            continue
        beside = plan.altered(obstacles=[line.buffer(crowd.widest + 0.2, cap_style="flat")])
        rest = beside.free.buffer(-crowd.widest - MORE)
        if rest.geom_type == "Polygon":  # nobody is cut off by those who stand in line
            counter = Counter(list(line.coords), service=Uniform(1.0, SERVICE_S))
            queueing = Queueing([counter])
            model.add_tactic(queueing)
            return queueing
    crowd.text += " (no room for the queue)"
    return None


def _occupy(model: PedestrianModel, crowd: Crowd) -> None:
    """Give people groups, and something to do on their way."""
    rng = crowd.rng
    people = list(model.space.active_agents)
    if "groups" in crowd.parts:
        alone = people[: len(people) // 2]
        number = 0
        while len(alone) > 1:
            first = alone.pop(0)
            alone.sort(key=lambda each: float(np.hypot(*(each.position - first.position))))
            number += 1
            first.group = number
            for other in [alone.pop(0) for _ in range(min(int(rng.integers(1, 4)), len(alone)))]:
                if other.exits == first.exits:
                    other.group = number
    busy = rng.permutation(len(people)).tolist()
    if crowd.queueing is not None:
        for at in busy[:6]:
            people[at].route = [crowd.queueing.counters[0].visit]
    if "visits" in crowd.parts:
        for at in busy[6 : 6 + max(len(people) // 4, 2)]:
            stay = float(rng.uniform(2.0, 20.0))
            for _ in range(20):
                place = _place(crowd.drawn.plan, crowd.widest + 0.3, rng)
                try:
                    people[at].route = [Visit(place, stay=stay)]
                    break
                except MobilityError:  # a corner that is cut off for wide people
                    continue


def _place(plan: FloorPlan, clearance: float, rng: np.random.Generator) -> tuple[float, float]:
    ((x, y),) = plan.random_points(1, rng, spacing=0.1, clearance=clearance)
    return float(x), float(y)


def cases() -> Sequence[Case]:
    """Crowds of one type, and of many, for 500 seeds each."""
    return [case(mixed, kinds="one"), case(mixed, kinds="many")]
