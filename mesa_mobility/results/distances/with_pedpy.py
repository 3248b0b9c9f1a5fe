"""What PedPy measures for a comparison of crowds."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.results.distances.samples import EVERY_S, WINDOW_S, ways
from mesa_mobility.results.distances.view import View
from mesa_mobility.results.formats.export import to_pedpy
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

FloatArray = NDArray[np.float64]

CELL_M = 0.5
"""Side of a cell of profiles, metres."""


def passing_times(tracks: Tracks, view: View) -> FloatArray:
    """(k,) seconds of the tracks at which people first crossed the view's line, in rising order.

    The view must have a line.
    """
    pedpy, data = _pedpy(tracks)
    assert view.line is not None
    line = pedpy.MeasurementLine(list(view.line))
    _, crossed = pedpy.compute_n_t(traj_data=data, measurement_line=line)
    return np.sort(crossed["frame"].to_numpy()) / tracks.frame_rate


def speeds_and_densities(tracks: Tracks, view: View) -> pd.DataFrame:
    """Place, speed and density of everybody in the area, once a second.

    The view must have a direction and a floor.

    Returns:
        One row for each second and person in the area: ``id``, ``frame``, ``x``, ``y`` (m);
        ``speed`` over 1.5 s along the direction, or against it for people who go the other way
        (m/s); ``density`` of the person's Voronoi cell (persons/m2).
    """
    pedpy, data = _pedpy(tracks)
    assert view.direction is not None
    half = max(round(WINDOW_S * tracks.frame_rate / 2), 1)
    direction = np.asarray(view.direction) / math.hypot(*view.direction)
    speed = pedpy.compute_individual_speed(
        traj_data=data, frame_step=half, movement_direction=direction
    )
    every = max(round(EVERY_S * tracks.frame_rate), 1)
    rows = data.data[(data.data["frame"] - data.data["frame"].min()) % every == 0]
    rows = rows[shapely.contains_xy(view.floor, rows["x"], rows["y"])]
    once = pedpy.TrajectoryData(data=rows[["id", "frame", "x", "y"]], frame_rate=data.frame_rate)
    cells = pedpy.compute_individual_voronoi_polygons(
        traj_data=once, walkable_area=pedpy.WalkableArea(view.floor)
    )
    found = rows.merge(speed, on=["id", "frame"]).merge(cells, on=["id", "frame"])
    found = found[shapely.contains_xy(view.area, found["x"], found["y"])]
    against = ways(tracks, view.direction)[found["id"].to_numpy()] < 0.0
    found["speed"] = found["speed"].where(~against, -found["speed"])
    return found[["id", "frame", "x", "y", "speed", "density"]]


def profiles(rows: pd.DataFrame, tracks: Tracks, view: View) -> tuple[FloatArray, FloatArray]:
    """Profiles in cells of 0.5 m of the area, row by row.

    Args:
        rows: what ``speeds_and_densities`` gives.
        tracks: the run.
        view: with the area.

    Returns:
        (cells,) mean density, persons/m2, and (cells,) mean speed along the direction, m/s; not a
        number where nobody was.
    """
    import pedpy

    every = max(round(EVERY_S * tracks.frame_rate), 1)
    frames = (int(tracks.frame[-1]) - int(tracks.frame[0])) // every + 1
    area = pedpy.WalkableArea(view.area)
    if not len(rows):
        cells = len(pedpy.get_grid_cells(walkable_area=area, grid_size=CELL_M)[0])
        return np.zeros(cells), np.full(cells, np.nan)
    density = pedpy.compute_density_profile(
        data=rows,
        walkable_area=area,
        grid_size=CELL_M,
        density_method=pedpy.DensityMethod.CLASSIC,
    )
    speed = pedpy.compute_speed_profile(
        data=rows, walkable_area=area, grid_size=CELL_M, speed_method=pedpy.SpeedMethod.MEAN
    )
    # Frames without anybody in the area are not among those that PedPy has a profile of.
    occupied = np.array(density)
    weights = np.where(np.isfinite(speed), occupied, 0.0)
    with np.errstate(invalid="ignore"):
        mean = (weights * np.nan_to_num(speed)).sum(axis=0) / weights.sum(axis=0)
    return (occupied.sum(axis=0) / frames).ravel(), np.asarray(mean).ravel()


def _pedpy(tracks: Tracks) -> tuple[Any, Any]:
    """PedPy, and the tracks as its data.

    Raises:
        ResultsError: PedPy is not installed.
    """
    data = to_pedpy(tracks)
    import pedpy

    return pedpy, data
