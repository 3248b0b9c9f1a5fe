"""Where measured people were, frame by frame: tracks checked, as choices need them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.insertion.tracks import NEAR_FLOOR, TrackRows
from mesa_mobility.errors import ResultsError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.human_limits import FASTEST_SPRINT
from mesa_mobility.results.tracks import Tracks

WALKS = (0.02, 4.0)
"""Median speeds that a crowd of pedestrians may have, m/s; others are those of other units."""

OTHER_SIZE = 20.0
"""How many times smaller than the plan tracks may be before they look like those of other units."""

LEAST_HISTORY = 0.2
"""Least seconds over which a velocity is taken."""


@dataclass(frozen=True, eq=False)
class Places:
    """Where measured people were on a floor plan.

    Attributes:
        people: (k,) their numbers in the tracks.
        first: the first frame.
        rate: frames a second.
        exits: (k,) index in the plan's ``exits`` of the exit to which each one's track leads.
        places: (k, frames, 2) where each was in each frame, metres; not a number before they came,
            after they left and in gaps.
    """

    people: NDArray[np.int64]
    first: int
    rate: float
    exits: NDArray[np.int64]
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


def places_of(tracks: Tracks, plan: FloorPlan, name: str = "tracks") -> Places:
    """The places of people on a plan, checked.

    What a track has off the floor before its person came in or after they left does not count.

    Args:
        tracks: two people or more; positions in metres.
        plan: the floor on which they walked.
        name: what errors call the tracks, such as their file.

    Raises:
        ResultsError: nobody or a single person, another unit, jumps, or people off the floor; the
            error names the person and the frame.
    """
    people = np.unique(tracks.person).astype(np.int64)
    if len(people) < 2:
        raise ResultsError(f"{name}: {_one(tracks, people)}, expected two people or more")
    rows = TrackRows.of(tracks, plan, name)
    same = (np.diff(rows.person) == 0) & (np.diff(rows.frame) > 0)
    steps = np.hypot(*np.diff(rows.places, axis=0)[same].T)
    speeds = steps / (np.diff(rows.frame)[same] / rows.rate)
    _check_units(rows, speeds, plan)
    if (speeds > FASTEST_SPRINT).any():
        step = int(np.argmax(speeds > FASTEST_SPRINT))
        at = np.flatnonzero(same)[step]
        raise ResultsError(
            f"{name}: person {rows.person[at]} jumps by {steps[step]:.2f} m from frame "
            f"{rows.frame[at]} to frame {rows.frame[at + 1]}, expected steps of "
            f"{FASTEST_SPRINT:g} m/s at most"
        )
    _check_on_floor(rows)
    kept, number = rows.on_floor, np.searchsorted(people, rows.person)
    first, last = int(rows.frame.min()), int(rows.frame.max())
    places = np.full((len(people), last - first + 1, 2), np.nan)
    places[number[kept], rows.frame[kept] - first] = rows.places[kept]
    return Places(people, first, rows.rate, rows.exits(people, plan), places)


def _one(tracks: Tracks, people: NDArray[np.int64]) -> str:
    if len(people) == 0:
        return "nobody"
    frames = f"frames {tracks.frame.min()} to {tracks.frame.max()}"
    return f"only person {people[0]} ({frames})"


def _check_units(rows: TrackRows, speeds: NDArray[np.float64], plan: FloorPlan) -> None:
    """Refuse coordinates that are not metres."""
    median = float(np.median(speeds)) if len(speeds) else 1.0
    x0, y0, x1, y1 = plan.free.bounds
    size = max(*np.ptp(rows.places, axis=0), 1e-9)
    smaller = max(x1 - x0, y1 - y0) / size > OTHER_SIZE and median < WALKS[0]
    if median > WALKS[1] or smaller:
        raise ResultsError(
            f"{rows.name}: people move at {median:.3g} m/s in the median, over {size:.3g} m of a "
            f"plan of {max(x1 - x0, y1 - y0):.3g} m, expected coordinates in metres"
        )


def _check_on_floor(rows: TrackRows) -> None:
    """Refuse people who are off the floor between two places on it, or always."""
    off = ~rows.on_floor
    starts = np.flatnonzero(np.diff(rows.person, prepend=-1))
    for first, last in zip(starts, [*starts[1:], len(off)], strict=True):
        own = off[first:last]
        if not own.any():
            continue
        on = np.flatnonzero(~own)
        between = own[on[0] : on[-1]] if len(on) else own
        if between.any():
            at = first + (on[0] if len(on) else 0) + int(np.argmax(between))
            where = f"({rows.places[at, 0]:.2f}, {rows.places[at, 1]:.2f})"
            raise ResultsError(
                f"{rows.name}: person {rows.person[at]} is at {where} in frame {rows.frame[at]}, "
                f"off the floor of the plan, expected places within {NEAR_FLOOR:g} m of it"
            )
