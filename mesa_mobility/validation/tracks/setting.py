"""What is replayed, and where and when both crowds are measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from shapely import Polygon

from mesa_mobility import FloorPlan, Trajectories
from mesa_mobility.crowd.insertion.tracks import NEAR_FLOOR
from mesa_mobility.errors import ResultsError
from mesa_mobility.results.distances import View
from mesa_mobility.validation.tracks.windows import (
    main_direction,
    middle_area,
    narrowest_line,
    steady_frames,
)

LEAD_S = 6.0
"""Time of the replay before anything is measured, seconds: people settle."""
LEAST_ON = 0.9
"""Least share of rows that must be on the floor, heads over walls included."""
SHORTEST_S = 3.0
"""Least time to measure, seconds: two steps."""

Line = tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class Setting:
    """A measured run on its floor, and the windows of the comparison.

    Attributes:
        file: of the tracks.
        plan_file: of the floor plan.
        unit: of the file's coordinates.
        frame_rate: frames a second.
        start: frame of the tracks at which the replay begins.
        first: first frame that is measured.
        last: last frame that is measured.
        area: polygon in which people are measured, metres.
        line: both ends of the line that people cross, metres.
        direction: (x, y) of the crowd, of length 1.
        speeds: free speeds of the simulated people as a distribution's text; None for the type's.
        exits: of a floor plan whose file has none, as ``FloorPlan.from_file`` takes them.
        level: number or name of the level, of a file that has several.
    """

    file: str
    plan_file: str
    unit: str
    frame_rate: float
    start: int
    first: int
    last: int
    area: Polygon
    line: Line
    direction: tuple[float, float]
    speeds: str | None = None
    exits: str | None = None
    level: str | None = None

    def view(self, floor: shapely.Geometry) -> View:
        """For the measured crowd."""
        return self._view(floor, 0)

    def replayed_view(self, floor: shapely.Geometry) -> View:
        """The same for its replay, whose time begins at ``start``."""
        return self._view(floor, self.start)

    @property
    def seconds(self) -> float:
        """Time of the replay."""
        return (self.last - self.start) / self.frame_rate

    def _view(self, floor: shapely.Geometry, zero: int) -> View:
        return View(
            direction=self.direction,
            area=self.area,
            line=self.line,
            floor=floor,
            after=(self.first - zero) / self.frame_rate,
            until=(self.last - zero) / self.frame_rate,
        )

    def __str__(self) -> str:
        low_x, low_y, high_x, high_y = self.area.bounds
        (ax, ay), (bx, by) = self.line
        return (
            f"replayed from frame {self.start}, measured in frames {self.first} to {self.last}, in "
            f"{self.area.area:.1f} m\u00b2 between ({low_x:.2f}, {low_y:.2f}) and "
            f"({high_x:.2f}, {high_y:.2f}), and over the line from ({ax:.2f}, {ay:.2f}) to "
            f"({bx:.2f}, {by:.2f})"
        )


def setting_of(
    tracks: Trajectories,
    plan: FloorPlan,
    plan_file: str,
    *,
    start: int | None = None,
    first: int | None = None,
    last: int | None = None,
    area: Polygon | None = None,
    line: Line | None = None,
    speeds: str | None = None,
) -> Setting:
    """The setting of a comparison; what is not given, the tracks say.

    Args:
        tracks: read from a file.
        plan: the floor.
        plan_file: its file.
        start: as in ``Setting``; by default 6 s before ``first``, or when tracks begin.
        first: by default when a sixth of the people have crossed the line.
        last: by default when five sixths have crossed it.
        area: by default the floor between two lines across the crowd's direction, with a tenth of
            all places before and behind.
        line: by default the narrowest cut of the floor that people cross.
        speeds: of simulated people.

    Raises:
        ResultsError: one person alone, more than a tenth of the rows off the floor, a window
            without people or of less than 3 s, an area off the floor, a line that fewer than six
            people cross.
    """
    assert tracks.reading is not None
    file = tracks.reading.file
    people = np.unique(tracks.person)
    if len(people) < 2:
        person, frame = people[0], tracks.frame[0]
        raise ResultsError(
            f"{file}: person {person} is alone (from frame {frame}), expected a crowd"
        )
    _check_floor(tracks, plan, plan_file)
    direction = main_direction(tracks)
    line = line or narrowest_line(tracks, plan.free, direction)
    steady = None if line is None else steady_frames(tracks, line)
    if line is None or steady is None:
        raise ResultsError(
            f"{file}: fewer than six people cross the line, expected another one: --line X,Y,X,Y"
        )
    begins, ends = int(tracks.frame[0]), int(tracks.frame[-1])
    first = steady[0] if first is None else first
    last = steady[1] if last is None else last
    if start is None:
        start = max(first - round(LEAD_S * tracks.frame_rate), min(begins, first))
    if not begins <= start <= first < last <= ends:
        raise ResultsError(
            f"{file}: replay from frame {start}, measured from {first} to {last}; expected rising "
            f"frames between {begins} and {ends}"
        )
    if (last - first) / tracks.frame_rate < SHORTEST_S:
        raise ResultsError(
            f"{file}: frames {first} to {last} are {(last - first) / tracks.frame_rate:.1f} s, "
            f"expected {SHORTEST_S:g} s or more"
        )
    if area is None:
        area = middle_area(tracks, plan.free, direction)
    pieces = shapely.get_parts(shapely.intersection(area, plan.free))
    inside = [each for each in pieces if isinstance(each, Polygon) and each.area > 0.0]
    if not inside:
        raise ResultsError(f"{plan_file}: the area to measure is not on the floor")
    area = max(inside, key=lambda each: each.area)
    counted = (tracks.frame >= first) & (tracks.frame <= last)
    if not shapely.contains_xy(area, tracks.x[counted], tracks.y[counted]).any():
        raise ResultsError(f"{file}: nobody in the area from frame {first} to {last}")
    return Setting(
        file=file,
        plan_file=plan_file,
        unit=tracks.reading.unit,
        frame_rate=tracks.frame_rate,
        start=start,
        first=first,
        last=last,
        area=area,
        line=line,
        direction=direction,
        speeds=speeds,
    )


def _check_floor(tracks: Trajectories, plan: FloorPlan, plan_file: str) -> None:
    """Raise ResultsError if too many rows are off the floor: the plan is another."""
    on = shapely.contains_xy(shapely.buffer(plan.free, NEAR_FLOOR), tracks.x, tracks.y)
    if on.mean() < LEAST_ON:
        row = int(np.argmin(on))
        assert tracks.reading is not None
        raise ResultsError(
            f"{tracks.reading.file}: person {tracks.person[row]}, frame {tracks.frame[row]}: at "
            f"({tracks.x[row]:.2f}, {tracks.y[row]:.2f}) m, off the floor of {plan_file}, as "
            f"{np.count_nonzero(~on)} of {len(on)} rows are"
        )
