"""Straight stairs between two levels: somebody alone on them, and crowds before them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from shapely import Polygon, box

from mesa_mobility import Building, Exit, Level, PedestrianType, Stairs
from mesa_mobility.buildings.connections.flights import UPWARDS, speed_factor
from mesa_mobility.results import speeds_along
from mesa_mobility.verification.runs import (
    CLEARANCE,
    SPACING,
    crowd_model,
    evacuate,
    passing_time,
    steady_flow,
)
from mesa_mobility.verification.scenarios.necks import counted

LANDING = 4.0
"""Metres of level floor before a stair and after it."""

WIDTH = 2.0
"""Of a lone climber's stair, metres."""

ROOM = box(0.0, 0.0, 10.0, 8.0)
"""The room of ISO test 12."""

AGE_GROUPS = np.repeat((1.34, 1.30, 1.24, 1.20, 1.14, 1.10, 0.96), (15, 15, 15, 15, 15, 15, 10))
"""Speeds that the people of RiMEA test 13 prefer on a level floor, m/s."""

CORRIDOR = Polygon([(0, 0), (5, 0), (5, 3), (17, 3), (17, 5), (5, 5), (5, 8), (0, 8)])
FILLED = box(0.0, 0.0, 5.0, 8.0)
DOOR, MIDDLE, FOOT = box(3.0, 3.0, 5.0, 5.0), box(9.0, 3.0, 11.0, 5.0), box(15.0, 3.0, 17.0, 5.0)
"""RiMEA test 13: the room that is filled, and where densities are measured."""


def lone_climber(
    seed: int,
    *,
    up: bool,
    risers: int,
    riser: float,
    tread: float,
    preferred: float,
    kind: str | None = None,
) -> dict[str, Any]:
    """One person walks up or down a straight stair 2 m wide.

    Args:
        seed: of the run.
        up: whether they walk up.
        risers: how many.
        riser: height of each, metres.
        tread: depth of a tread, metres.
        preferred: speed that they prefer on a level floor, m/s.
        kind: their type; by default that of the map that ships.

    Returns:
        The common figures; ``passing_s``, the seconds from one edge of the stair to the other;
        ``speed_mps``, the speed along the slope, and ``ground_mps``, that in plan.
    """
    going, rise = (risers - 1) * tread, risers * riser
    slope = math.hypot(going, rise)
    start, end = box(-LANDING, 0.0, 0.0, WIDTH), box(going, 0.0, going + LANDING, WIDTH)
    out = _line(-LANDING, 0.0, WIDTH) if up else _line(going + LANDING, 0.0, WIDTH)
    building = _building(
        Level(0, end, exits=() if up else [Exit("out", *out)]),
        Level(1, start, rise, exits=[Exit("out", *out)] if up else ()),
        head=_line(0.0, 0.0, WIDTH),
        risers=risers,
        tread=tread,
    )
    types = {} if kind is None else {"pedestrian_types": (PedestrianType.named(kind),)}
    model = crowd_model(building, seed, **types)
    off_wall = max(CLEARANCE, model.pedestrian_types[0].half_width + 0.01)
    x = going + LANDING - off_wall if up else off_wall - LANDING
    model.add_pedestrians(
        building.places([(x, WIDTH / 2.0)], level=0 if up else 1),
        headings=[math.pi if up else 0.0],
        preferred_speeds=[preferred],
    )
    run = evacuate(model, 10.0 * slope / preferred)
    times, places = run.track(0)
    if up:
        places = -places
    ends = (-going, 0.0) if up else (0.0, going)
    passed = passing_time(times, places, 0, *ends)
    return {
        **run.figures(),
        "passing_s": passed,
        "speed_mps": None if passed is None else slope / passed,
        "ground_mps": None if passed is None else going / passed,
    }


def preferred_for(speed: float, *, up: bool, risers: int, riser: float, tread: float) -> float:
    """Speed on a level floor, m/s, of people who the model lets walk on a stair at ``speed``.

    Args:
        speed: along the slope, m/s.
        up: whether they walk up.
        risers: how many risers the stair has.
        riser: height of a riser, metres.
        tread: depth of a tread, metres.
    """
    going, rise = (risers - 1) * tread, risers * riser
    factor = speed_factor(riser, tread) * (UPWARDS if up else 1.0)
    return speed * going / math.hypot(going, rise) / factor


def down_from_a_room(
    seed: int, *, width: float, riser: float, tread: float, going: float, people: int = 100
) -> dict[str, Any]:
    """People who like to walk 1 m/s leave a room of 10 m x 8 m by a stair down (ISO test 12).

    Args:
        seed: of the run.
        width: clear width of the stair, metres.
        riser: height of a riser, metres.
        tread: depth of a tread, metres.
        going: length of the stair in plan, metres.
        people: in the room at the start.

    Returns:
        The common figures, and ``flow_per_s`` half-way down.
    """
    risers, end = round(going / tread) + 1, 10.0 + going + LANDING
    building = _building(
        Level(0, box(10.0 + going, 0.0, end, 8.0), exits=[Exit("out", *_line(end, 0.0, 8.0))]),
        Level(1, ROOM, risers * riser),
        head=_line(10.0, 4.0 - width / 2.0, 4.0 + width / 2.0),
        risers=risers,
        tread=tread,
    )
    model = crowd_model(building, seed)
    places = building.random_points(
        people, model.rng, level=1, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places, preferred_speeds=1.0)
    run = evacuate(model, 400.0)
    half = 10.0 + going / 2.0
    times = run.crossing_times(*_line(half, 4.0 - width / 2.0, 4.0 + width / 2.0))
    return {**run.figures(), "flow_per_s": steady_flow(times, people)}


