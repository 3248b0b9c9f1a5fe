"""Starting a model where measured people were: at their places, with their velocities."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from mesa_mobility.crowd.insertion.arrivals import ARRIVAL, Arrivals
from mesa_mobility.crowd.insertion.measured import (
    Measured,
    check_velocities,
    first_rows,
    measured,
    ways_out,
)
from mesa_mobility.crowd.insertion.newcomers import Newcomers
from mesa_mobility.crowd.insertion.relaxing import relaxed
from mesa_mobility.crowd.insertion.tracks import MeasuredTracks
from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.crowd.types.pedestrian_type import PedestrianType
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan.walls.wall_distances import distances_to_walls
from mesa_mobility.populations import Population

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

MOST_MOVED = 0.5
"""Farthest from a recorded place that people are put, metres."""


@dataclass(frozen=True, eq=False)
class Replay:
    """How measured people were put into a model.

    Attributes:
        frame: frame of the model at which the replay began.
        from_frame: frame of the tracks at that moment.
        frame_rate: of the tracks, frames a second.
        persons: (n,) numbers, in the tracks, of the people who were there at the start.
        rows: (n,) their rows in the model.
        moved: (n,) metres between their recorded places and those at which they have room.
    """

    frame: int
    from_frame: int
    frame_rate: float
    persons: IntArray
    rows: IntArray
    moved: FloatArray
    _arrivals: Arrivals = field(repr=False)
    _expected: IntArray = field(repr=False)

    @property
    def arrivals(self) -> NDArray[np.void]:
        """(k,) records of those who come later: ``person``, ``frame`` of the model, ``x``, ``y``,
        ``vx``, ``vy``, and once they have come ``row`` (-1 before), ``entered`` (frame) and
        ``moved`` (metres)."""
        return self._arrivals.records[self._expected]

    def row_of(self) -> dict[int, int]:
        """Row in the model by number in the tracks, of everybody who has come by now."""
        come = self.arrivals[self.arrivals["row"] >= 0]
        persons = [*self.persons.tolist(), *come["person"].tolist()]
        return dict(zip(persons, [*self.rows.tolist(), *come["row"].tolist()], strict=True))

    def __str__(self) -> str:
        arrivals = self.arrivals
        come = arrivals[arrivals["row"] >= 0]
        return (
            f"{len(self.persons)} people from frame {self.from_frame} on{_moved_by(self.moved)}; "
            f"{len(come)} of {len(arrivals)} arrivals have come{_moved_by(come['moved'])}"
        )


def replay(
    model: CrowdModel,
    tracks: MeasuredTracks,
    from_frame: int | None = None,
    *,
    exits: Sequence[str] | Mapping[int, Sequence[str]] | None = None,
    preferred_speeds: ArrayLike | Distribution | None = None,
    type_index: int | None = None,
    population: Population | Mapping[str | PedestrianType, float] | str | None = None,
) -> Replay:
    """Put measured people into the model: those of one frame now, later ones when they came.

    Everybody starts at their measured place with their mean velocity of the last 0.8 s, faces as
    the tracks say, and takes a decision at once. Their pose is one from which recorded movements
    begin with that velocity. Only frames up to ``from_frame`` count, except for people whose track
    begins less than 0.2 s before: their velocity is that of the next 0.8 s. Who has not walked yet
    stands and faces their target, unless the file has headings.

    Later arrivals come in at their recorded time and place, moving. If somebody is there, they come
    in up to 0.5 m beside that place, or wait. People who are off the floor come in where they reach
    it.

    Bodies take more room than heads: people who would overlap others or walls are moved apart. A
    warning says by how much, and ``Replay.moved`` has it for each.

    Args:
        tracks: ``Trajectories``, in the coordinates of the floor plan.
        from_frame: frame of the tracks at which the model starts; their first by default.
        exits: names of the exits by which everybody may leave, or by number of the person; by
            default the exit at which their track ends or, if it ends elsewhere, the one to which
            it has come nearer by most.
        preferred_speeds: m/s, one number, a distribution or (m,) by number of the person; by
            default drawn from the type.
        type_index: index of everybody's type; by default types are drawn from ``population``.
        population: the shares of types; by default those of the model.

    Returns:
        Who was put where.

    Raises:
        ModelError: nobody on the floor in that frame or later; a person who jumps, is too fast or
            has no room within 0.5 m; or what ``add_pedestrians`` refuses. Messages name the
            file, the person and the frame.
        FloorPlanError: an unknown exit, or no way to it.
    """
    track = measured(tracks, model.floor_plan)
    start = int(tracks.frame[0]) if from_frame is None and len(tracks.frame) else from_frame or 0
    rows = first_rows(track, start)
    check_velocities(track, rows)
    kinds = _kinds(len(rows), type_index, population, model)
    speeds = _speeds(preferred_speeds, track.person[rows], kinds, model)
    ways, way = ways_out(track, rows, exits, model.floor_plan)
    now = track.frame[rows] == start
    starting = _People(rows[now], kinds[now], speeds[now], way[now])
    places = _with_room(track, starting, model)
    found = _insert(track, starting, places, ways, model)
    coming = _People(rows[~now], kinds[~now], speeds[~now], way[~now])
    expected = model.sources.arrivals.add(_arrivals_of(track, coming, start, model.frame), ways)
    model.go_on()
    made = Replay(
        frame=model.frame,
        from_frame=start,
        frame_rate=track.rate,
        persons=track.person[starting.rows],
        rows=found,
        moved=np.hypot(*(places - track.places[starting.rows]).T),
        _arrivals=model.sources.arrivals,
        _expected=expected,
    )
    if (made.moved > 0.0).any():
        farthest = starting.rows[np.argmax(made.moved)]
        said = f"(person {track.person[farthest]}, frame {start})"
        warnings.warn(
            f"{track.name}: {len(places)} people{_moved_by(made.moved)} {said}", stacklevel=2
        )
    return made


@dataclass(frozen=True, eq=False)
class _People:
    """Rows of the tracks, types, preferred speeds and ways out of some people."""

    rows: IntArray
    kinds: IntArray
    speeds: FloatArray
    way: IntArray


def _kinds(
    n: int,
    type_index: int | None,
    population: Population | Mapping[str | PedestrianType, float] | str | None,
    model: CrowdModel,
) -> IntArray:
    """(n,) types of people."""
    shares = None if population is None else Population.of(population)
    if type_index is None and shares is None:
        shares = model._scene.shares
    new = Newcomers(type_index=type_index, population=shares)
    return new.draw_types(n, model.pedestrian_types, model.rng)


def _speeds(
    given: ArrayLike | Distribution | None, persons: IntArray, kinds: IntArray, model: CrowdModel
) -> FloatArray:
    """(n,) preferred speeds of people, m/s."""
    if given is not None and not isinstance(given, Distribution):
        column = np.asarray(given)
        if column.ndim == 1:
            if len(column) <= persons.max(initial=-1):
                raise ModelError(
                    f"preferred_speeds: got {len(column)}, expected one for each number of a "
                    f"person up to {persons.max()}"
                )
            given = column[persons]
    return Newcomers(preferred_speeds=given).draw_speeds(kinds, model.pedestrian_types, model.rng)


def _with_room(track: Measured, people: _People, model: CrowdModel) -> FloatArray:
    """(n, 2) places at which people have room for their bodies.

    Raises:
        ModelError: somebody has none within ``MOST_MOVED``.
    """
    plan, apart = model.floor_plan, model._scene.rules.hard_bodies
    radii = np.array([each.half_width for each in model.pedestrian_types])[people.kinds]
    given = track.places[people.rows]
    if not len(given):
        return given
    places = relaxed(given, radii, plan, apart=apart)
    bad = np.hypot(*(places - given).T) > MOST_MOVED
    for radius in np.unique(radii).tolist():
        own = radii == radius
        bad[own] |= ~plan.contains(places[own])
        bad[own] |= distances_to_walls(plan, places[own], radius) < radius
    if apart:
        one, other = cKDTree(places).query_pairs(2.0 * radii.max(), output_type="ndarray").T
        near = np.hypot(*(places[one] - places[other]).T) < radii[one] + radii[other]
        bad[one[near]] = True
    if bad.any():
        row = people.rows[np.argmax(bad)]
        raise ModelError(
            f"{track.where(row)}: no room for a body of {radii[np.argmax(bad)]:g} m radius within "
            f"{MOST_MOVED:g} m ({bad.sum()} such people)"
        )
    return places


def _insert(
    track: Measured, people: _People, places: FloatArray, ways: list[list[str]], model: CrowdModel
) -> IntArray:
    """Put people into the model now; (n,) their rows."""
    rows = np.full(len(places), -1, dtype=np.int64)
    aimless = track.aimless[people.rows]
    for number, exits in enumerate(ways):
        for stands in (False, True):
            own = np.flatnonzero((people.way == number) & (aimless == stands))
            if len(own):
                at = people.rows[own]
                new = Newcomers(
                    headings=None if stands else track.headings[at],
                    velocities=None if stands else track.velocity[at],
                    preferred_speeds=people.speeds[own],
                    type_index=people.kinds[own],
                    exits=exits,
                )
                rows[own] = [each.row for each in model.dynamics.insert(places[own], new)]
    return rows


def _arrivals_of(track: Measured, people: _People, start: int, frame: int) -> NDArray[np.void]:
    """(n,) records of people who come after frame ``start``, which is ``frame`` of the model."""
    at = people.rows
    seconds = (track.frame[at] - start) / track.rate
    columns: dict[str, Any] = {
        "person": track.person[at],
        "frame": frame + np.ceil(seconds * FRAMES_A_SECOND - 1e-6),
        "x": track.places[at, 0],
        "y": track.places[at, 1],
        "heading": track.headings[at],
        "vx": track.velocity[at, 0],
        "vy": track.velocity[at, 1],
        "speed": people.speeds,
        "type_index": people.kinds,
        "way": people.way,
        "row": -1,
        "entered": -1,
    }
    records = np.zeros(len(at), dtype=ARRIVAL)
    for name, values in columns.items():
        records[name] = values
    return records


def _moved_by(moved: FloatArray) -> str:
    """How far people were moved for room, for a message."""
    shifted = moved[moved > 0.0]
    if not len(shifted):
        return " at their places"
    return (
        f", {len(shifted)} of {len(moved)} moved for room, by {moved.max():.3f} m at most and "
        f"{moved.mean():.4f} m on average over all"
    )
