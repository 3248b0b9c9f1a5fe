"""Twins: people on a strip that two sheets share, as the people on the other sheet see them.

Whoever is on the strip of a seam, or may come there, gets a second record, as much farther on as
the other sheet is. It lives while the decisions of a frame are taken, in a row behind those of all
people. Deciding, walking and leaving are done by the person alone; the twin follows their path.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.floorplan import Seam

_SWAY = 0.1
"""Metres by which a path may bulge between two waypoints, and more."""


class Twins(NamedTuple):
    """The twins of a frame.

    A seam has two strips, one on each sheet; from either, people beyond the line come to the other.

    Attributes:
        follow: (rows,) for each row the next twin of the same person, -1 for none; empty without
            seams.
        strip: (rows,) for each twin the strip on which the person is, -1 for people.
        here: (rows,) whether they are at their place on the strip when the frame begins; True for
            people. Only these count in cost terms.
        strips: (strips, 8) x and y of the middle of its line, x and y of the direction across it
            away from its sheet, half its width, its depth, and x and y of the shift to the other
            sheet; metres.
    """

    follow: NDArray[np.int64]
    strip: NDArray[np.int64]
    here: NDArray[np.bool_]
    strips: NDArray[np.float64]


def strips_of(seams: Sequence[Seam]) -> NDArray[np.float64]:
    """The strips of some seams, as in ``Twins``."""
    strips = []
    for seam in seams:
        (x, y), (ux, uy), (dx, dy) = seam.centre, seam.direction, seam.shift
        size = seam.width / 2.0, seam.depth
        strips.append([x, y, ux, uy, *size, dx, dy])
        strips.append([x + dx, y + dy, -ux, -uy, *size, -dx, -dy])
    return np.array(strips, dtype=np.float64).reshape(-1, 8)


NO_TWINS = Twins(
    np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0, np.bool_), np.empty((0, 8))
)
"""Those of a floor plan without seams."""


@contextmanager
def laid_twins(
    strips: NDArray[np.float64], rows: NDArray[np.int64], count: int, reach: float, crowd: Crowd
) -> Iterator[tuple[Twins, NDArray[np.int64]]]:
    """The twins of some people for a while, and their rows together with those of the people.

    Args:
        strips: (k, 8) the strips of the floor plan.
        rows: (n,) rows of the people, in order.
        count: rows in use: twins get those from there on.
        reach: metres that a movement may cover, body included.
        crowd: the crowd.
    """
    if not len(strips):
        yield NO_TWINS, rows
        return
    owners, numbers = _owners(strips, rows, reach, crowd)
    new = np.arange(count, count + len(owners), dtype=np.int64)
    if count + len(owners) > len(crowd.x):
        crowd.grow(max(count + len(owners), 2 * len(crowd.x)))
    follow = np.full(count + len(owners), -1, dtype=np.int64)
    last = np.arange(count, dtype=np.int64)
    for number in range(len(strips)):
        own = numbers == number
        follow[last[owners[own]]] = new[own]
        last[owners[own]] = new[own]
    strip, here = np.full(len(follow), -1, dtype=np.int64), np.ones(len(follow), dtype=np.bool_)
    strip[new] = numbers
    here[new] = _on_strip(strips[numbers], crowd.x[owners], crowd.y[owners], crowd.core[owners])
    for values in (crowd.records, crowd.agenda, *crowd.fields.values()):
        values[new] = values[owners]
    shift_people(crowd, new, strips[numbers, 6:])
    crowd.target_x[new] += strips[numbers, 6]
    crowd.target_y[new] += strips[numbers, 7]
    crowd.person_of = np.arange(len(follow), dtype=np.int64)
    crowd.person_of[new] = owners
    crowd.copies = new[here[new]]
    try:
        yield Twins(follow, strip, here, strips), np.concatenate([rows, new])
    finally:
        crowd.person_of = crowd.copies = NO_TWINS.follow
        # Rows are taken to be empty until somebody comes in.
        for values in (crowd.records, crowd.agenda, *crowd.fields.values()):
            values[new] = np.zeros(1, values.dtype)


def rows_seen(
    crowd: Crowd, people: NDArray[np.int64], positions: NDArray[np.float64]
) -> NDArray[np.int64]:
    """Rows of the records of people, or of their twins, that are at some places.

    Args:
        crowd: the crowd.
        people: (n,) rows of people.
        positions: (n, 2) where each is seen, metres.
    """
    if not len(crowd.person_of):
        return people
    seen = people.copy()
    for k, (person, (x, y)) in enumerate(zip(people, positions, strict=True)):
        rows = np.flatnonzero(crowd.person_of == person)
        seen[k] = rows[np.argmin(np.hypot(crowd.x[rows] - x, crowd.y[rows] - y))]
    return seen


def change_sheets(strips: NDArray[np.float64], rows: NDArray[np.int64], crowd: Crowd) -> None:
    """Put people who have come to the copied part of a strip on the sheet to which it belongs.

    Args:
        strips: (k, 8) the strips of the floor plan.
        rows: (n,) rows of people whose movement has ended.
        crowd: the crowd.
    """
    for strip in strips:
        along, aside = _in_strip(strip, crowd.x[rows], crowd.y[rows])
        there = rows[(along > 0.0) & (along <= strip[5]) & (np.abs(aside) <= strip[4])]
        shift_people(crowd, there, np.tile(strip[6:], (len(there), 1)))
        # Nobody changes twice: strips of one sheet do not overlap.
        rows = np.setdiff1d(rows, there, assume_unique=True)


def with_copies(
    strips: NDArray[np.float64], points: NDArray[np.float64], reach: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Places together with the same places on other sheets.

    Args:
        strips: (k, 8) the strips of the floor plan.
        points: (n, 2) metres.
        reach: metres from a strip within which a place has a copy.

    Returns:
        (m, 2) places, first the given ones, and for each of them the index of the given one.
    """
    places, owners = [points], [np.arange(len(points), dtype=np.int64)]
    for strip in strips:
        own = np.flatnonzero(_on_strip(strip, points[:, 0], points[:, 1], reach))
        places.append(points[own] + strip[6:])
        owners.append(own)
    return np.concatenate(places), np.concatenate(owners)


