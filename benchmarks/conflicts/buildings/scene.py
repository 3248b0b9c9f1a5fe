"""Random crowds of 20 to 60 people on all levels of random buildings; each seed is another."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import networkx as nx
import numpy as np
import shapely
from numpy.typing import NDArray

from benchmarks.conflicts.buildings.counting import FRAMES, Crowd, Found, count, surfaces_at
from benchmarks.conflicts.buildings.drawing import draw_building
from benchmarks.conflicts.buildings.surfaces import Surface, level_name, surfaces_of
from mesa_mobility import Building, Escalator, PedestrianModel, PedestrianType, Ramp, Trajectories
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.mobility.map_data import SAMPLE_SECONDS, MapData
from mesa_mobility.populations import Population, presets
from mesa_mobility.verification import Case, case
from mesa_mobility.verification.runs import crowd_model

FEWEST, MOST = 20, 60
LIMIT_S = 240.0
SPACING, CLEARANCE = 0.6, 0.1
"""Metres between people of the slimmest types at the start, and from bodies to walls."""
MORE = 0.1
"""Metres of room that a body has on either side in a door on its way."""
GOT_ON, WITHIN = 0.5, 30
"""Metres that somebody under way gets on in so many seconds."""
NEAR_REFUGE, NEAR_LIFT = 3.0, 6.0
"""Metres from a refuge, or from the door of a lift, at which people wait for it."""


@dataclass(frozen=True)
class Closure:
    """A gate of a flight or a lift that is closed from one second to another."""

    name: str
    closes: float
    opens: float


def buildings(seed: int) -> dict[str, Any]:
    """Figures of a crowd in a building.

    Args:
        seed: of the building, the crowd and the run.
    """
    rng = np.random.default_rng([seed, 5])
    while True:
        drawn = draw_building(rng)
        building, shares = drawn.building, _shares(rng)
        model = _model(seed, building, shares)
        _fill(model, building, int(rng.integers(FEWEST, MOST + 1)))
        if model.population.count:  # otherwise something stands in the way of each exit
            break
    closures = _closures(rng, building)
    begun = time.process_time()
    _run(model, closures)
    ran, begun = time.process_time() - begun, time.process_time()
    surfaces = surfaces_of(building)
    tracks = Trajectories.of(model)
    found = count_run(tracks, building, model.pedestrian_types, surfaces, model.population.count)
    reasons = _reasons(found, tracks, building, model.pedestrian_types, surfaces)
    kinds = Counter(getattr(way, "shape", way.kind) for way in building.stairs)
    return {
        "people": model.population.count,
        "left_inside": len(found.inside),
        "left": dict(Counter(reasons.values())),
        "stood": sum(reason == "stands" for reason in reasons.values()),
        "stood_from": [person for person, reason in reasons.items() if reason == "stands"],
        **{name: getattr(found, name) for name in COUNTED},
        "on_steps": on_steps(tracks, building, model.pedestrian_types, surfaces),
        "out_s": model.statistics.last_left if model.inside == 0 else None,
        "simulated_s": round(model.elapsed, 3),
        "stalled_frames": 0,
        "run_cpu_s": round(ran, 2),
        "count_cpu_s": round(time.process_time() - begun, 2),
        "changes": found.changes,
        "rides": found.rides,
        "draws": drawn.draws,
        "refused": drawn.refused,
        "levels": len(building.levels),
        "ways": dict(kinds) | {"lift": len(building.lifts)},
        "refuges": len(building.refuges),
        "named": found.named,
        "what": f"{', '.join(shares.names)}; {', '.join(each.name for each in closures) or '-'}",
    }


COUNTED = (
    "lost", "doubled", "overlaps", "wall_crossings", "floor_crossings", "off_floor", "jumps",
)  # fmt: skip
"""Figures of `Found` that are to be 0."""


def count_run(
    tracks: Trajectories,
    building: Building,
    types: Sequence[PedestrianType],
    surfaces: Sequence[Surface],
    people: int,
) -> Found:
    """Count what is wrong in a run of so many people."""
    speeds = {each.name: fastest_of(each.mobility_map) for each in types}
    belts = [way.speed for way in building.stairs if isinstance(way, Escalator)]
    kinds = tracks.person_data["type"][:people]
    crowd = Crowd(
        tracks.frame.astype(np.int64),
        tracks.person.astype(np.int64),
        np.column_stack([tracks.x, tracks.y, tracks.z]),
        int(tracks.last_frame or 0),
        tracks.radii[:people],
        np.array([max(speeds[str(kind)], *belts, 0.0) for kind in kinds]),
    )
    exits = {level_name(own.number): [each.line for each in own.exits] for own in building.levels}
    return count(crowd, surfaces, exits, {lift.name: lift.speed for lift in building.lifts})


def on_steps(
    tracks: Trajectories,
    building: Building,
    types: Sequence[PedestrianType],
    surfaces: Sequence[Surface],
) -> list[int]:
    """People who do not use stairs and were on them, or on an escalator, at a whole second."""
    sits = np.isin(tracks.person_data["type"], [each.name for each in types if not each.climbs])
    rows = np.flatnonzero(sits[tracks.person] & (tracks.frame % FRAMES == 0))
    where = surfaces_at(np.column_stack([tracks.x[rows], tracks.y[rows], tracks.z[rows]]), surfaces)
    level = {level_name(each.number) for each in building.levels}
    level |= {way.name for way in building.stairs if isinstance(way, Ramp)}
    steps = [each.name not in level and not each.lift for each in surfaces]
    found: list[int] = np.unique(tracks.person[rows[np.append(steps, False)[where]]]).tolist()
    return found


def fastest_of(movements: MapData) -> float:
    """The greatest speed in any movement of a map, m/s."""
    before = np.vstack([np.zeros((1, 2)), movements.paths[:-1, :2]])
    before[movements.path_offsets[:-1]] = 0.0
    return float(np.hypot(*(movements.paths[:, :2] - before).T).max()) / SAMPLE_SECONDS


def _shares(rng: np.random.Generator) -> Population:
    """One type, a shipped population, or a few types."""
    names = presets()["every_type"].names
    kind = rng.random()
    if kind < 0.2:
        return Population({str(rng.choice(names)): 1.0})
    if kind < 0.6:
        return presets()[str(rng.choice(("every_type", "mixed")))]
    some = rng.choice(names, size=int(rng.integers(2, 5)), replace=False).tolist()
    parts = rng.dirichlet(np.ones(len(some))) * 0.9 + 0.1 / len(some)
    return Population(dict(zip(some, parts.tolist(), strict=True)))


def _model(seed: int, building: Building, shares: Population) -> PedestrianModel:
    """A model without people yet."""
    if len(shares.names) > 1:
        return crowd_model(building, seed, pedestrian_types=None, population=shares)
    return crowd_model(building, seed, pedestrian_types=[PedestrianType.named(shares.names[0])])


def _fill(model: PedestrianModel, building: Building, total: int) -> None:
    """People on all levels, the widest first, as many as have room."""
    kinds = model.draw_types(total)
    halves = np.array([each.half_width for each in model.pedestrian_types])
    numbers = [level.number for level in building.levels]
    storeys = model.rng.permutation(total) % len(numbers)
    for index in np.argsort(-halves).tolist():
        spacing = max(2.0 * float(halves[index]) + 0.2, SPACING)
        for storey, number in enumerate(numbers):
            for _ in range(int(((kinds == index) & (storeys == storey)).sum())):
                try:
                    places = building.random_points(
                        1, model.rng, level=number, spacing=spacing,
                        clearance=float(halves[index]) + CLEARANCE,
                        avoid=model.population.bodies()[1],
                    )  # fmt: skip
                    model.add_pedestrians(places, type_index=index)
                except (ModelError, FloorPlanError):  # no room
                    continue


def _closures(rng: np.random.Generator, building: Building) -> list[Closure]:
    """At times, flights or lifts that are closed for some time."""
    plan, found = building.floor_plan, []
    gates = [gate.name for each in plan.seams for gate in each.gates]
    gates += [gate.name for each in plan.shafts for gate in each.gates]
    for _ in range(int(rng.choice((0, 0, 0, 1, 2)))):
        closes = float(rng.uniform(2.0, 40.0))
        found.append(
            Closure(str(rng.choice(gates)), closes, closes + float(rng.uniform(5.0, 40.0)))
        )
    return found


def _run(model: PedestrianModel, closures: Sequence[Closure]) -> None:
    """Run until all are out who can leave, nobody gets on for a minute, or time is up."""
    plan = model.floor_plan
    acts = sorted(
        [(each.closes, plan.close_gate, each.name) for each in closures]
        + [(each.opens, plan.open_gate, each.name) for each in closures],
        key=lambda act: act[0],
    )
    while model.elapsed < LIMIT_S and (model.running or acts) and model.inside:
        while acts and model.elapsed >= acts[0][0]:
            _, act, name = acts.pop(0)
            act(name)
            model.go_on()
        model.step()


def _reasons(
    found: Found,
    tracks: Trajectories,
    building: Building,
    types: Sequence[PedestrianType],
    surfaces: Sequence[Surface],
) -> dict[int, str]:
    """Why each is inside at the end: in a refuge, cut off, at a lift, under way, or standing."""
    climbs = {each.name: bool(each.climbs) for each in types}
    reasons = dict[int, str]()
    for person in found.inside:
        rows = tracks.rows_of(person)
        xyz = np.column_stack([tracks.x[rows], tracks.y[rows], tracks.z[rows]])
        own = climbs[str(tracks.person_data["type"][person])]
        room = 2.0 * float(tracks.radii[person] + MORE)
        reasons[person] = _reason(xyz, own, room, building, surfaces)
    return reasons


def _reason(
    xyz: NDArray[np.float64],
    climbs: bool,
    room: float,
    building: Building,
    surfaces: Sequence[Surface],
) -> str:
    here = shapely.Point(xyz[-1, :2])
    number = int(surfaces_at(xyz[-1:], surfaces)[0])
    surface = surfaces[number]
    level = next(
        (each for each in building.levels if level_name(each.number) == surface.name), None
    )
    if surface.lift:
        return "in a lift"
    if level is not None and not climbs and not _is_level_way(building, level.number, room):
        near = [each for each in level.refuges if each.shape.distance(here) <= NEAR_REFUGE]
        return "in a refuge" if near else "cut off"
    moved = np.hypot(*(xyz[-1] - xyz[max(len(xyz) - WITHIN * FRAMES, 0)])[:2])
    if moved >= GOT_ON:
        return "under way"
    doors = [
        shapely.LineString(each.door) for each in building.lifts
        if level is not None and level.number in each.numbers
    ]  # fmt: skip
    return "at a lift" if any(door.distance(here) <= NEAR_LIFT for door in doors) else "stands"


def _is_level_way(building: Building, number: int, room: float) -> bool:
    """Whether ramps and lifts whose doors are so wide lead from a level to one with an exit."""
    graph = nx.Graph()
    graph.add_nodes_from(level.number for level in building.levels)
    graph.add_edges_from((way.upper, way.lower) for way in building.stairs if isinstance(way, Ramp))
    for lift in building.lifts:
        if shapely.LineString(lift.door).length >= room:
            graph.add_edges_from((lift.numbers[0], other) for other in lift.numbers[1:])
    leading = {level.number for level in building.levels if level.exits}
    return bool(leading & nx.node_connected_component(graph, number))


def cases() -> Sequence[Case]:
    """Another building and crowd for each seed."""
    return [case(buildings)]
