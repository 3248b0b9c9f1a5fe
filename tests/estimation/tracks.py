"""Tracks of people in a corridor, written by hand."""

import numpy as np

from mesa_mobility import Exit, FloorPlan, Trajectories

RATE = 10.0


def corridor() -> FloorPlan:
    return FloorPlan(
        "POLYGON ((0 0, 20 0, 20 4, 0 4, 0 0))",
        exits=[Exit("left", (0, 0), (0, 4)), Exit("right", (20, 0), (20, 4))],
    )


def walking(people: int = 6, seconds: float = 6.0, speed: float = 1.2) -> Trajectories:
    """People who walk to the right at a steady speed, every second one a little slower."""
    frames = np.arange(round(seconds * RATE))
    rows = []
    for person in range(people):
        own = speed - 0.1 * (person % 2)
        x = 1.0 + 1.5 * (person // 3) + 0.3 * (person % 3) + own * frames / RATE
        y = np.full_like(x, 0.8 + 1.1 * (person % 3))
        rows.append(np.column_stack([frames, np.full_like(x, person), x, y]))
    return tracks_of(np.concatenate(rows))


def tracks_of(rows: np.ndarray) -> Trajectories:
    """Tracks of rows of frame, person, x, y."""
    return Trajectories(
        frame=rows[:, 0].astype(np.int32),
        person=rows[:, 1].astype(np.int32),
        x=rows[:, 2],
        y=rows[:, 3],
        heading=np.zeros(len(rows)),
        frame_rate=RATE,
    )


def rows_of(tracks: Trajectories) -> np.ndarray:
    """The rows of tracks: frame, person, x, y."""
    return np.column_stack([tracks.frame, tracks.person, tracks.x, tracks.y]).astype(np.float64)
