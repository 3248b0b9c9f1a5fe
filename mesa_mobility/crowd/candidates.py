"""The movement options of the pedestrians deciding now, as flat arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Candidates:
    """Movement options of a batch of pedestrians, one row an option.

    n options of b pedestrians with q neighbours between them.  All arrays are
    read-only to a cost term; the batch may hold any number of pedestrians, one included.

    Attributes:
        points: (n, 2) mobility points: where each option ends, metres.
        headings: (n,) facing there, radians, counter-clockwise from +x.
        displacements: (n,) straight distance from where the pedestrian is now, metres.
        durations: (n,) seconds the option takes.
        speeds: (n,) displacement over duration, m/s.
        options: (n,) row of the option in the capability's table.
        owner: (n,) which pedestrian of the batch (0 to b - 1) the option belongs to.
        offsets: (b + 1,) options of pedestrian i are rows ``offsets[i]:offsets[i + 1]``.
        pedestrians: (b,) rows of the pedestrians in the crowd (``Pedestrian.row``).
        positions: (b, 2) where they are now, metres.
        facings: (b,) where they face now, radians.
        targets: (b, 2) where they want to go, metres.
        preferred_speeds: (b,) m/s; 0 for somebody who has no way to go.
        types: (b,) index of the pedestrian type in ``model.pedestrian_types``.
        neighbour_offsets: (b + 1,) neighbours of pedestrian i are rows
            ``neighbour_offsets[i]:neighbour_offsets[i + 1]`` of the arrays below.
        neighbours: (q,) rows of the neighbours in the crowd.
        neighbour_positions: (q, 2) where they are now, metres.
        neighbour_velocities: (q, 2) mean velocity of their movement under way, m/s.
        neighbour_directions: (q, 2) unit vector from where they are to their target; 0, 0 there.
        leads: (q,) by how many metres their way is shorter than that of the pedestrian;
            not a number if neither has a way.
    """

    points: NDArray[np.float64]
    headings: NDArray[np.float64]
    displacements: NDArray[np.float64]
    durations: NDArray[np.float64]
    speeds: NDArray[np.float64]
    options: NDArray[np.int64]
    owner: NDArray[np.int64]
    offsets: NDArray[np.int64]
    pedestrians: NDArray[np.int64]
    positions: NDArray[np.float64]
    facings: NDArray[np.float64]
    targets: NDArray[np.float64]
    preferred_speeds: NDArray[np.float64]
    types: NDArray[np.int64]
    neighbour_offsets: NDArray[np.int64]
    neighbours: NDArray[np.int64]
    neighbour_positions: NDArray[np.float64]
    neighbour_velocities: NDArray[np.float64]
    neighbour_directions: NDArray[np.float64]
    leads: NDArray[np.float64]

    def __post_init__(self) -> None:
        for array in vars(self).values():
            array.setflags(write=False)

    def __len__(self) -> int:
        return len(self.owner)

    def pairs(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """All pairs of an option and a neighbour of its owner.

        Returns:
            (r,) rows of options and (r,) rows of the neighbour arrays.  Sum a cost over pairs
            back to options with ``np.bincount(rows, weights=cost, minlength=len(candidates))``.
        """
        counts = np.diff(self.neighbour_offsets)[self.owner]
        rows = np.repeat(np.arange(len(self)), counts)
        within = np.arange(len(rows)) - np.repeat(np.cumsum(counts) - counts, counts)
        return rows, self.neighbour_offsets[self.owner[rows]] + within

    def predicted(
        self, rows: NDArray[np.int64], neighbours: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        """(r, 2) where the neighbour of each pair will be when the option ends.

        At constant velocity, in metres.
        """
        velocity = self.neighbour_velocities[neighbours]
        return self.neighbour_positions[neighbours] + velocity * self.durations[rows, None]
