"""Leaving where others leave."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from mesa_mobility.behaviors.exits.exit_choice import Choosing
from mesa_mobility.behaviors.exits.random_utility import RandomUtility
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mesa_mobility import Range
from mesa_mobility.floorplan import lines_of_sight


class SocialInfluence(RandomUtility):
    """People take the exit that those in view head for, unless it is much farther.

    The share of the people in view who head for an exit is worth up to ``influence`` metres of
    way. That others' choices count beside distance was seen in experiments (Kinateder, Comunale
    and Warren 2018, Safety Science 106: 170-175) and is required by NIST TN 1822 (Verif.3.2); how
    much they count is to be calibrated: 5 m by default.

    Args:
        influence: what an exit is worth for which all in view head, metres.
        sight: how far people look, metres; walls hide, people do not.
        scale: of people's tastes, metres.
        interval: mean seconds between two choices.

    Raises:
        ModelError: a parameter out of range.
    """

    name = "social_influence"

    def __init__(
        self,
        influence: Annotated[float, Range(0.0, unit="m")] = 5.0,
        sight: Annotated[float, Range(0.0, unit="m", above=True)] = 15.0,
        scale: float = 2.0,
        interval: float = 2.0,
    ) -> None:
        super().__init__(scale, interval)
        self.influence = influence
        self.sight = sight

    def bonus(self, choosing: Choosing) -> NDArray[np.float64]:
        """(k, e) metres: the influence times the share of those in view who head for an exit."""
        inside, exits = choosing.deciding.inside, choosing.distances.shape[1]
        decided = np.flatnonzero(choosing.heading >= 0)
        places = inside.positions[decided]
        near = cKDTree(choosing.positions).sparse_distance_matrix(
            cKDTree(places), self.sight, output_type="ndarray"
        )
        who, seen = near["i"], near["j"]
        others = inside.pedestrians[decided[seen]] != choosing.pedestrians[who]
        seen, who = seen[others], who[others]
        clear = lines_of_sight(
            choosing.deciding.site.plan, choosing.positions[who], places[seen], 0.0
        )
        seen, who = seen[clear], who[clear]
        headed = np.zeros((len(choosing.positions), exits))
        np.add.at(headed, (who, choosing.heading[decided[seen]]), 1.0)
        return self.influence * headed / np.maximum(headed.sum(axis=1, keepdims=True), 1.0)
