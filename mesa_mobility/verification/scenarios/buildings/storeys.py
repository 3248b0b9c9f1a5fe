"""Buildings of several storeys: rooms that empty down one stair, and a way over stairs or round."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from shapely import Polygon, box

from mesa_mobility import Building, Exit, Level, Stairs
from mesa_mobility.distributions import Uniform
from mesa_mobility.results import climbs
from mesa_mobility.verification.runs import CLEARANCE, SPACING, crowd_model, evacuate

RISERS, TREAD, RISE = 18, 0.29, 3.06
"""Of all stairs here; metres."""

STOREYS, ROOMS, IN_A_ROOM = 3, 38, 4
"""RiMEA test 8: storeys, rooms on each, and people in a room."""

LIMIT_S = 2000.0

GOING = (RISERS - 1) * TREAD
"""Of a straight stair of the building for RiMEA test 14, metres."""

BRIDGE = box(10.0, 0.0, 14.0, 2.0)
"""Its upper level."""

GROUND = shapely.union_all(
    [
        box(0.0, 0.0, 10.0 - GOING, 2.0),
        box(0.0, 0.0, 2.0, 30.0),
        box(0.0, 28.0, 24.0, 30.0),
        box(22.0, 0.0, 24.0, 30.0),
        box(14.0 + GOING, 0.0, 24.0, 2.0),
    ]
)
"""Its ground floor: from the one end to the other there is a way round, 2 m wide."""


def full_house(seed: int, *, low: float, high: float) -> dict[str, Any]:
    """Three storeys of rooms along a corridor empty down one stair (RiMEA test 8).

    Args:
        seed: of the run.
        low: least preferred speed, m/s.
        high: greatest preferred speed, m/s; speeds are even between the two.
    """
    building = house()
    model = crowd_model(building, seed)
    places = np.concatenate([building.places(beds(), level) for level in range(STOREYS)])
    if low < high:
        speeds = Uniform(low, high).draw(len(places), model.rng)
    else:
        speeds = np.full(len(places), low)
    model.add_pedestrians(places, preferred_speeds=speeds)
    return evacuate(model, LIMIT_S).figures()


def house() -> Building:
    """The building of RiMEA test 8.

    Rooms are 2 m wide and 3 m deep between the middles of their walls, with doors of 1 m, on both
    sides of a corridor 1 m wide. It leads to a landing 4.2 m wide and 2 m deep at the head and the
    foot of dog-legged stairs 2 m wide. On the ground floor, one side of the landing is the exit.
    """
    parts = [box(0.0, 1.4, 2.0, 5.6), box(2.0, 3.0, 40.0, 4.0)]
    for x in _rooms():
        for wall, door, back in ((2.8, 3.0, 0.0), (4.2, 4.0, 7.0)):
            parts.append(box(x, min(wall, back), x + 1.8, max(wall, back)))
            parts.append(box(x + 0.4, min(wall, door), x + 1.4, max(wall, door)))
    floor = shapely.union_all(parts)
    out = [Exit("out", (0.0, 1.4), (2.0, 1.4))]
    levels = [Level(k, floor, k * RISE, exits=[] if k else out) for k in range(STOREYS)]
    stairs = [
        Stairs.dog_leg(
            f"stair {k}",
            k,
            k - 1,
            head=((0.0, 1.4), (0.0, 3.4)),
            risers=RISERS,
            tread=TREAD,
            turn="right",
        )
        for k in range(1, STOREYS)
    ]
    return Building(levels, stairs)


def beds() -> np.ndarray:
    """(n, 2) where people start on a storey of the house, four in a room, metres."""
    ends = (0.7, 1.9, 5.1, 6.3)
    return np.array([(x + across, y) for x in _rooms() for across in (0.45, 1.35) for y in ends])


def _rooms() -> np.ndarray:
    """Least x of the rooms along one side of the corridor, metres."""
    return 2.1 + 2.0 * np.arange(ROOMS // 2)


def over_or_round(seed: int, *, closed: bool, people: int = 20) -> dict[str, Any]:
    """People go up one stair and down another, or a longer way on their level (RiMEA test 14).

    Args:
        seed: of the run.
        closed: whether the first stair is closed.
        people: at the start.

    Returns:
        The common figures, and the people who went ``over`` the stairs and ``round``.
    """
    building = two_ways()
    if closed:
        building.floor_plan.close_gate("west before")
    model = crowd_model(building, seed)
    places = building.floor_plan.random_points(
        people,
        model.rng,
        within=box(0.0, 0.0, 4.0, 2.0),
        spacing=SPACING,
        clearance=CLEARANCE,
    )
    model.add_pedestrians(places)
    run = evacuate(model, 300.0)
    west = climbs(run.trajectories, building)["west"]
    return {
        **run.figures(),
        "over": len(np.unique(west.person[west.up])),
        "round": len(run.crossing_times((0.0, 15.0), (2.0, 15.0))),
    }


def two_ways() -> Building:
    """The building of RiMEA test 14: 22 m over two stairs, or 76 m round on the ground floor."""
    ground = Level(0, Polygon(GROUND), exits=[Exit("out", (24.0, 0.0), (24.0, 2.0))])
    bridge = Level(1, BRIDGE, RISE)
    return Building(
        [ground, bridge],
        [
            Stairs.straight(
                "west", bridge, ground, ((10.0, 0.0), (10.0, 2.0)), risers=RISERS, tread=TREAD
            ),
            Stairs.straight(
                "east", bridge, ground, ((14.0, 2.0), (14.0, 0.0)), risers=RISERS, tread=TREAD
            ),
        ],
    )
