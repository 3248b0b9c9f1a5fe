"""Lone people who meet somebody: head-on, crossing, standing, a group, or nobody."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from shapely import LineString, MultiPoint, box

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.results import Trajectories
from mesa_mobility.verification.cases import Figures
from mesa_mobility.verification.runs import Run, crowd_model, evacuate

FloatArray = NDArray[np.float64]

SIZE = 12.0
"""Side of the square hall in which people meet, metres."""
MIDDLE = SIZE / 2
OFFSETS = np.linspace(-0.3, 0.3, 20)
"""By how much the two miss each other's line, or each other's time on it, metres."""
SPEED = 1.34
STANDS_S = 300.0
"""Pre-movement time of people who stand, seconds: longer than any of these runs."""
LIMIT_S = 60.0
GROUP_RADIUS = 0.6
"""Radius of the circle in which five people stand and talk, metres."""


def head_on(seed: int) -> Figures:
    """Two people walk towards each other; ``closest`` (20,) approach in metres, by offset."""
    return _meet(seed, [((1.0, MIDDLE), "east"), ((SIZE - 1.0, MIDDLE), "west")], (0.0, 1.0))


def crossing(seed: int) -> Figures:
    """Two people on a collision course at 90 degrees; ``closest`` (20,) as for ``head_on``."""
    return _meet(seed, [((1.0, MIDDLE), "east"), ((MIDDLE, 1.0), "north")], (1.0, 0.0))


def past_standing(seed: int) -> Figures:
    """A person walks past a standing person; ``closest`` (20,) as for ``head_on``."""
    return _meet(seed, [((1.0, MIDDLE), "east")], (0.0, 1.0), standing=[(MIDDLE, MIDDLE)])


def past_group(seed: int) -> Figures:
    """A person meets five people who stand in a circle; ``through`` counts walks through it."""
    angles = np.linspace(0.0, 2.0 * np.pi, 5, endpoint=False) + 0.3
    circle = GROUP_RADIUS * np.column_stack([np.cos(angles), np.sin(angles)]) + MIDDLE
    runs = _runs(seed, [((1.0, MIDDLE), "east")], (0.0, 1.0), circle.tolist())
    inside = MultiPoint(circle).convex_hull
    through = sum(LineString(run.track(0)[1]).intersects(inside) for run in runs)
    return {**_together(runs), "through": through / len(runs)}


def from_standing(seed: int) -> Figures:
    """Twenty people set off alone; ``first_second`` (20,) metres covered in the first second."""
    runs = _runs(seed, [((1.0, MIDDLE), "east")], (0.0, 1.0), [])
    covered = []
    for run in runs:
        times, places = run.track(0)
        after = int(np.searchsorted(times, times[0] + 1.0))
        covered.append(float(np.hypot(*(places[after] - places[0]))))
    return {**_together(runs), "first_second": np.array(covered)}


def _meet(
    seed: int,
    walkers: Sequence[tuple[tuple[float, float], str]],
    shift: tuple[float, float],
    standing: Sequence[tuple[float, float]] = (),
) -> Figures:
    runs = _runs(seed, walkers, shift, standing)
    return {**_together(runs), "closest": np.array([_closest(run.trajectories) for run in runs])}


def _runs(
    seed: int,
    walkers: Sequence[tuple[tuple[float, float], str]],
    shift: tuple[float, float],
    standing: Sequence[Sequence[float]],
) -> list[Run]:
    """A run for each offset, by which the first walker's start is shifted."""
    found = []
    for number, offset in enumerate(OFFSETS):
        model = crowd_model(_hall(), seed=len(OFFSETS) * seed + number)
        for k, ((x, y), exit_name) in enumerate(walkers):
            by = offset if k == 0 else 0.0
            place = (x + by * shift[0], y + by * shift[1])
            model.add_pedestrians([place], preferred_speeds=SPEED, exits=[exit_name])
        if len(standing):
            model.add_pedestrians(standing, pre_movement=STANDS_S)
        found.append(_until_walkers_left(model, len(walkers)))
    return found


def _hall() -> FloorPlan:
    ends = {
        "east": ((SIZE, 0.0), (SIZE, SIZE)),
        "west": ((0.0, 0.0), (0.0, SIZE)),
        "north": ((0.0, SIZE), (SIZE, SIZE)),
    }
    exits = [Exit(name, *line) for name, line in ends.items()]
    return FloorPlan(box(0.0, 0.0, SIZE, SIZE), exits=exits)


def _until_walkers_left(model: PedestrianModel, walkers: int) -> Run:
    standing = model.inside - walkers
    if standing == 0:
        return evacuate(model, LIMIT_S)
    walls = model.floor_plan.walls
    while model.inside > standing and model.elapsed < LIMIT_S:
        model.step()
    return Run(model, walls)


def _closest(tracks: Trajectories) -> float:
    """Least distance in metres between the first person and any other."""
    first = tracks.person == 0
    x, y = np.full(tracks.frames, np.nan), np.full(tracks.frames, np.nan)
    x[tracks.frame[first]], y[tracks.frame[first]] = tracks.x[first], tracks.y[first]
    frame = tracks.frame[~first]
    away = np.hypot(tracks.x[~first] - x[frame], tracks.y[~first] - y[frame])
    return float(np.nanmin(away))


def _together(runs: Sequence[Run]) -> dict[str, Any]:
    """Figures of several runs as of one."""
    figures = [run.figures() for run in runs]
    summed = ("pedestrians", "person_s", "overlaps", "wall_crossings", "off_floor")
    person_s = sum(each["person_s"] for each in figures)
    spent = sum(each["fallback_time_share"] * each["person_s"] for each in figures)
    return {
        **{name: sum(each[name] for each in figures) for name in summed},
        "fallback_time_share": spent / person_s,
    }
