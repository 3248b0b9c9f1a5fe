"""Scenes without measured figures: what people must be able to do, whatever else is calibrated."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from mesa_mobility.behaviors import WalkingAbreast
from mesa_mobility.models import StraightWalk
from shapely import box

from benchmarks.conflicts import corridor, narrow
from benchmarks.default_preset.closeness import beyond
from mesa_mobility import Exit, FloorPlan
from mesa_mobility.verification.references import bottleneck_envelope
from mesa_mobility.verification.runs import crowd_model
from mesa_mobility.verification.scenarios import counterflow, necks, walks
from mesa_mobility.verification.scenarios.buildings import stairs

LIMIT_S = 240.0
LONG_NECK_M = 1.1, 4.0
"""Width and length of a neck, metres."""
RISER, TREAD = 0.17, 0.3
"""Of a stair, metres."""

GOALS: dict[str, tuple[float, float, float]] = {
    "two_way_door": (0.0, 60.0, 10.0),
    "through_each_other": (0.0, 0.0, 20.0),
    "meeting": (0.65, 1.05, 0.05),
    "setting_off": (0.952, 1.05, 0.006),
    "own_speed": (0.0, 0.025, 0.01),
    "abreast": (0.67, 0.83, 0.04),
    "mixed_corridor": (0.0, 0.0, 1.5),
    "round_somebody": (0.0, 8.0, 4.0),
    "long_neck": (*bottleneck_envelope(LONG_NECK_M[0]), 0.05),
    "foot_of_stair": (0.3, 30.0, 0.3),
}
"""The range in which what each scene gives should be, and how far outside counts as 1."""


def two_way_door(seed: int) -> float:
    """Seconds until 25 people from either side have passed a door 1 m wide, and two more for each
    who has not."""
    plan = narrow.two_rooms(1.0, 0.2)
    model = crowd_model(plan, seed)
    starts = ((box(3.5, 1, 9.5, 7), "east"), (box(10.7, 1, 16.7, 7), "west"))
    for start, goal in starts:
        places = plan.random_points(25, model.rng, within=start, spacing=0.5, clearance=0.3)
        model.add_pedestrians(places, exits=[goal])
    model.run(max_seconds=LIMIT_S)
    return model.elapsed + 2.0 * model.inside


def through_each_other(seed: int) -> float:
    """How many of 100 people against 100 in a corridor 2 m wide have not arrived when FDS+Evac is
    done (IMO test 8)."""
    found = counterflow.counterflow(seed, opposing=100, limit_s=counterflow.FDS_EVAC_S)
    return float(found["left_inside"])


def meeting(seed: int) -> float:
    """Least distance, in metres, of two people who meet head-on in the open; the smaller one of two
    tries."""
    return min(_meet(seed, aside) for aside in (0.0, 0.2))


def _meet(seed: int, aside: float) -> float:
    exits = [Exit("east", (40, 19), (40, 21)), Exit("west", (0, 19), (0, 21))]
    model = crowd_model(FloorPlan(box(0, 0, 40, 40), exits=exits), seed)
    one, other = (
        *model.add_pedestrians([(16.0, 20.0)], exits=["east"]),
        *model.add_pedestrians([(24.0, 20.0 + aside)], exits=["west"], headings=[math.pi]),
    )
    least = math.inf
    for _ in range(240):
        model.step()
        least = min(least, float(np.hypot(*(one.position - other.position))))
    return least


def setting_off(seed: int) -> float:
    """Least mean speed of 50 people who set off and walk 40 m, as a share of the preferred one."""
    model = StraightWalk(record=True, rng=seed)
    wanted = np.array([person.preferred_speed for person in model.agents])
    model.run(max_seconds=120)
    rows = model.recorder.arrays()
    shares = []
    for person, speed in enumerate(wanted):
        own = np.flatnonzero(rows["person"] == person)
        own = own[np.argsort(rows["frame"][own])]
        way = rows["x"][own[-1]] - rows["x"][own[0]]
        shares.append(way * 30.0 / (rows["frame"][own[-1]] - rows["frame"][own[0]]) / speed)
    return float(min(shares))


def own_speed(seed: int) -> float:
    """By how much, at most, 50 people of all ages miss the speed that they want, m/s (RiMEA test
    7)."""
    found = walks.speeds_by_age(seed, people=50, youngest=20.0, oldest=80.0)
    missed = np.abs(np.array(found["walked_mps"], dtype=np.float64) - found["assigned_mps"])
    return float(np.nanmax(missed))


def abreast(seed: int) -> float:
    """Mean distance, in metres, of two friends who walk side by side in a corridor of 1.5 m."""
    plan = FloorPlan(box(0, 0, 36, 1.5), exits=[Exit("end", (36, 0), (36, 1.5))])
    model = crowd_model(plan, seed, frames_per_step=3)
    model.add_tactic(WalkingAbreast())
    friends = model.add_pedestrians(
        [(1.0, 0.75), (1.8, 0.75)], preferred_speeds=1.22, group="friends"
    )
    apart = []
    while model.inside == 2 and model.elapsed < 60.0:
        model.step()
        (x, y), (other_x, other_y) = (person.position for person in friends)
        if 12.0 < (x + other_x) / 2.0 < 32.0:
            apart.append(abs(y - other_y))
    return float(np.mean(apart)) if apart else 0.0


def mixed_corridor(seed: int) -> float:
    """How many of 16 people of every type are left in a two-way corridor 1.6 m wide."""
    model, _ = corridor.crowd(seed, width=1.6, population="every_type")
    model.run(max_seconds=LIMIT_S)
    return float(model.inside)


def round_somebody(seed: int) -> float:
    """Seconds that somebody takes to get past a person who stands 0.35 m ahead of them."""
    plan = FloorPlan(box(0, 0, 12, 6), exits=[Exit("end", (12, 1), (12, 5))])
    model = crowd_model(plan, seed)
    model.add_pedestrians([(4.35, 3.0)], pre_movement=[1e5])
    (walker,) = model.add_pedestrians([(4.0, 3.0)])
    while model.elapsed < 30.0 and walker.position[0] < 6.0:
        model.step()
    return model.elapsed


def long_neck(seed: int) -> float:
    """Flow through a neck as long as a short corridor, persons a second."""
    width, length = LONG_NECK_M
    found = necks.neck(seed, width=width, length=length, goal=8.0, people=120)
    return float(found["flow_per_s"] or 0.0)


def foot_of_stair(seed: int) -> float:
    """How much longer people spend at the foot of a stair than in the corridor before it, s."""
    found = stairs.up_from_a_corridor(seed, riser=RISER, tread=TREAD, people=130)
    return float(found["foot_s"] - found["middle_s"]) if "foot_s" in found else -1.0


def outside(simulated: float, wanted: Sequence[float]) -> float:
    """How far a scene is outside its range: (low, high, how far counts as 1)."""
    low, high, tolerance = wanted
    return beyond(simulated, low, high, tolerance)
