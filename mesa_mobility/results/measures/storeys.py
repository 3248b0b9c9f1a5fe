"""Storeys of a building: how many people are on each level, and when they leave it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.measures.occupancy import frames_at
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.buildings import Building

FloatArray = NDArray[np.float64]

COLUMNS = ("people", "at_start", "at_end", "clear_s", "most", "most_per_m2")


class Where(NamedTuple):
    """Where the people of each row are; ``inside`` is False in rows beyond an exit."""

    level: NDArray[np.int16]
    stairs: NDArray[np.int16]
    inside: NDArray[np.bool_]


def occupancy_by_level(
    trajectories: Tracks, building: Building, every: float = 1.0
) -> dict[int, list[list[float]]]:
    """How many people are on each level, as [[t, people], ...] by the level's number.

    People on flights and landings are on no level; see `occupancy_by_stairs`.

    Args:
        trajectories: a run in the building.
        building: the building.
        every: seconds between the entries; the first is at 0, the last not after the end.

    Raises:
        ResultsError: `every` is shorter than a frame, or the tracks have no elevations.
    """
    return {
        number: curve(trajectories, rows, every)
        for number, rows in _rows_by_level(trajectories, building).items()
    }


def leaving_times(trajectories: Tracks, building: Building) -> dict[int, FloatArray]:
    """When each person last left each level, (m,) seconds by the level's number.

    Entry p belongs to person p. It is the time of the first frame in which the person is no longer
    on the level: on stairs, or outside. It is infinite if they are there when the run ends, and nan
    if they never were.

    Args:
        trajectories: a run in the building.
        building: the building.

    Raises:
        ResultsError: the tracks have no elevations.
    """
    return {
        number: last_there(trajectories, rows)
        for number, rows in _rows_by_level(trajectories, building).items()
    }


def by_level(trajectories: Tracks, building: Building) -> pd.DataFrame:
    """How many people were on each level, and when the last of them had left it.

    Args:
        trajectories: a run in the building.
        building: the building.

    Returns:
        A row for each level, by its number, from the top: ``people`` who were ever there;
        ``at_start`` and ``at_end``, people there in the first and the last frame; ``clear_s``,
        seconds after which the last person has left the level, nan if somebody is there at the end
        or nobody ever was; ``most``, the greatest number of people there at a time, and
        ``most_per_m2``, that number over the free floor of the level without stairs.

    Raises:
        ResultsError: the tracks have no elevations.
    """
    import pandas as pd

    elevation = {level.number: level.elevation for level in building.levels}
    found = _rows_by_level(trajectories, building)
    table = []
    for number in sorted(found, key=lambda each: -elevation[each]):
        times = last_there(trajectories, found[number])
        were = times[~np.isnan(times)]
        counts = people_at_a_time(trajectories, found[number])
        table.append(
            {
                "level": number,
                "people": len(were),
                "at_start": int(counts[0]),
                "at_end": int(counts[-1]),
                "clear_s": float(were.max()) if np.isfinite(were).all() and len(were) else np.nan,
                "most": int(counts.max()),
                "most_per_m2": counts.max() / building.floor_plan_of(number).free.area,
            }
        )
    return pd.DataFrame(table, columns=["level", *COLUMNS]).set_index("level")


def where(trajectories: Tracks, building: Building) -> Where:
    """The level and the stairs of each row.

    Tracks that have elevations and no levels, as those from text of the Juelich data archive, get
    their levels from the building.

    Args:
        trajectories: a run in the building.
        building: the building.

    Returns:
        Numbers of levels, as ``Tracks.level`` has them; indices in ``Building.stairs``, -1 for
        people on a level; and whether they are inside.

    Raises:
        ResultsError: the tracks have no elevations.
        FloorPlanError: a place that is on no level, landing or flight.
    """
    xyz = true_places(trajectories)
    level = trajectories.fields.get("level")
    if level is None:
        level = building.true_places(building.plane_places(xyz))[1]
    stairs = np.full(len(xyz), -1, dtype=np.int16)
    off = ~np.isin(level, [each.number for each in building.levels])
    stairs[off] = building.stairs_at(xyz[off])
    outside = trajectories.exit_frames[trajectories.person] == trajectories.frame
    return Where(level, stairs, ~outside)


def true_places(trajectories: Tracks) -> FloatArray:
    """(n, 3) x, y and z of each row, metres.

    Raises:
        ResultsError: the tracks have no elevations.
    """
    if "z" not in trajectories.fields:
        raise ResultsError("the trajectories have no elevations, expected those of a building")
    return np.column_stack([trajectories.x, trajectories.y, trajectories.z])


def curve(trajectories: Tracks, rows: NDArray[np.bool_], every: float) -> list[list[float]]:
    """[[t, rows], ...]: how many rows of a mask (n,) there are, each ``every`` seconds.

    Raises:
        ResultsError: `every` is shorter than a frame.
    """
    counts = people_at_a_time(trajectories, rows)
    return [[time, int(counts[frame])] for time, frame in frames_at(trajectories, every)]


def people_at_a_time(trajectories: Tracks, rows: NDArray[np.bool_]) -> NDArray[np.int64]:
    """(frames,) how many rows of a mask (n,) each frame has."""
    return np.bincount(trajectories.frame[rows], minlength=trajectories.frames)


def last_there(trajectories: Tracks, rows: NDArray[np.bool_]) -> FloatArray:
    """When each person was last somewhere, in rows of a mask (n,): (m,) seconds.

    See `leaving_times` for people who are there at the end, or never were.
    """
    last = np.full(len(trajectories.radii), np.nan)
    # Rows come in order of frames: each person's last row is the one that stays.
    last[trajectories.person[rows]] = trajectories.frame[rows]
    last[last == trajectories.last_frame] = np.inf
    return (last + 1.0) / trajectories.frame_rate


def _rows_by_level(trajectories: Tracks, building: Building) -> dict[int, NDArray[np.bool_]]:
    """(n,) the rows of people inside on each level, by its number."""
    found = where(trajectories, building)
    return {each.number: found.inside & (found.level == each.number) for each in building.levels}
