"""Movement options of deciding pedestrians, as flat arrays."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError


class Moment(NamedTuple):
    """When decisions are taken, and the generator that they may draw from.

    Attributes:
        frame: now.
        rng: the model's generator, or a copy of it.
    """

    frame: int
    rng: np.random.Generator

    def aside(self) -> Moment:
        """The same with a copy of the generator, so that nothing is drawn from the model's."""
        return Moment(self.frame, deepcopy(self.rng))


@dataclass(frozen=True)
class Candidates:
    """Movement options of a batch of pedestrians, one row an option.

    n options of b pedestrians with q neighbours between them.  All arrays are
    read-only to a cost term; the batch may hold any number of pedestrians, one included.

    Attributes:
        points: (n, 2) mobility points: where each option ends, metres.
        headings: (n,) facing there, radians, counter-clockwise from +x.
        displacements: (n,) straight distance from the pedestrian's position, metres.
        durations: (n,) seconds the option takes.
        speeds: (n,) displacement over duration, m/s.
        options: (n,) row of the option in the capability's table.
        owner: (n,) index in the batch (0 to b - 1) of the option's pedestrian.
        offsets: (b + 1,) options of pedestrian i are rows ``offsets[i]:offsets[i + 1]``.
        pedestrians: (b,) rows of the pedestrians in the crowd (``Pedestrian.row``).
        positions: (b, 2) metres.
        facings: (b,) headings, radians.
        targets: (b, 2) metres.
        preferred_speeds: (b,) m/s; 0 for somebody without a route.
        velocities: (b, 2) mean velocity of the movement that has just ended, m/s.
        cores: (b,) core radius, metres.
        types: (b,) index of the pedestrian type in ``model.pedestrian_types``.
        neighbour_offsets: (b + 1,) neighbours of pedestrian i are rows
            ``neighbour_offsets[i]:neighbour_offsets[i + 1]`` of the arrays below.
        neighbours: (q,) rows of the neighbours in the crowd: people whom a movement of each, of
            the longest of their types, can bring together.
        neighbour_positions: (q, 2) metres.
        neighbour_velocities: (q, 2) mean velocity of their movement under way, m/s.
        neighbour_directions: (q, 2) unit vector to their target; (0, 0) at the target.
        leads: (q,) metres by which their route is shorter than the pedestrian's; not a number if
            neither has a route.
        wall_offsets: (b + 1,) walls of pedestrian i are rows
            ``wall_offsets[i]:wall_offsets[i + 1]`` of ``walls``.
        walls: (w, 4) x1, y1, x2, y2 of walls and closed exits, metres: those no farther than the
            farthest that an option leads, the core radius and a centimetre.
        groups: (b,) number of the group, 0 for none.
        neighbour_facings: (q,) headings, radians.
        neighbour_cores: (q,) core radius, metres.
        neighbour_types: (q,) as ``types``.
        neighbour_groups: (q,) as ``groups``.
        fields: (b,) values of each field that the model declares for its people.
        neighbour_fields: (q,) the same of the neighbours.
        time: simulated seconds.
        rng: the model's generator; where a decision is only explained, a copy of it.
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
    velocities: NDArray[np.float64]
    cores: NDArray[np.float64]
    types: NDArray[np.int64]
    neighbour_offsets: NDArray[np.int64]
    neighbours: NDArray[np.int64]
    neighbour_positions: NDArray[np.float64]
    neighbour_velocities: NDArray[np.float64]
    neighbour_directions: NDArray[np.float64]
    leads: NDArray[np.float64]
    wall_offsets: NDArray[np.int64]
    walls: NDArray[np.float64]
    groups: NDArray[np.int64]
    neighbour_facings: NDArray[np.float64]
    neighbour_cores: NDArray[np.float64]
    neighbour_types: NDArray[np.int64]
    neighbour_groups: NDArray[np.int64]
    fields: Mapping[str, NDArray[Any]]
    neighbour_fields: Mapping[str, NDArray[Any]]
    time: float
    rng: np.random.Generator

    def __post_init__(self) -> None:
        for array in (*vars(self).values(), *self.fields.values(), *self.neighbour_fields.values()):
            if isinstance(array, np.ndarray):
                array.setflags(write=False)

    def field(self, name: str) -> NDArray[np.float64]:
        """(b,) what a kernel with ``fields=(name,)`` takes of each pedestrian.

        Raises:
            ModelError: the model declares no such field.
        """
        at_hand = {
            "type": self.types,
            "group": self.groups,
            "heading": self.facings,
            "core": self.cores,
            **self.fields,
        }
        return _chosen(name, at_hand)

    def neighbour_field(self, name: str) -> NDArray[np.float64]:
        """(q,) the same of each neighbour."""
        at_hand = {
            "type": self.neighbour_types,
            "group": self.neighbour_groups,
            "heading": self.neighbour_facings,
            "core": self.neighbour_cores,
            **self.neighbour_fields,
        }
        return _chosen(name, at_hand)

    def __len__(self) -> int:
        return len(self.owner)

    def pairs(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """All pairs of an option and a neighbour of its owner.

        Returns:
            (r,) rows of options and (r,) rows of the neighbour arrays.  Sum a cost over pairs
            back to options with ``np.bincount(rows, weights=cost, minlength=len(candidates))``.
        """
        counts = np.diff(self.neighbour_offsets)[self.owner]
        rows = np.repeat(np.arange(len(self), dtype=np.int64), counts)
        within = np.arange(len(rows), dtype=np.int64) - np.repeat(
            np.cumsum(counts) - counts, counts
        )
        return rows, self.neighbour_offsets[self.owner[rows]] + within

    def predicted(
        self, rows: NDArray[np.int64], neighbours: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        """(r, 2) position of each pair's neighbour when the option ends, metres.

        The neighbour is taken to keep its velocity.
        """
        velocity = self.neighbour_velocities[neighbours]
        return self.neighbour_positions[neighbours] + velocity * self.durations[rows, None]


def _chosen(name: str, at_hand: Mapping[str, NDArray[Any]]) -> NDArray[np.float64]:
    if name not in at_hand:
        raise ModelError(f"field {name!r}: is not declared; there are {', '.join(at_hand)}")
    return at_hand[name].astype(np.float64)
