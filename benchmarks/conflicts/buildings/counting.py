"""Counts people lost, doubled, in others, off the floors or through them, from their true tracks.

It takes recorded places and the surfaces of `surfaces`, and nothing of what the model itself says.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from shapely import LineString

from benchmarks.conflicts.buildings.surfaces import Surface

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

FRAMES = 30
"""Frames a second."""
OFF = 0.01
"""Metres by which a place may be above or below a surface."""
BESIDE = 0.02
"""Metres by which a place may be beside one: an exit may lie 1 cm off its edge."""
NEAR = 0.15
"""Metres from the edge of a surface within which steps are tested for walls; longer ones all are.
"""
ABOVE = 1.5
"""Metres between people who are above each other, not beside each other."""
TOUCH = 0.001
"""Metres by which two bodies must overlap to count, and by which a step must be too long."""
NAMED = 10
"""Faults that are described, at most."""
NOWHERE = -1
_FAR = 10.0
"""Metres between two frames in the tree of all places."""


@dataclass(frozen=True)
class Crowd:
    """Tracks of a crowd; row by row, in any order.

    Attributes:
        frame: (n,) frames, from 0 on.
        person: (n,) numbers, from 0 on.
        xyz: (n, 3) true places, metres.
        last_frame: the end of the run.
        radii: (people,) of the bodies of those who were put in, metres.
        fastest: (people,) m/s.
    """

    frame: IntArray
    person: IntArray
    xyz: FloatArray
    last_frame: int
    radii: FloatArray
    fastest: FloatArray


@dataclass
class Found:
    """The counts, and the last rows of people who are inside at the end.

    Attributes:
        lost: people without a row, with a gap, or whose rows end elsewhere than at an exit.
        doubled: rows of people who are elsewhere in that frame, and of people never put in.
        overlaps: pairs of bodies, in any frame.
        wall_crossings: steps that leave the surfaces from and to which they lead.
        floor_crossings: steps from one surface to another that are not joined.
        off_floor: rows that are on no surface.
        jumps: steps that are too long, or rides that are too short.
        changes: steps from one surface to another.
        rides: rides of people in lifts.
        inside: rows of those who are inside at the end, by person.
        left: those who left.
        named: the first faults.
    """

    lost: int = 0
    doubled: int = 0
    overlaps: int = 0
    wall_crossings: int = 0
    floor_crossings: int = 0
    off_floor: int = 0
    jumps: int = 0
    changes: int = 0
    rides: int = 0
    inside: dict[int, int] = field(default_factory=dict)
    left: set[int] = field(default_factory=set)
    named: list[str] = field(default_factory=list)

    def note(self, what: str, rows: IntArray, crowd: Crowd) -> int:
        """Name the first of these rows as faults; how many there are."""
        for row in rows[: max(NAMED - len(self.named), 0)].tolist():
            x, y, z = crowd.xyz[row]
            self.named.append(
                f"{what}: person {crowd.person[row]}, frame {crowd.frame[row]}, "
                f"({x:.3f}, {y:.3f}, {z:.3f})"
            )
        return len(rows)


def count(
    crowd: Crowd,
    surfaces: Sequence[Surface],
    exits: Mapping[str, Sequence[LineString]],
    speeds: Mapping[str, float],
) -> Found:
    """Count what is wrong.

    Args:
        crowd: the tracks.
        surfaces: where people may be.
        exits: lines by which people leave, by the name of the surface.
        speeds: of the cars of lifts, m/s, by name.
    """
    order = np.lexsort((crowd.frame, crowd.person))
    crowd = Crowd(crowd.frame[order], crowd.person[order], crowd.xyz[order], crowd.last_frame,
                  crowd.radii, crowd.fastest)  # fmt: skip
    found = Found()
    if not len(order):
        found.lost = len(crowd.radii)
        return found
    alien = np.flatnonzero(crowd.person >= len(crowd.radii))
    same = np.diff(crowd.person) == 0
    twice = np.flatnonzero(same & (np.diff(crowd.frame) == 0))
    found.doubled = found.note("never put in", alien, crowd) + found.note("doubled", twice, crowd)
    if len(alien) or len(twice):
        # The rest is counted for one row of each person in each frame.
        own = np.ones(len(crowd.person), dtype=np.bool_)
        own[alien], own[twice + 1] = False, False
        crowd = Crowd(crowd.frame[own], crowd.person[own], crowd.xyz[own], crowd.last_frame,
                      crowd.radii, crowd.fastest)  # fmt: skip
        same = np.diff(crowd.person) == 0
    where = surfaces_at(crowd.xyz, surfaces)
    gaps = np.flatnonzero(same & (np.diff(crowd.frame) > 1))
    _see_off(crowd, where, surfaces, exits, found, gaps)
    last = np.append(np.flatnonzero(~same), len(crowd.person) - 1)
    beyond = np.zeros(len(where), dtype=np.bool_)
    beyond[[row for row in last.tolist() if int(crowd.person[row]) in found.left]] = True
    off = np.flatnonzero((where == NOWHERE) & ~beyond)
    found.off_floor = found.note("off the floor", off, crowd)
    steps = np.flatnonzero(same & (np.diff(crowd.frame) == 1) & ~beyond[1:])
    _count_steps(crowd, steps, where, surfaces, speeds, found)
    found.overlaps = _count_overlaps(crowd, found)
    return found


def surfaces_at(xyz: FloatArray, surfaces: Sequence[Surface]) -> IntArray:
    """(n,) number of the surface on which each (n, 3) place is; -1 for none."""
    where = np.full(len(xyz), NOWHERE, dtype=np.int64)
    for beside in (0.0, BESIDE):
        for number, each in enumerate(surfaces):
            area = each.area.buffer(beside) if beside else each.area
            shapely.prepare(area)
            above = xyz[:, 2] - each.heights(xyz[:, :2])
            near = (where == NOWHERE) & (above >= -OFF) & (above <= each.rise + OFF)
            rows = np.flatnonzero(near)
            where[rows[shapely.intersects_xy(area, *xyz[rows, :2].T)]] = number
    return where


def _see_off(
    crowd: Crowd,
    where: IntArray,
    surfaces: Sequence[Surface],
    exits: Mapping[str, Sequence[LineString]],
    found: Found,
    gaps: IntArray,
) -> None:
    """Find who left by an exit, who is inside at the end, and who is neither."""
    lost = set(crowd.person[gaps].tolist())
    found.note("gap", gaps, crowd)
    last = dict(zip(crowd.person.tolist(), range(len(crowd.person)), strict=True))
    for person in range(len(crowd.radii)):
        row = last.get(person)
        if row is None:
            lost.add(person)
            found.named.append(f"never there: person {person}")
        elif (
            row
            and crowd.person[row - 1] == person
            and _leaves(crowd.xyz[row - 1 : row + 1], surfaces[where[row - 1]], exits)
        ):
            found.left.add(person)
        elif crowd.frame[row] == crowd.last_frame:
            found.inside[person] = row
        else:
            lost.add(person)
            found.note("gone", np.array([row]), crowd)
    found.lost = len(lost)


def _leaves(step: FloatArray, floor: Surface, exits: Mapping[str, Sequence[LineString]]) -> bool:
    """Whether a step on a floor crosses one of its exits."""
    line = LineString(step[:, :2])
    level = bool(np.ptp(step[:, 2]) <= OFF)
    return level and any(line.distance(each) <= BESIDE and not floor.area.contains(
        shapely.Point(step[1, :2])) for each in exits.get(floor.name, ()))  # fmt: skip


def _count_steps(
    crowd: Crowd,
    steps: IntArray,
    where: IntArray,
    surfaces: Sequence[Surface],
    speeds: Mapping[str, float],
    found: Found,
) -> None:
    """Count steps, from these rows to the next, that are too long or lead through something."""
    moved = np.abs(crowd.xyz[steps + 1] - crowd.xyz[steps])
    across = np.hypot(moved[:, 0], moved[:, 1])
    here, there = where[steps], where[steps + 1]
    known = (here != NOWHERE) & (there != NOWHERE)
    lifts = np.array([each.lift for each in surfaces] + [""])
    rides = known & (lifts[here] != "") & (lifts[here] == lifts[there])
    most = crowd.fastest[crowd.person[steps]] / FRAMES
    higher = max(each.slope for each in surfaces) * most + 2 * OFF
    higher[rides] = [speeds[lift] / FRAMES + TOUCH for lift in lifts[here[rides]]]
    far = (across > most + TOUCH) | (moved[:, 2] > higher)
    found.jumps = found.note("jump", steps[far], crowd)
    moving = np.array([each.rise > 0.0 for each in surfaces] + [False])
    found.rides = int((known & ~moving[here] & moving[there]).sum())
    found.changes = int((known & (here != there)).sum())
    joined = np.array(
        [[a.name in b.joined or b.name in a.joined or a is b for a in surfaces] for b in surfaces]
    )
    through = known & ~rides & ~joined[here, there]
    found.floor_crossings = found.note("from floor to floor", steps[through], crowd)
    hits = list[int]()
    pairs = np.column_stack([here, there])
    tested = known & ~rides & ~through
    for a, b in np.unique(pairs[tested], axis=0).tolist():
        mine = np.flatnonzero(tested & (here == a) & (there == b))
        area = shapely.union(surfaces[a].area, surfaces[b].area, grid_size=1e-9)
        inner, outer = area.buffer(-NEAR), area.buffer(BESIDE, join_style="mitre")
        shapely.prepare(inner)
        shapely.prepare(outer)
        rows = steps[mine]
        near = (across[mine] > NEAR) | ~shapely.intersects_xy(inner, *crowd.xyz[rows, :2].T)
        rows = rows[near]
        lines = shapely.linestrings(np.stack([crowd.xyz[rows, :2], crowd.xyz[rows + 1, :2]], 1))
        hits += rows[~shapely.covers(outer, lines)].tolist()
    found.wall_crossings = found.note("through a wall", np.array(hits, dtype=np.int64), crowd)


def _count_overlaps(crowd: Crowd, found: Found) -> int:
    """Pairs of bodies that overlap beside each other, in all frames."""
    if len(crowd.person) < 2:
        return 0
    total, frames = 0, np.argsort(crowd.frame, kind="stable")
    for rows in np.array_split(frames, max(len(frames) // 20_000, 1)):
        # Frames cut by the ends of a part are looked at with both.
        first, last = crowd.frame[rows[0]], crowd.frame[rows[-1]]
        rows = frames[np.searchsorted(crowd.frame[frames], first) :
                      np.searchsorted(crowd.frame[frames], last)]  # fmt: skip
        total += _overlaps_in(crowd, rows, found)
    rows = frames[np.searchsorted(crowd.frame[frames], crowd.frame[frames[-1]]) :]
    return total + _overlaps_in(crowd, rows, found)


def _overlaps_in(crowd: Crowd, rows: IntArray, found: Found) -> int:
    if len(rows) < 2:
        return 0
    points = np.column_stack([crowd.xyz[rows, :2], _FAR * crowd.frame[rows]])
    radii, z = crowd.radii[crowd.person[rows]], crowd.xyz[rows, 2]
    a, b = cKDTree(points).query_pairs(2.0 * float(radii.max()), output_type="ndarray").T
    apart = np.hypot(*(points[a] - points[b])[:, :2].T)
    close = (np.abs(z[a] - z[b]) < ABOVE) & (apart < radii[a] + radii[b] - TOUCH)
    return found.note("overlap", rows[a[close]], crowd)
