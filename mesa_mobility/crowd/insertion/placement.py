"""Putting newcomers on the floor: where they may stand, and their records."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.crowd.insertion.free_space import too_close
from mesa_mobility.crowd.insertion.newcomers import Newcomers, check_column, distinct
from mesa_mobility.crowd.insertion.suited_places import suited
from mesa_mobility.crowd.scene import Scene
from mesa_mobility.crowd.state.records import NO_CORNER, NO_OPTION, Crowd
from mesa_mobility.crowd.state.twins import with_copies
from mesa_mobility.errors import MobilityError, ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.walls.wall_distances import distances_to_walls
from mesa_mobility.plugins.output import numbers_in

MOST_TURNED = 1e6
"""Largest heading that is accepted, radians either way: beyond it, digits of the angle are lost."""

TOUCHING = 1e-6
"""Overlap with a wall that counts as rounding, metres."""


@dataclass(frozen=True)
class Assigned:
    """Values that newcomers have in common: type index, standing cluster, destination, and number
    of the journey, 0 for none."""

    type_index: int
    standing: int
    destination: int
    journey: int


def place_newcomers(
    scene: Scene,
    positions: ArrayLike,
    new: Newcomers,
    frame: int,
    rng: np.random.Generator,
    *,
    count: int,
    present: NDArray[np.int64],
) -> NDArray[np.int64]:
    """Put people on the floor, standing or moving.

    Args:
        scene: the floor and what people can do on it.
        positions: (n, 2) metres.
        new: who they are.
        frame: now.
        rng: the model's generator, from which speeds and times are drawn.
        count: people who have ever been in the model; newcomers get the rows from there on.
        present: (k,) rows of those inside.

    Returns:
        (n,) their rows.

    Raises:
        ModelError: see ``PedestrianModel.add_pedestrians``.
        FloorPlanError: see there.
    """
    if len(scene.crowd.person_of):
        raise ModelError(
            "add_pedestrians: in a building nobody can be added while others decide, expected a "
            "call between two steps"
        )
    points = check_places(positions, scene.plan)
    n = len(points)
    if new.type_index is None and new.population is None:
        new = replace(new, population=scene.shares)
    kinds = new.draw_types(n, scene.types, rng)
    ways = {
        kind: scene.journeys.start(new.exits, new.route, new.loop, kind) for kind in distinct(kinds)
    }
    if new.population is not None and len(ways) > 1:
        kinds = _suited(scene, points, kinds, ways, present, rng)
    speeds = new.draw_speeds(kinds, scene.types, rng)
    sets_off = frame + new.draw_waits(n, rng)
    _check_headings(new, n)
    cores = new.draw_cores(kinds, scene.types, rng)
    fields = new.field_columns(n, scene.crowd)
    rows = np.arange(count, count + n, dtype=np.int64)
    if count + n > len(scene.crowd.x):
        scene.crowd.grow(max(count + n, 2 * len(scene.crowd.x)))
    placed = rows[:0]
    try:
        for kind, (destination, journey) in ways.items():
            own = np.flatnonzero(kinds == kind)
            of, there = scene.types[kind], points[own]
            check_beside_walls(there, of.half_width, scene.plan, own)
            others = np.concatenate([present, placed])
            _check_room(scene, there, of.half_width, frame, own, others, count)
            scene.environment.check_way_out(there, destination)
            assigned = Assigned(
                type_index=kind,
                standing=int(scene.rules.standing[kind]),
                destination=destination,
                journey=journey,
            )
            write_records(
                scene.crowd,
                rows[own],
                there,
                cores[own],
                speeds[own],
                frame,
                sets_off[own],
                assigned,
            )
            placed = np.sort(np.concatenate([placed, rows[own]]))
    except MobilityError:
        scene.crowd.active[placed] = False
        raise
    for name, values in fields.items():
        scene.crowd.fields[name][rows] = values
    if new.velocities is not None:
        _set_moving(scene, rows, kinds, new, rng)
    return rows


def _set_moving(
    scene: Scene,
    rows: NDArray[np.int64],
    kinds: NDArray[np.int64],
    new: Newcomers,
    rng: np.random.Generator,
) -> None:
    """Let newcomers have just ended movements with their velocities, and begin the next."""
    crowd, found = scene.crowd, scene.repertoire
    velocities = np.asarray(new.velocities, dtype=np.float64)
    headings = np.asarray(new.headings, dtype=np.float64)
    c, s = np.cos(headings), np.sin(headings)
    ahead = np.column_stack(
        [velocities[:, 0] * c + velocities[:, 1] * s, velocities[:, 1] * c - velocities[:, 0] * s]
    )
    crowd.vx[rows], crowd.vy[rows] = velocities.T
    for kind in distinct(kinds):
        own = kinds == kind
        clusters = found.capabilities[kind].clusters_at(ahead[own], rng)
        crowd.cluster[rows[own]] = found.first_cluster[kind] + clusters


def _check_headings(new: Newcomers, n: int) -> None:
    """Refuse headings of ``n`` newcomers that are no angles in radians."""
    if new.headings is None:
        return
    headings = check_column("headings", new.headings, n)
    off = np.abs(headings) > MOST_TURNED
    if off.any():
        raise ModelError(
            f"headings: got {headings[off][0]:g}, expected radians, {MOST_TURNED:g} at most either "
            "way"
        )


def _suited(
    scene: Scene,
    points: NDArray[np.float64],
    kinds: NDArray[np.int64],
    ways: dict[int, tuple[int, int]],
    present: NDArray[np.int64],
    rng: np.random.Generator,
) -> NDArray[np.int64]:
    """(n,) the same types, at places with room for their bodies and a way out as wide."""
    cores = np.array([kind.half_width for kind in scene.types])
    crowd = scene.crowd
    others, radii = np.column_stack([crowd.x[present], crowd.y[present]]), crowd.core[present]

    def suits(kind: int) -> NDArray[np.bool_]:
        away = distances_to_walls(scene.plan, points, float(cores[kind]))
        lost = scene.environment.without_way_out(points, ways[kind][0])
        return (away >= cores[kind] - TOUCHING) & ~lost

    if not scene.rules.hard_bodies:
        others, radii = others[:0], radii[:0]
    found, short = suited(points, kinds, cores, suits, (others, radii), rng)
    if short is not None:
        kind, room = short
        raise ModelError(
            f"population: {int((kinds == kind).sum())} people are of type "
            f"{scene.types[kind].name!r}, but only {room} of them can stand at the "
            f"{len(points)} places and leave, expected room and a way out for bodies of "
            f"{cores[kind]:g} m radius"
        )
    return found


def _check_room(
    scene: Scene,
    points: NDArray[np.float64],
    radius: float,
    frame: int,
    numbers: NDArray[np.int64],
    there: NDArray[np.int64],
    count: int,
) -> None:
    """Refuse places without room beside people ``there``, of whom rows from ``count`` on are new.

    Newcomers have bodies of this ``radius``.  The error names people by their (n,) ``numbers``.
    """
    if not scene.rules.hard_bodies:
        return
    places, owners = with_copies(scene.strips, points, radius)
    where, who = too_close(
        places,
        radius,
        frame,
        there,
        scene.repertoire.table,
        scene.crowd.records,
        scene.rules.search_radius,
    )
    if where >= 0:
        where = owners[where]
        newcomer = who < 0 or who >= count
        other = "another newcomer" if newcomer else f"where pedestrian {who} is or will be"
        raise ModelError(
            f"pedestrian {numbers[where]} at {points[where].tolist()}: too close to {other}, "
            "expected room for both bodies"
        )


def check_places(positions: ArrayLike, plan: FloorPlan) -> NDArray[np.float64]:
    """(n, 2) positions as an array.

    Raises:
        ModelError: the wrong shape, or positions off the floor or on a copied part of a strip.
    """
    points = numbers_in("positions", positions, "(n, 2) metres")
    if points.size == 0:
        points = points.reshape(0, 2)
    if points.ndim != 2 or points.shape[1] != 2:
        raise ModelError(f"positions: shape {points.shape}, expected (n, 2)")
    off = ~plan.contains(points)
    if off.any():
        k = int(np.argmax(off))
        raise ModelError(f"pedestrian {k} at {points[k].tolist()}: expected a place on the floor")
    if plan.seams:
        copied = shapely.intersects_xy(plan.copied, points[:, 0], points[:, 1])
        if copied.any():
            k = int(np.argmax(copied))
            raise ModelError(
                f"pedestrian {k} at {points[k].tolist()}: on a part of a strip that belongs to "
                "another sheet, expected the same place on that sheet"
            )
    return points


def check_beside_walls(
    points: NDArray[np.float64],
    core: float,
    plan: FloorPlan,
    numbers: NDArray[np.int64] | None = None,
) -> None:
    """Raise ModelError where bodies with this core radius, in metres, have no room between walls.

    The error names people by their (n,) ``numbers``, by default 0, 1 and so on.

    A body that touches a wall at the start could not move away from it, or would stand across it.
    """
    away = distances_to_walls(plan, points, core)
    near = away < core - TOUCHING
    if near.any():
        k = int(np.argmax(near))
        raise ModelError(
            f"pedestrian {k if numbers is None else numbers[k]} at {points[k].tolist()}: "
            f"{away[k]:.3f} m from a wall, expected room "
            f"for its body, {core:g} m"
        )


def write_records(
    state: Crowd,
    rows: NDArray[np.int64],
    points: NDArray[np.float64],
    cores: NDArray[np.float64],
    speeds: NDArray[np.float64],
    frame: int,
    sets_off: NDArray[np.int64],
    new: Assigned,
) -> None:
    """Fill the rows of people who appear standing at ``points``; headings are set later.

    They are committed to standing until the frame in ``sets_off``.
    """
    state.x[rows], state.y[rows] = points.T
    state.preferred[rows] = speeds
    state.core[rows], state.type_index[rows] = cores, new.type_index
    state.destination[rows], state.cluster[rows] = new.destination, new.standing
    state.vx[rows] = state.vy[rows] = 0.0
    state.option[rows], state.gone[rows] = NO_OPTION, -1
    state.start[rows], state.end[rows] = frame, sets_off
    waits = sets_off > frame
    state.spacing[rows] = np.where(waits, sets_off - frame, 1)
    state.knots[rows] = 1 + waits
    state.from_x[rows], state.from_y[rows] = state.to_x[rows], state.to_y[rows] = points.T
    state.box[rows] = np.column_stack([points, points])
    state.stride[rows] = 0.0
    state.active[rows] = True
    agenda = state.agenda
    agenda["speed"][rows] = speeds
    agenda["journey"][rows], agenda["crossed"][rows] = new.journey, 0
    agenda["checked"][rows] = frame - 1
    agenda["nearest"][rows] = np.inf
    agenda["pace"][rows], agenda["tread"][rows] = 1.0, 0.0
    agenda["corner"][rows] = NO_CORNER
    agenda["sets_off"][rows] = agenda["waits_until"][rows] = sets_off


def face(state: Crowd, rows: NDArray[np.int64], headings: ArrayLike) -> None:
    """Turn people who have just been placed."""
    state.heading[rows] = state.from_heading[rows] = state.to_heading[rows] = headings
