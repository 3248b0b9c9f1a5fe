"""Inserting people on the floor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.compiled.decorators import kept
from mesa_mobility.crowd.collision.exact import swept_collision
from mesa_mobility.crowd.options.table import OptionTable
from mesa_mobility.crowd.pedestrian_type import PedestrianType, indices_of
from mesa_mobility.crowd.planning.grid import Grid, build_grid, people_within
from mesa_mobility.crowd.state.records import NO_CORNER, NO_OPTION, Crowd, CrowdState
from mesa_mobility.crowd.tactics.speed_rules import FASTEST
from mesa_mobility.crowd.tactics.waiting import frames_of
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.poisson_disk import have_room
from mesa_mobility.floorplan.walls.line_of_sight import distances_to_walls
from mesa_mobility.plugins.output import numbers_given
from mesa_mobility.populations import Population

TOUCHING = 1e-6
"""Overlap with a wall that counts as rounding, metres."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Newcomers:
    """Newcomers, described as in ``PedestrianModel.add_pedestrians``.

    Raises:
        ModelError: exits that are one text, a loop without a route, or a group without a name.
    """

    headings: ArrayLike | None = None
    preferred_speeds: ArrayLike | Distribution | None = None
    pre_movement: ArrayLike | Distribution = 0.0
    exits: Sequence[str] | None = None
    route: Sequence[str] = ()
    loop: bool = False
    group: str | int | None = None
    type_index: ArrayLike | None = None
    population: Population | None = None

    def __post_init__(self) -> None:
        if isinstance(self.exits, str):
            raise ModelError(
                f"exits: got {self.exits!r}, expected a list of names such as [{self.exits!r}]"
            )
        if self.loop and not len(self.route):
            raise ModelError("loop: got no route, expected names of at least two gates")
        if self.group is not None and not isinstance(self.group, str | int):
            raise ModelError(f"group: got {self.group!r}, expected a name or number")
        if self.type_index is not None and self.population is not None:
            raise ModelError("type_index and population: got both, expected one of them")

    def draw_types(
        self, n: int, types: Sequence[PedestrianType], rng: np.random.Generator
    ) -> NDArray[np.int64]:
        """(n,) index of each one's type.

        Raises:
            ModelError: there is no such type, or another number of them.
        """
        if self.population is not None:
            return indices_of(self.population, types)[self.population.draw(n, rng)]
        return check_types(self.type_index, n, types)

    def draw_speeds(
        self, kinds: NDArray[np.int64], types: Sequence[PedestrianType], rng: np.random.Generator
    ) -> NDArray[np.float64]:
        """(n,) preferred speeds of people of these types, m/s.

        Raises:
            ModelError: another number of them, or one out of range.
        """
        given, n = self.preferred_speeds, len(kinds)
        if given is None:
            given = np.empty(n)
            for kind in distinct(kinds):
                own = kinds == kind
                given[own] = draw_column(
                    "preferred_speeds", types[kind].draw_speeds(int(own.sum()), rng), own.sum(), rng
                )
        speeds = draw_column("preferred_speeds", given, n, rng)
        off = ~((speeds > 0.0) & (speeds <= FASTEST))
        if off.any():
            raise ModelError(
                f"preferred_speeds: got {speeds[off][0]}, expected more than 0 and at most "
                f"{FASTEST:g} m/s"
            )
        return speeds

    def draw_waits(self, n: int, rng: np.random.Generator) -> NDArray[np.int64]:
        """(n,) pre-movement times in frames.

        Raises:
            ModelError: another number of them, or one out of range.
        """
        return frames_of(draw_column("pre_movement", self.pre_movement, n, rng), "pre_movement")


@dataclass(frozen=True)
class Assigned:
    """Values that newcomers have in common: type index, core radius in metres, standing cluster,
    destination, and number of the journey, 0 for none."""

    type_index: int
    core: float
    standing: int
    destination: int
    journey: int


def check_types(
    values: ArrayLike | None, n: int, types: Sequence[PedestrianType]
) -> NDArray[np.int64]:
    """(n,) indices of types; a single one stands for all, None for the first.

    Raises:
        ModelError: there is no such type, or another number of them.
    """
    try:
        given = np.zeros((), dtype=np.int64) if values is None else np.asarray(values)
        whole = np.issubdtype(given.dtype, np.integer) and given.shape in ((n,), ())
    except ValueError:  # rows of unequal length
        whole = False
    if not whole or ((given < 0) | (given >= len(types))).any():
        raise ModelError(
            f"type_index: got {values!r}, expected the index of a type, 0 to {len(types) - 1}, "
            "or one for each person"
        )
    return np.broadcast_to(given, (n,)).astype(np.int64)


def distinct(kinds: NDArray[np.int64]) -> list[int]:
    """The types that there are, each once, in rising order; the first one where nobody is."""
    found: list[int] = np.unique(kinds).tolist()
    return found or [0]


