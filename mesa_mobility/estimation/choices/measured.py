"""Measured tracks as choices need them: checked, and laid out by person and frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.human_limits import FASTEST_SPRINT
from mesa_mobility.results.tracks import Tracks

LEANS = 0.3
"""Metres beyond walls that heads may be."""

WALKS = (0.02, 4.0)
"""Median speeds that a crowd of pedestrians may have, m/s; others are those of other units."""

OTHER_SIZE = 20.0
"""How many times smaller than the plan tracks may be before they look like those of other units."""

LEAST_HISTORY = 0.2
"""Least seconds over which a velocity is taken."""


@dataclass(frozen=True, eq=False)
class Measured:
    """Measured people on a floor plan.

    Attributes:
        people: (k,) their numbers in the tracks.
        first: the first frame.
        rate: frames a second.
        places: (k, frames, 2) where each was in each frame, metres; not a number before they came,
            after they left and in gaps.
    """

    people: NDArray[np.int64]
    first: int
    rate: float
    places: NDArray[np.float64]

    @property
    def last(self) -> int:
        """The last frame."""
        return self.first + self.places.shape[1] - 1

    def at(self, frame: float) -> NDArray[np.float64]:
        """(k, 2) where each was in a frame, or between two, metres; not a number if absent."""
        at = frame - self.first
        before = int(np.floor(at + 1e-9))
        share = max(at - before, 0.0)
        k, frames = self.places.shape[:2]
        if before < 0 or before + (share > 1e-6) >= frames:
            return np.full((k, 2), np.nan)
        if share <= 1e-6:
            return self.places[:, before]
        between: NDArray[np.float64] = (1.0 - share) * self.places[:, before] + share * (
            self.places[:, before + 1]
        )
        return between

    def velocities(self, frame: float, seconds: float) -> NDArray[np.float64]:
        """(k, 2) mean velocity over the last ``seconds`` before a frame, m/s.

        Of those who have come since, that since they came; 0 of those who have only just come.
        """
        now = self.at(frame)
        found = np.full_like(now, np.nan)
        for back in np.arange(round(seconds * self.rate), 0, -1):
            passed = back / self.rate
            if passed < LEAST_HISTORY - 1e-9:
                break
            open_ = np.isnan(found[:, 0]) & ~np.isnan(now[:, 0])
            if not open_.any():
                break
            found[open_] = ((now - self.at(frame - back)) / passed)[open_]
        found[np.isnan(found[:, 0]) & ~np.isnan(now[:, 0])] = 0.0
        return found

    def span(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(k, 2) the first and the last place of each, metres."""
        there = ~np.isnan(self.places[:, :, 0])
        last = self.places.shape[1] - 1 - np.argmax(there[:, ::-1], axis=1)
        who = np.arange(len(last))
        return self.places[who, np.argmax(there, axis=1)], self.places[who, last]


def measured(tracks: Tracks, plan: FloorPlan, name: str = "tracks") -> Measured:
    """Tracks of people on a plan, checked.

    What a track has off the floor before its person came in or after they left does not count.

    Args:
        tracks: two people or more; positions in metres.
        plan: the floor on which they walked.
        name: what errors call the tracks, such as their file.

    Raises:
        ResultsError: nobody or a single person, another unit, jumps, or people off the floor; the
            error names the person and the frame.
    """
    people, number = np.unique(tracks.person, return_inverse=True)
    if len(people) < 2:
        raise ResultsError(f"{name}: {_one(tracks, people)}, expected two people or more")
    order = tracks.by_person
    person, frame = tracks.person[order], tracks.frame[order]
    x, y = tracks.x[order], tracks.y[order]
    same = (np.diff(person) == 0) & (np.diff(frame) > 0)
    passed = np.diff(frame)[same] / tracks.frame_rate
    speeds = np.hypot(np.diff(x)[same], np.diff(y)[same]) / passed
    starts = np.flatnonzero(same)
    _check_units(name, x, y, speeds, plan)
    if (speeds > FASTEST_SPRINT).any():
        at = starts[np.argmax(speeds > FASTEST_SPRINT)]
        step = np.hypot(x[at + 1] - x[at], y[at + 1] - y[at])
        raise ResultsError(
            f"{name}: person {person[at]} jumps by {step:.2f} m from frame {frame[at]} to frame "
            f"{frame[at + 1]}, expected steps of {FASTEST_SPRINT:g} m/s at most"
        )
    first, last = int(frame.min()), int(frame.max())
    places = np.full((len(people), last - first + 1, 2), np.nan)
    kept = _on_the_floor(name, person, frame, np.column_stack([x, y]), plan)
    places[number[order][kept], frame[kept] - first] = np.column_stack([x, y])[kept]
    return Measured(people.astype(np.int64), first, float(tracks.frame_rate), places)


def _one(tracks: Tracks, people: NDArray[np.int32]) -> str:
    if len(people) == 0:
        return "nobody"
    frames = f"frames {tracks.frame.min()} to {tracks.frame.max()}"
    return f"only person {people[0]} ({frames})"


def _check_units(
    name: str,
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    speeds: NDArray[np.float64],
    plan: FloorPlan,
) -> None:
    """Refuse coordinates that are not metres."""
    median = float(np.median(speeds)) if len(speeds) else 1.0
    x0, y0, x1, y1 = plan.free.bounds
    size = max(np.ptp(x), np.ptp(y), 1e-9)
    smaller = max(x1 - x0, y1 - y0) / size > OTHER_SIZE and median < WALKS[0]
    if median > WALKS[1] or smaller:
        raise ResultsError(
            f"{name}: people move at {median:.3g} m/s in the median, over {size:.3g} m of a plan "
            f"of {max(x1 - x0, y1 - y0):.3g} m, expected coordinates in metres"
        )


def _on_the_floor(
    name: str,
    person: NDArray[np.int32],
    frame: NDArray[np.int32],
    points: NDArray[np.float64],
    plan: FloorPlan,
) -> NDArray[np.bool_]:
    """(n,) which rows, by person and frame, lie on the floor, heads over walls included."""
    shapely.prepare(plan.free)
    off = ~plan.contains(points)
    off[off] = shapely.distance(plan.free, shapely.points(points[off])) > LEANS
    if not off.any():
        return ~off
    starts = np.flatnonzero(np.diff(person, prepend=-1))
    for first, last in zip(starts, [*starts[1:], len(person)], strict=True):
        own = off[first:last]
        if not own.any():
            continue
        on = np.flatnonzero(~own)
        between = own[on[0] : on[-1]] if len(on) else own
        if between.any():
            at = first + (on[0] if len(on) else 0) + int(np.argmax(between))
            where = f"({points[at, 0]:.2f}, {points[at, 1]:.2f})"
            raise ResultsError(
                f"{name}: person {person[at]} is at {where} in frame {frame[at]}, off the floor of "
                f"the plan, expected places within {LEANS:g} m of it"
            )
    return ~off
