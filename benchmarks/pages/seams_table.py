"""Table of docs/explanation/stairs.md: the same floor in one drawing, and cut at seams.

python benchmarks/pages/seams_table.py --seeds 40 --out FOLDER
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from blocks import give, table
from numpy.typing import NDArray
from shapely import box
from shapely.affinity import translate
from stairs_scenes import GOING, RISE, RISERS, TREAD, WIDTH, middle_flow

from mesa_mobility import Building, Exit, FloorPlan, Level, Stairs
from mesa_mobility.floorplan import Seam, SpeedZone
from mesa_mobility.verification.runs import crowd_model, evacuate

LIMIT_S = 900.0
PEOPLE = 60
NECK = 0.9
"""Width of the corridor, metres."""

ROOM = box(-8, -3, 0, 3 + WIDTH)

APART = 60.0
"""Metres between two drawings."""

MIDDLE, DEPTH = 6.0, 3.5
"""Where the corridor is cut, and how far both drawings go on behind that line, metres."""

LANDING, FLIGHTS = 1.5, 2
"""Metres of a landing between two flights, and their number."""

DRAWN = 10_000
"""Resamples for an interval."""


def main() -> None:
    """Run all seeds, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=40, help="seeds 1 to this; half for stairs")
    parser.add_argument("--out", type=Path, required=True, help="folder for the table")
    given = parser.parse_args()
    rows, runs = [], []
    for name, scene, seeds in (
        (f"corridor of {NECK:g} m", corridor, given.seeds),
        ("stair of three storeys", stair, given.seeds // 2),
    ):
        whole, cut = (
            [leave(scene(parts), seed) for seed in range(1, seeds + 1)] for parts in (False, True)
        )
        runs += whole + cut
        for figure, unit in (("last out", "s"), ("flow", "persons/s")):
            one, other = (np.array([run[figure] for run in each]) for each in (whole, cut))
            low, high = ratio_interval(one, other)
            rows.append(
                (
                    name,
                    f"{figure}, {unit}",
                    f"{one.mean():.2f}",
                    f"{other.mean():.2f}",
                    f"{other.mean() / one.mean():.3f} ({low:.3f} to {high:.3f})",
                )
            )
    heads = ("floor", "figure", "whole", "cut", "ratio (90 % interval)")
    text = (
        f"{PEOPLE} people, {given.seeds} seeds in the corridor and {given.seeds // 2} on the stair."
    )
    left = sum(run["left"] for run in runs)
    give(given.out, "seams", f"{text} People left inside {left}.\n\n{table(heads, rows)}")


def corridor(cut: bool) -> FloorPlan:
    """A room and a corridor with an exit at its end."""
    floor = ROOM.union(box(0, -NECK / 2, 12, NECK / 2))
    if not cut:
        return FloorPlan(floor, exits=[Exit("out", (12, -NECK / 2), (12, NECK / 2))])
    first = floor.intersection(box(-20, -10, MIDDLE + DEPTH, 10))
    second = floor.intersection(box(MIDDLE - DEPTH, -10, 20, 10))
    end = 12.0 + APART
    line = ((MIDDLE, NECK / 2), (MIDDLE, -NECK / 2))
    plan = FloorPlan(
        shapely.MultiPolygon([first, translate(second, APART)]),
        exits=[Exit("out", (end, -NECK / 2), (end, NECK / 2))],
        seams=[Seam("cut", *line, (APART, 0.0), DEPTH, stepless=True)],
    )
    return plan


def stair(cut: bool) -> FloorPlan | Building:
    """A room, two flights down with a landing between them, and a corridor with an exit."""
    pitch = GOING + LANDING
    last = FLIGHTS * pitch
    floors = [box(pitch * k - LANDING, 0, pitch * k, WIDTH) for k in range(1, FLIGHTS)]
    floors = [ROOM, *floors, box(last - LANDING, 0, last + 2, WIDTH)]
    out = [Exit("out", (last + 2, 0), (last + 2, WIDTH))]
    levels = [
        Level(FLIGHTS - k, floor, (FLIGHTS - k) * RISE, exits=out if k == FLIGHTS else [])
        for k, floor in enumerate(floors)
    ]
    stairs = [
        Stairs.straight(
            f"stair {k}",
            levels[k],
            levels[k + 1],
            ((pitch * k, WIDTH), (pitch * k, 0.0)),
            risers=RISERS,
            tread=TREAD,
        )
        for k in range(FLIGHTS)
    ]
    building = Building(levels, stairs)
    if cut:
        return building
    like = building.floor_plan.zones[0]
    flights = [box(pitch * k, 0, pitch * k + GOING, WIDTH) for k in range(FLIGHTS)]
    zones = [
        SpeedZone(
            flight,
            like.factor,
            f"stair {k}",
            uphill=like.uphill,
            downhill=(1.0, 0.0),
            tread=like.tread,
        )
        for k, flight in enumerate(flights)
    ]
    return FloorPlan(shapely.union_all([*floors, *flights]), exits=out, zones=zones)


def leave(plan: FloorPlan | Building, seed: int) -> dict[str, Any]:
    """People of a room leave: when the last one is out, s, and the flow of the middle two thirds,
    persons/s."""
    model = crowd_model(plan, seed)
    spaced = {"spacing": 0.6, "clearance": 0.25}
    if isinstance(plan, Building):
        start = plan.random_points(PEOPLE, model.rng, level=FLIGHTS, **spaced)
    else:
        start = plan.random_points(PEOPLE, model.rng, within=ROOM, **spaced)
    model.add_pedestrians(start)
    run = evacuate(model, LIMIT_S)
    tracks = run.trajectories
    frames = np.zeros(PEOPLE)
    np.maximum.at(frames, tracks.person, tracks.frame)
    out = np.sort(frames / tracks.frame_rate)
    return {"left": model.inside, "last out": out[-1], "flow": middle_flow(out, PEOPLE)}


def ratio_interval(one: NDArray[np.float64], other: NDArray[np.float64]) -> tuple[float, float]:
    """The 90 % interval of the ratio of two means, by resampling of each."""
    rng = np.random.default_rng(1)
    first, second = (rng.choice(each, (DRAWN, len(each))).mean(axis=1) for each in (one, other))
    low, high = np.percentile(second / first, (5.0, 95.0))
    return float(low), float(high)


if __name__ == "__main__":
    main()
