"""Where to go: the behaviour that gives those who decide a target."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.inside import Inside
from mesa_mobility.crowd.surroundings import Site
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import Targets


@dataclass(frozen=True)
class Deciding:
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
    destinations: NDArray[np.int32]
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


def ask(choice: TargetChoice, deciding: Deciding) -> Targets:
    """The targets that a choice gives, checked.

    Raises:
        ModelError: points that are not finite, or arrays of other shapes.
    """
    targets = choice.targets(deciding)
    points, distances = np.asarray(targets.points), np.asarray(targets.distances)
    n = len(deciding.pedestrians)
    if points.shape != (n, 2) or distances.shape != (n,) or not np.isfinite(points).all():
        raise ModelError(
            f"behaviour {choice.name!r}: gave points of shape {points.shape} and distances of "
            f"shape {distances.shape}, expected ({n}, 2) finite ones and ({n},)"
        )
    return targets
