"""Where and when crowds are measured."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import shapely
from scipy.ndimage import gaussian_filter1d
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.columns import COLUMNS
from mesa_mobility.results.tracks import Tracks

Point = tuple[float, float]


@dataclass(frozen=True)
class View:
    """Where, when and in which direction a crowd is measured.

    Figures that need what is None are left out.

    Attributes:
        direction: (x, y) of the crowd, of any length.
        area: polygon in which people count, metres.
        line: both ends of the line that people cross, metres.
        floor: walkable area, for densities, metres.
        after: seconds of the tracks from which on they count.
        until: seconds until which they count; to the end if None.
        since_first: whether time counts from the first passage over the line on, instead of from
            ``after``.
        smoothing: standard deviation of a Gaussian by which places are smoothed first, seconds.
            Heads sway; the same for both crowds.

    Raises:
        ResultsError: times in the wrong order, a direction without length, an area without size.
    """

    direction: Point | None = None
    area: shapely.Polygon | None = None
    line: tuple[Point, Point] | None = None
    floor: BaseGeometry | None = None
    after: float = 0.0
    until: float | None = None
    since_first: bool = False
    smoothing: float = 0.0

    def __post_init__(self) -> None:
        if self.until is not None and not self.after < self.until:
            raise ResultsError(f"view: from {self.after} to {self.until} s, expected rising times")
        if self.direction is not None and not np.hypot(*self.direction) > 0.0:
            raise ResultsError(f"view: direction {self.direction}, expected one with a length")
        for name in ("area", "floor"):
            found = getattr(self, name)
            if found is not None and not found.area > 0.0:
                raise ResultsError(f"view: {name} has no size, expected a polygon")
        if not 0.0 <= self.smoothing < np.inf:
            raise ResultsError(f"view: smoothing is {self.smoothing}, expected 0 s or more")

    def of(self, tracks: Tracks) -> Tracks:
        """The rows that count, smoothed.

        Raises:
            ResultsError: there are none.
        """
        if self.smoothing:
            tracks = smoothed(tracks, self.smoothing)
        seconds = tracks.frame / tracks.frame_rate
        kept = seconds >= self.after - 1e-9
        if self.until is not None:
            kept &= seconds <= self.until + 1e-9
        if not kept.any():
            until = "the end" if self.until is None else f"{self.until:g} s"
            raise ResultsError(f"view: nobody is there from {self.after:g} s to {until}")
        if kept.all():
            return tracks
        return replace(
            tracks,
            **{name: getattr(tracks, name)[kept] for name in COLUMNS},
            fields={},
            last_frame=None,
            inside_at_end=None,
            decisions=None,
        )


def smoothed(tracks: Tracks, seconds: float) -> Tracks:
    """The tracks with places smoothed by a Gaussian, each unbroken piece by itself."""
    x, y = np.array(tracks.x), np.array(tracks.y)
    rows = tracks.by_person
    breaks = (np.diff(tracks.person[rows]) != 0) | (np.diff(tracks.frame[rows]) != 1)
    for piece in np.split(rows, np.flatnonzero(breaks) + 1):
        for places in (x, y):
            if len(piece):
                width = seconds * tracks.frame_rate
                places[piece] = gaussian_filter1d(places[piece], width, mode="nearest")
    return replace(tracks, x=x, y=y)
