"""Where to go: the behaviour that gives those who decide a target."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.inside import Inside
from mesa_mobility.crowd.state import Crowd, CrowdState
from mesa_mobility.crowd.surroundings import Site
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import Targets
from mesa_mobility.jit import Entry, called


class Deciding(NamedTuple):
    """The pedestrians who need a target now.

    Attributes:
        pedestrians: (n,) their rows in the crowd (``Pedestrian.row``).
        positions: (n, 2) where they are, metres.
        destinations: (n,) number of the set of exits that each may leave by.
        elapsed: simulated seconds.
        inside: everybody inside, themselves included.
        rng: the model's generator.
        site: routes: ``site.targets(positions, destinations)`` and
            ``site.destination(exit_names)``, the number of a set of exits;
            ``site.exits(destination)``, their names.
    """

    pedestrians: NDArray[np.int64]
    positions: NDArray[np.float64]
    destinations: NDArray[np.int64]
    elapsed: float
    inside: Inside
    rng: np.random.Generator
    site: Site

    @property
    def types(self) -> NDArray[np.int64]:
        """(n,) index of the pedestrian type."""
        return self.inside.types_of(self.pedestrians)


class TargetChoice(ABC):
    """A behaviour that makes the target requests of section 6 of the paper.

    Subclasses set ``name`` and give ``targets``.  A model has one.
    """

    name: ClassVar[str]

    @abstractmethod
    def targets(self, deciding: Deciding) -> Targets:
        """Target of each pedestrian, and how far it still is to where it leaves.

        Returns:
            ``Targets`` with ``points`` (n, 2) in metres and ``distances`` (n,): people decide in
            rising order of distance.
        """


def ask(choice: TargetChoice, deciding: Deciding, crowd: Crowd) -> Targets:
    """The targets that a choice gives, checked, in arrays that compiled functions take; the crowd
    gets the ways left to go.

    Raises:
        ModelError: points that are not finite, or arrays of other shapes.
    """
    given = choice.targets(deciding)
    points = np.asarray(given.points, dtype=np.float64, order="C")
    distances = np.asarray(given.distances, dtype=np.float64, order="C")
    corners = given.corners
    if corners is not None:
        corners = np.asarray(corners, dtype=np.int64, order="C")
    rows, n = deciding.pedestrians, len(deciding.pedestrians)
    # Compiled functions would take corners of another shape for what they are not.
    if corners is not None and corners.shape != (n, 2):
        raise ModelError(
            f"behaviour {choice.name!r}: gave corners of shape {corners.shape}, expected ({n}, 2)"
        )
    shaped = points.shape == (n, 2) and distances.shape == (n,)
    if not (shaped and _note_ways(rows, points, distances, crowd.records)):
        raise ModelError(
            f"behaviour {choice.name!r}: gave points of shape {points.shape} and distances of "
            f"shape {distances.shape}, expected ({n}, 2) finite ones and ({n},)"
        )
    return Targets(points, given.gates, distances, corners)


@Entry
@called()
def _note_ways(
    rows: NDArray[np.int64],
    points: NDArray[np.float64],
    distances: NDArray[np.float64],
    state: CrowdState,
) -> bool:
    """Note how far those in ``rows`` have to go, unless one of their targets is not finite."""
    for k in range(len(rows)):
        if not (abs(points[k, 0]) < np.inf and abs(points[k, 1]) < np.inf):
            return False
    for k in range(len(rows)):
        state[rows[k]].route = distances[k]
    return True