def _owners(
    strips: NDArray[np.float64], rows: NDArray[np.int64], reach: float, crowd: Crowd
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of the people who get a twin, and the numbers of the strips."""
    x, y = crowd.x[rows], crowd.y[rows]
    found = [rows[_on_strip(strip, x, y, reach)] for strip in strips]
    numbers = np.repeat(np.arange(len(strips), dtype=np.int64), [len(each) for each in found])
    return np.concatenate(found), numbers


def _in_strip(
    strip: NDArray[np.float64], x: NDArray[np.float64], y: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Metres past the line of a strip, or of one for each place, and metres aside of its middle."""
    cx, cy, ux, uy = np.moveaxis(strip, -1, 0)[:4]
    dx, dy = x - cx, y - cy
    return dx * ux + dy * uy, dy * ux - dx * uy


def _on_strip(
    strip: NDArray[np.float64],
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    around: NDArray[np.float64] | float,
) -> NDArray[np.bool_]:
    """Whether places are on a strip, or on one for each, or no farther than ``around`` from it."""
    along, aside = _in_strip(strip, x, y)
    half, depth = np.moveaxis(strip, -1, 0)[4:6]
    found: NDArray[np.bool_] = (np.abs(along) <= depth + around) & (np.abs(aside) <= half + around)
    return found


def shift_people(crowd: Crowd, rows: NDArray[np.int64], by: NDArray[np.float64]) -> None:
    """Move the people in ``rows``, with their paths, by (n, 2) metres."""
    for axis, name in enumerate("xy"):
        for column in (name, f"from_{name}", f"to_{name}"):
            crowd.records[column][rows] += by[:, axis]
        crowd.box[rows, axis] += by[:, axis]
        crowd.box[rows, axis + 2] += by[:, axis]


@internal()
def near_strip(twins: Twins, number: int, x: float, y: float, core: float) -> bool:
    """Whether a body with this core radius at (x, y), or on its way past there, is on a strip."""
    strips, room = twins.strips, core + _SWAY
    dx, dy = x - strips[number, 0], y - strips[number, 1]
    ux, uy = strips[number, 2], strips[number, 3]
    along, aside = abs(dx * ux + dy * uy), abs(dy * ux - dx * uy)
    return bool(along <= strips[number, 5] + room and aside <= strips[number, 4] + room)
