"""Maps of a floor: density, how long it was great, how many people passed, and how fast."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.results.engineering.grids import Grid
from mesa_mobility.results.measures.by_type import EVERYBODY, people_by
from mesa_mobility.results.measures.speeds import frames_in
from mesa_mobility.results.measures.storeys import where
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.buildings import Building

FloatArray = NDArray[np.float64]

CELL_M = 0.5
DENSE = 4.0
"""Persons/m2 that are a congestion where they last (IMO MSC.1/Circ.1533)."""
WINDOW_S = 1.0


@dataclass(frozen=True, eq=False)
class FloorMaps:
    """Maps of one level, all of them (rows, columns).

    Attributes:
        grid: its cells; the first row has the least y.
        density_max: greatest density, persons/m2; nan where there is no floor.
        density_mean: its mean over time.
        dense_s: seconds for which the density was above the limit.
        people: number of people who were ever in the cell.
        person_s: seconds that people spent in it, all together.
        speed: mean speed of the people in it, m/s; nan where nobody was.
    """

    grid: Grid
    density_max: FloatArray
    density_mean: FloatArray
    dense_s: FloatArray
    people: NDArray[np.int64]
    person_s: FloatArray
    speed: FloatArray

    def to_pandas(self) -> pd.DataFrame:
        """A row for each cell with floor: its middle ``x`` and ``y`` (m), ``floor_m2``, and the
        maps by name."""
        import pandas as pd

        from mesa_mobility.results.engineering.service import level_of_service

        grid, on = self.grid, self.grid.share > 0.0
        y, x = np.meshgrid(grid.y[:-1] + grid.cell / 2, grid.x[:-1] + grid.cell / 2, indexing="ij")
        columns = {name: getattr(self, name)[on] for name in MAPS}
        return pd.DataFrame(
            {
                "x": x[on],
                "y": y[on],
                "floor_m2": grid.share[on] * grid.cell**2,
                "level_of_service": level_of_service(self.density_max[on]),
                **columns,
            }
        )


MAPS = ("density_max", "density_mean", "dense_s", "people", "person_s", "speed")


def maps(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    *,
    cell: float = CELL_M,
    every: float = 1.0,
    start: float = 0.0,
    end: float | None = None,
    dense: float = DENSE,
) -> dict[int, FloorMaps]:
    """Maps of each level: density, time above a limit, usage and speed.

    The density of a cell is the mean over its floor of the Voronoi densities 1 / A_i of the parts
    of the floor that are nearest to each person (Steffen and Seyfried 2010, Physica A 389: 1902).
    Where a cell is floor all over, PedPy's Voronoi profile is the same. The speed of a person is
    the distance between where they are half a second before and half a second after, over 1 s. It
    counts in the cell in which they are at that time. Both are measured every so often. People in a
    cell are counted in all frames.

    Args:
        trajectories: the run.
        plan: its floor plan, or its building.
        cell: side of a cell, metres.
        every: seconds between measurements.
        start: seconds from which on.
        end: seconds until when; by default the end of the run. With ``start`` equal to it, the
            maps are those of a time: ``density_max`` is the density then.
        dense: the limit of ``dense_s``, persons/m2.

    Returns:
        The maps of each level by its number, from the top; of a floor plan those of level 0. People
        on stairs are on no level.

    Raises:
        ResultsError: cells that are too small, times outside the run, ``every`` shorter than a
            frame, or a run in a building whose tracks have no elevations.
    """
    groups = {EVERYBODY: np.ones(len(trajectories.radii))}
    return _maps(trajectories, plan, groups, cell, every, (start, end), dense)[EVERYBODY]


def maps_by_type(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    *,
    cell: float = CELL_M,
    every: float = 1.0,
    dense: float = DENSE,
    key: str = "type",
) -> dict[str, dict[int, FloorMaps]]:
    """`maps` of everybody ("all") and of each type of people, by its name.

    People's parts of the floor are those among all people. So the densities of the types sum up to
    the density of everybody.

    Args:
        trajectories: the run.
        plan: its floor plan, or its building.
        cell: side of a cell, metres.
        every: seconds between measurements.
        dense: the limit of ``dense_s``, persons/m2.
        key: which of ``person_data`` distinguishes people; without such data there is "all" alone.

    Raises:
        ResultsError: as `maps`.
    """
    groups = {EVERYBODY: np.ones(len(trajectories.radii))}
    if key in trajectories.person_data:
        for name, own in people_by(trajectories, key).items():
            groups[name] = np.zeros(len(trajectories.radii))
            groups[name][own] = 1.0
    return _maps(trajectories, plan, groups, cell, every, (0.0, None), dense)


def _maps(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    groups: Mapping[str, FloatArray],
    cell: float,
    every: float,
    between: tuple[float, float | None],
    dense: float,
) -> dict[str, dict[int, FloorMaps]]:
    """Maps of each group of people, given as (m,) weights, 0 or 1, by level."""
    start, end = between
    duration = trajectories.duration
    end = duration if end is None else end
    if not 0.0 <= start <= end <= duration + 1e-9:
        raise ResultsError(
            f"map from {start:g} to {end:g} s: expected rising times within the run's "
            f"{duration:g} s"
        )
    frames = _sampled(trajectories, every, start, end)
    first, last = round(start * trajectories.frame_rate), round(end * trajectories.frame_rate)
    shown = (trajectories.frame >= first) & (trajectories.frame <= last)
    moved = _speeds(trajectories, frames)
    found: dict[str, dict[int, FloorMaps]] = {name: {} for name in groups}
    weights = np.array(list(groups.values()))
    for level, there, own in _floors(trajectories, plan):
        grid = Grid(own.free, cell)
        most, total, above = (np.zeros((len(groups), *grid.shape)) for _ in range(3))
        for frame in frames:
            rows = np.arange(*trajectories.frame_offsets[frame : frame + 2])
            rows = rows[there[rows]]
            points = np.column_stack([trajectories.x[rows], trajectories.y[rows]])
            now = grid.densities(points, weights[:, trajectories.person[rows]])
            most, total = np.maximum(most, now), total + now
            above += now > dense
        used = _usage(trajectories, grid, there & shown, weights)
        speeds = _mean_speeds(trajectories, grid, there, moved, weights)
        for number, name in enumerate(groups):
            found[name][level] = FloorMaps(
                grid,
                most[number],
                total[number] / len(frames),
                np.where(np.isnan(most[number]), np.nan, every * above[number]),
                used[0][number],
                used[1][number],
                speeds[number],
            )
    return found


def _sampled(tracks: Tracks, every: float, start: float, end: float) -> NDArray[np.int64]:
    """(k,) frames from a time to another, ``every`` seconds apart."""
    frames_in(every, tracks, "every")
    times = start + every * np.arange(int((end - start) / every + 1e-9) + 1)
    frames: NDArray[np.int64] = np.rint(times * tracks.frame_rate).astype(np.int64)
    return np.minimum(frames, tracks.frames - 1)


def _floors(
    trajectories: Tracks, plan: FloorPlan | Building
) -> Iterator[tuple[int, NDArray[np.bool_], FloorPlan]]:
    """Number, (n,) rows of people inside and plan of each level, from the top."""
    if isinstance(plan, FloorPlan):
        yield 0, trajectories.exit_frames[trajectories.person] != trajectories.frame, plan
        return
    found = where(trajectories, plan)
    for level in sorted(plan.levels, key=lambda each: each.elevation, reverse=True):
        rows = found.inside & (found.level == level.number)
        yield level.number, rows, plan.floor_plan_of(level.number)


def _usage(
    tracks: Tracks, grid: Grid, rows: NDArray[np.bool_], weights: FloatArray
) -> tuple[list[NDArray[np.int64]], list[FloatArray]]:
    """How many people of each group were in each cell, and for how many seconds all together."""
    person = tracks.person[rows].astype(np.int64)
    cells = grid.cells_at(tracks.x[rows], tracks.y[rows])
    person, cells = person[cells >= 0], cells[cells >= 0]
    size = grid.share.size
    pairs, counts = np.unique(person * size + cells, return_counts=True)
    of, at = pairs // size, pairs % size
    people, seconds = [], []
    for weight in weights:
        number = np.bincount(at, weights=weight[of], minlength=size)
        people.append(number.astype(np.int64).reshape(grid.shape))
        frames = np.bincount(at, weights=weight[of] * counts, minlength=size)
        seconds.append((frames / tracks.frame_rate).reshape(grid.shape))
    return people, seconds


def _speeds(tracks: Tracks, frames: NDArray[np.int64]) -> tuple[NDArray[np.int64], FloatArray]:
    """(k,) rows in these frames that are in the middle of a window, and the (k,) speeds, m/s."""
    half = max(round(tracks.frame_rate * WINDOW_S / 2), 1)
    order = tracks.by_person
    start, middle, end = order[: -2 * half], order[half:-half], order[2 * half :]
    sampled = np.zeros(tracks.frames, dtype=np.bool_)
    sampled[frames] = True
    kept = sampled[tracks.frame[middle]]
    start, middle, end = start[kept], middle[kept], end[kept]
    # Rows of a person without gaps: then the row between two frames is the one in the middle.
    kept = (tracks.person[start] == tracks.person[end]) & (
        tracks.frame[end] - tracks.frame[start] == 2 * half
    )
    start, middle, end = start[kept], middle[kept], end[kept]
    way = np.hypot(tracks.x[end] - tracks.x[start], tracks.y[end] - tracks.y[start])
    return middle, way * tracks.frame_rate / (2 * half)


def _mean_speeds(
    tracks: Tracks,
    grid: Grid,
    there: NDArray[np.bool_],
    moved: tuple[NDArray[np.int64], FloatArray],
    weights: FloatArray,
) -> list[FloatArray]:
    """Mean speed of the people of each group in each cell, nan where nobody was."""
    rows, speed = moved
    cells = np.where(there[rows], grid.cells_at(tracks.x[rows], tracks.y[rows]), -1)
    speed, person, cells = speed[cells >= 0], tracks.person[rows[cells >= 0]], cells[cells >= 0]
    found = []
    for weight in weights:
        sums, counts = (
            np.bincount(cells, weights=weight[person] * each, minlength=grid.share.size)
            for each in (speed, np.ones(len(speed)))
        )
        mean = np.divide(sums, counts, out=np.full(len(sums), np.nan), where=counts > 0)
        found.append(mean.reshape(grid.shape))
    return found
