"""Figures of a run by type of people, or by other data."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.measures.occupancy import occupancy
from mesa_mobility.results.measures.speeds import mean_speed
from mesa_mobility.results.measures.times import quantile_of_times
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from collections.abc import Callable

    import pandas as pd

EVERYBODY = "all"

COLUMNS = ("people", "left", "mean_egress_s", "p95_egress_s", "mean_speed_mps")


def by_type(trajectories: Tracks, key: str = "type") -> pd.DataFrame:
    """How many people of each type there were, how many left and when, and how fast they walked.

    Args:
        trajectories: the run.
        key: which of ``person_data`` distinguishes people; ``"group"`` for instance.

    Returns:
        A row for each type, by name: ``people``, ``left``; ``mean_egress_s`` and ``p95_egress_s``,
        mean and 95th percentile of the seconds from a person's first frame to when they leave;
        ``mean_speed_mps``, as ``mean_speed`` has it. People still inside count as later than all
        others: the mean is nan if there are any, and the percentile is nan if it lies among them.
        Each is nan where there is nothing to count.

    Raises:
        ResultsError: the trajectories have no such data.
    """
    import pandas as pd

    return pd.DataFrame(rows_by_type(trajectories, key), columns=[key, *COLUMNS]).set_index(key)


def rows_by_type(trajectories: Tracks, key: str = "type") -> list[dict[str, Any]]:
    """The rows of ``by_type``, each with its type by the name of ``key``, in order of the types.

    Raises:
        ResultsError: the trajectories have no such data.
    """
    rows = []
    seconds = _egress_seconds(trajectories)
    for name, own in people_by(trajectories, key).items():
        times = seconds[own]
        left = int(np.isfinite(times).sum())
        p95 = quantile_of_times(times, 0.95)
        speed = mean_speed(trajectories.of_people(own))
        rows.append(
            {
                key: name,
                "people": len(own),
                "left": left,
                "mean_egress_s": float(times.mean()) if left == len(times) else np.nan,
                "p95_egress_s": np.nan if p95 is None else p95,
                "mean_speed_mps": np.nan if speed is None else speed,
            }
        )
    return rows


def occupancy_by_type(
    trajectories: Tracks, every: float = 1.0, key: str = "type"
) -> dict[str, list[list[float]]]:
    """``occupancy`` of the people of each type alone, by its name.

    Raises:
        ResultsError: the trajectories have no such data, or ``every`` is shorter than a frame.
    """
    return {
        name: occupancy(trajectories.of_people(own), every)
        for name, own in people_by(trajectories, key).items()
    }


def tables_by_type(
    measure: Callable[[Tracks], pd.DataFrame], trajectories: Tracks, key: str = "type"
) -> pd.DataFrame:
    """A table of everybody, and the same of the people of each type alone.

    Args:
        measure: makes the table of some tracks.
        trajectories: the run.
        key: which of ``person_data`` distinguishes people.

    Returns:
        The tables below one another. Their index has one more level, the first one, called by the
        name of ``key``: "all" for everybody, then each type by its name. Tracks without such data
        have "all" alone.
    """
    import pandas as pd

    tables = {EVERYBODY: measure(trajectories)}
    if key in trajectories.person_data:
        for name, own in people_by(trajectories, key).items():
            tables[name] = measure(trajectories.of_people(own))
    return pd.concat(list(tables.values()), keys=list(tables), names=[key])


def people_by(trajectories: Tracks, key: str) -> dict[str, NDArray[np.int64]]:
    """The people who appear, by a value of ``person_data``, in order of the values.

    Raises:
        ResultsError: the trajectories have no such data.
    """
    if key not in trajectories.person_data:
        known = ", ".join(trajectories.person_data) or "none"
        raise ResultsError(f"trajectories: no person_data {key!r}, expected one of: {known}")
    people = np.unique(trajectories.person).astype(np.int64)
    values = trajectories.person_data[key][people]
    return {str(value): people[values == value] for value in np.unique(values).tolist()}


def _egress_seconds(trajectories: Tracks) -> NDArray[np.float64]:
    """(m,) seconds from each person's first frame to when they leave; infinite for those inside."""
    left = trajectories.exit_frames
    first = np.zeros(len(left), dtype=np.int64)
    first[trajectories.person[::-1]] = trajectories.frame[::-1]
    return np.where(left >= 0, (left - first) / trajectories.frame_rate, np.inf)