def up_from_a_corridor(
    seed: int, *, riser: float, tread: float, people: int = 150
) -> dict[str, Any]:
    """People leave a room by a corridor 2 m wide that ends at a stair up, 3 m long in plan.

    RiMEA 3.0, test 13, and IMO test 11.

    Args:
        seed: of the run.
        riser: height of a riser, metres.
        tread: depth of a tread, metres.
        people: in the room at the start.

    Returns:
        The common figures; mean densities (1/m2) at the ``door`` of the room, in the ``middle`` of
        the corridor and at the ``foot`` of the stair while the first third of the people climb,
        ``early``, and while the last but one third does, ``late``; the mean times that people spend
        in the last two of these areas, which are equally large, ``middle_s`` and ``foot_s``; and
        flows into the corridor and onto the stair while people are in the room, ``flow_in`` and
        ``flow_up``.
    """
    risers = round(3.0 / tread) + 1
    top = box(20.0, 3.0, 20.0 + LANDING, 5.0)
    exits = [Exit("out", *_line(20.0 + LANDING, 3.0, 5.0))]
    building = _building(
        Level(0, CORRIDOR),
        Level(1, top, risers * riser, exits=exits),
        head=((20.0, 3.0), (20.0, 5.0)),
        risers=risers,
        tread=tread,
    )
    model = crowd_model(building, seed)
    filled = building.floor_plan.random_points(
        people, model.rng, within=FILLED, spacing=0.4, clearance=0.25
    )
    model.add_pedestrians(filled)
    run = evacuate(model, 600.0)
    into = run.crossing_times(*_line(5.0, 3.0, 5.0))
    onto = run.crossing_times(*_line(17.0, 3.0, 5.0))
    found: dict[str, Any] = run.figures()
    if len(onto) < people:
        return found
    thirds = [round(2.0 * onto[round(share * people) - 1]) for share in (0.05, 1 / 3, 2 / 3)]
    for name, area in (("door", DOOR), ("middle", MIDDLE), ("foot", FOOT)):
        inside = counted(run, area)
        found[f"{name}_s"] = float(inside.sum()) / 2.0 / people
        density = inside / area.area
        found[f"{name}_early"] = float(density[thirds[0] : thirds[1]].mean())
        found[f"{name}_late"] = float(density[thirds[1] : thirds[2]].mean())
    early = onto[onto <= into[-1]]
    found["flow_in"] = (len(into) - 1) / float(into[-1] - into[0])
    found["flow_up"] = (len(early) - 1) / float(early[-1] - early[0])
    return found


def along_a_stair(seed: int, *, up: bool, riser: float, tread: float) -> dict[str, Any]:
    """100 people leave a room of 10 m x 10 m over a stair 2 m wide (RiMEA 4.1.1, test 13).

    Args:
        seed: of the run.
        up: whether they walk up.
        riser: height of a riser, metres.
        tread: depth of a tread, metres; the stair is as near to 5 m long in plan as it allows.

    Returns:
        The common figures; ``density`` (k,) persons/m2 on the stair and ``along`` (k,) speeds along
        it in plan over 1.5 s, m/s, of all people on it in each frame.
    """
    risers = round(5.0 / tread) + 1
    start, end = 12.0, 12.0 + (risers - 1) * tread
    before = Polygon([(0, 0), (10, 0), (10, 4), (12, 4), (12, 6), (10, 6), (10, 10), (0, 10)])
    behind = box(end, 4.0, end + 2.0, 6.0)
    exits = [Exit("out", *_line(end + 2.0, 4.0, 6.0))]
    rise = risers * riser
    if up:
        lower, upper = Level(0, before), Level(1, behind, rise, exits=exits)
        head = ((end, 4.0), (end, 6.0))
    else:
        lower, upper = Level(0, behind, exits=exits), Level(1, before, rise)
        head = _line(start, 4.0, 6.0)
    building = _building(lower, upper, head=head, risers=risers, tread=tread)
    model = crowd_model(building, seed)
    places = building.random_points(
        len(AGE_GROUPS), model.rng, level=0 if up else 1, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places, preferred_speeds=AGE_GROUPS)
    run = evacuate(model, 400.0)
    stair = box(start, 4.0, end, 6.0)
    found = speeds_along(run.trajectories, (1.0, 0.0), window=1.5, area=stair)
    # Windows have an odd number of frames; people are in the area in the frame before the middle.
    step = np.floor(found.time * run.trajectories.frame_rate + 1e-6).astype(np.int64)
    return {
        **run.figures(),
        "density": counted(run, stair, 1.0 / run.trajectories.frame_rate)[step] / stair.area,
        "along": found.speed,
    }


def _building(
    lower: Level,
    upper: Level,
    *,
    head: tuple[tuple[float, float], tuple[float, float]],
    risers: int,
    tread: float,
) -> Building:
    """Two levels and a straight stair between them."""
    stairs = Stairs.straight("stair", upper, lower, head=head, risers=risers, tread=tread)
    return Building([lower, upper], [stairs])


def _line(x: float, low: float, high: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """A line across the way along x; its left end, as seen towards greater x, first."""
    return (x, high), (x, low)