def check_places(positions: ArrayLike, plan: FloorPlan) -> NDArray[np.float64]:
    """(n, 2) positions as an array.

    Raises:
        ModelError: the wrong shape, or positions off the floor.
    """
    points = np.asarray(positions, dtype=np.float64)
    if points.size == 0:
        points = points.reshape(0, 2)
    if points.ndim != 2 or points.shape[1] != 2:
        raise ModelError(f"positions: shape {points.shape}, expected (n, 2)")
    off = ~plan.contains(points)
    if off.any():
        k = int(np.argmax(off))
        raise ModelError(f"pedestrian {k} at {points[k].tolist()}: expected a place on the floor")
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


def check_column(name: str, values: ArrayLike, n: int) -> NDArray[np.float64]:
    """(n,) numbers; a single one stands for all.

    Raises:
        ModelError: another length, or not finite.
    """
    try:
        column = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ModelError(f"{name}: got {values!r}, expected {n} finite numbers") from None
    if column.shape not in ((n,), ()) or not np.isfinite(column).all():
        raise ModelError(f"{name}: shape {column.shape}, expected {n} finite numbers")
    return np.broadcast_to(column, (n,))


def draw_column(
    name: str, values: ArrayLike | Distribution, n: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """(n,) numbers, drawn if a distribution is given.

    Raises:
        ModelError: another length, or not finite.
    """
    if isinstance(values, Distribution):
        values = numbers_given(
            f"{name}: {type(values).__name__}", "draws", values.draw(n, rng), (n,)
        )
    return check_column(name, values, n)


def place(
    state: Crowd,
    rows: NDArray[np.int64],
    points: NDArray[np.float64],
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
    state.core[rows], state.type_index[rows] = new.core, new.type_index
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
    agenda["corner"][rows] = NO_CORNER
    agenda["mouth"][rows] = 0
    agenda["sets_off"][rows] = agenda["waits_until"][rows] = sets_off


def face(state: Crowd, rows: NDArray[np.int64], headings: ArrayLike) -> None:
    """Turn people who have just been placed."""
    state.heading[rows] = state.from_heading[rows] = state.to_heading[rows] = headings


def too_close(
    points: NDArray[np.float64],
    core: float,
    frame: int,
    rows: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
    search_radius: float,
) -> tuple[int, int]:
    """Index of the first taken place, and the row of the person who is or will come too near.

    The row is -1 if a place before it is too near.  (-1, -1) if all places are free.  Nobody
    farther than ``search_radius`` can come near a place in time.
    """
    beside = _first_beside(points, 2.0 * core)
    before = points if beside < 0 else points[:beside]
    # Mostly the floor is empty, and the test need not be compiled.
    if len(rows) > 0:
        where, who = _first(True, before, core, frame, rows, table, state, search_radius)
        if where >= 0:
            return where, who
    return beside, -1


def _first_beside(points: NDArray[np.float64], distance: float) -> int:
    """Index of the first place nearer than ``distance`` to one before it, or -1."""
    room = have_room(points, distance)
    return -1 if room.all() else int(np.argmin(room))


def first_free(
    points: NDArray[np.float64],
    core: float,
    frame: int,
    rows: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
    search_radius: float,
) -> int:
    """Index of the first free place, or -1; see ``too_close``."""
    return _first(False, points, core, frame, rows, table, state, search_radius)[0]


@kept()
def _first(
    taken: bool,
    points: NDArray[np.float64],
    core: float,
    frame: int,
    rows: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
    search_radius: float,
) -> tuple[int, int]:
    """Index of the first place that is taken, or free if not ``taken``, and the row of the person
    there; -1 for no place and for nobody.
    """
    people = build_grid(rows, state.x, state.y)
    found = np.empty(len(rows), np.int64)
    for k in range(len(points)):
        x, y = points[k]
        j = _comes_near(x, y, core, frame, people, table, state, search_radius, found)
        if (j >= 0) == taken:
            return k, j
    return -1, -1


@kept()
def _comes_near(
    x: float,
    y: float,
    core: float,
    frame: int,
    people: Grid,
    table: OptionTable,
    state: CrowdState,
    search_radius: float,
    found: NDArray[np.int64],
) -> int:
    """Lowest row of a person who is or will be too near to a body at (x, y), or -1."""
    still = np.empty((2, 2))
    still[0], still[1] = x, y
    count = people_within(people, x, y, np.int64(-1), search_radius, found)
    lowest = np.int64(-1)
    for at in found[:count]:
        j = people.people[at]
        if 0 <= lowest < j:
            continue
        c = core + state.core[j]
        dx, dy = x - state.x[j], y - state.y[j]
        if dx * dx + dy * dy < c * c or (
            state.end[j] > frame
            and swept_collision(
                still, np.int64(1), np.int64(1), frame, np.int64(-1), table, state, j, c
            )
        ):
            lowest = j
    return int(lowest)
