"""Movement options of deciding pedestrians, as flat arrays."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.state.people_grid import Grid
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
        options: (n,) row of the option in the table of the capability by which its person moves.
        owner: (n,) index in the batch (0 to b - 1) of the option's pedestrian.
        offsets: (b + 1,) options of pedestrian i are rows ``offsets[i]:offsets[i + 1]``.
        grid: people, and where they are; only columns of its table are kept of them.
        places: (b,) columns of the pedestrians.
        facings: (b,) headings, radians.
        targets: (b, 2) metres.
        preferred_speeds: (b,) m/s; 0 for somebody without a route.
        cores: (b,) core radius, metres.
        types: (b,) index of the pedestrian type in ``model.pedestrian_types``.
        neighbour_offsets: (b + 1,) neighbours of pedestrian i are rows
            ``neighbour_offsets[i]:neighbour_offsets[i + 1]`` of the arrays of neighbours.
        neighbour_places: (q,) columns of the neighbours: people whom a movement of each, of the
            longest of their types, can bring together.
        wall_offsets: (b + 1,) walls of pedestrian i are rows
            ``wall_offsets[i]:wall_offsets[i + 1]`` of ``walls``.
        walls: (w, 4) x1, y1, x2, y2 of walls and closed exits, metres: those no farther than the
            farthest that an option leads, the core radius and a centimetre.
        groups: (b,) number of the group, 0 for none.
        neighbour_facings: (q,) headings, radians.
        neighbour_cores: (q,) core radius, metres.
        neighbour_types: (q,) as ``types``.
        neighbour_groups: (q,) as ``groups``.
        fields: (b,) values of each field that the model declares for its people, of ``pace``, the
            share of their speed at which the ground lets people walk, and of ``tread``, the depth
            of the treads beneath them, metres, 0 off stairs.
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
    grid: Grid
    places: NDArray[np.int64]
    facings: NDArray[np.float64]
    targets: NDArray[np.float64]
    preferred_speeds: NDArray[np.float64]
    cores: NDArray[np.float64]
    types: NDArray[np.int64]
    neighbour_offsets: NDArray[np.int64]
    neighbour_places: NDArray[np.int64]
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

    @cached_property
    def pedestrians(self) -> NDArray[np.int64]:
        """(b,) rows of the pedestrians in the crowd (``Pedestrian.row``)."""
        return _fixed(self.grid.people[self.places])

    @cached_property
    def positions(self) -> NDArray[np.float64]:
        """(b, 2) metres."""
        return self._of(0, self.places)

    @cached_property
    def velocities(self) -> NDArray[np.float64]:
        """(b, 2) mean velocity of the movement that has just ended, m/s."""
        return self._of(2, self.places)

    @cached_property
    def neighbours(self) -> NDArray[np.int64]:
        """(q,) rows of the neighbours in the crowd."""
        return _fixed(self.grid.people[self.neighbour_places])

    @cached_property
    def neighbour_positions(self) -> NDArray[np.float64]:
        """(q, 2) metres."""
        return self._of(0, self.neighbour_places)

    @cached_property
    def neighbour_velocities(self) -> NDArray[np.float64]:
        """(q, 2) mean velocity of their movement under way, m/s."""
        return self._of(2, self.neighbour_places)

    @cached_property
    def neighbour_directions(self) -> NDArray[np.float64]:
        """(q, 2) unit vector to their target; (0, 0) at the target."""
        return self._of(4, self.neighbour_places)

    @cached_property
    def leads(self) -> NDArray[np.float64]:
        """(q,) metres by which their route is shorter than the pedestrian's; not a number if
        neither has a route."""
        own = np.repeat(self.places, np.diff(self.neighbour_offsets))
        with np.errstate(invalid="ignore"):
            return _fixed(self.grid.table[6, own] - self.grid.table[6, self.neighbour_places])

    def _of(self, row: int, places: NDArray[np.int64]) -> NDArray[np.float64]:
        """(n, 2) two rows of the table of the grid at some places, read-only."""
        return _fixed(np.ascontiguousarray(self.grid.table[row : row + 2, places].T))

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
        """All pairs of an option and a neighbour of the person whose option it is.

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

        The neighbour is assumed to keep their velocity.
        """
        velocity = self.neighbour_velocities[neighbours]
        return self.neighbour_positions[neighbours] + velocity * self.durations[rows, None]


def _fixed(values: NDArray[Any]) -> NDArray[Any]:
    """The values, read-only."""
    values.setflags(write=False)
    return values


def _chosen(name: str, at_hand: Mapping[str, NDArray[Any]]) -> NDArray[np.float64]:
    if name not in at_hand:
        raise ModelError(f"field {name!r}: is not declared; there are {', '.join(at_hand)}")
    return at_hand[name].astype(np.float64)
