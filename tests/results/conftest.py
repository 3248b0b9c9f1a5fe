from collections.abc import Callable, Mapping, Sequence

import numpy as np
import pytest

from mesa_mobility.floorplan import Exit, FloorPlan, Gate
from mesa_mobility.results import Trajectories

Tracks = Mapping[int, tuple[int, Sequence[tuple[float, float]]]]


@pytest.fixture
def walk() -> Callable[..., Trajectories]:
    """Trajectories from ``{person: (first frame, [(x, y), ...])}``; everybody faces +x."""

    def make(tracks: Tracks, **keywords: object) -> Trajectories:
        rows = [
            (first + k, person, x, y)
            for person, (first, points) in tracks.items()
            for k, (x, y) in enumerate(points)
        ]
        columns = list(zip(*rows, strict=True)) if rows else [()] * 4
        return Trajectories(
            frame=np.array(columns[0], dtype=np.int32),
            person=np.array(columns[1], dtype=np.int32),
            x=np.array(columns[2], dtype=float),
            y=np.array(columns[3], dtype=float),
            heading=np.zeros(len(rows)),
            **keywords,
        )

    return make


@pytest.fixture
def room() -> FloorPlan:
    """10 m x 4 m, a pillar, a door line across the middle, an exit in the right-hand wall."""
    return FloorPlan(
        "POLYGON ((0 0, 10 0, 10 4, 0 4, 0 0))",
        exits=[Exit("east", (10, 1), (10, 3))],
        gates=[Gate("middle", (5, 0), (5, 4))],
        obstacles=["POLYGON ((2 1, 3 1, 3 2, 2 2, 2 1))"],
        name="room",
    )


@pytest.fixture
def two_leave_one_stays(walk: Callable[..., Trajectories]) -> Trajectories:
    """Frames 0 to 4 at 2 Hz: 0 leaves in frame 2, 1 stays, 2 comes in frame 1, leaves in 4."""
    return walk(
        {
            0: (0, [(8.0, 2.0), (9.0, 2.0), (10.1, 2.0)]),
            1: (0, [(1.0, 1.0)] * 5),
            2: (1, [(7.0, 2.0), (8.0, 2.0), (9.0, 2.0), (10.5, 2.0)]),
        },
        frame_rate=2.0,
        inside_at_end=np.array([1]),
    )
