"""Target choice: the behaviour that gives deciding pedestrians their targets."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.crowd.state.records import FARTHEST, Crowd, CrowdState
from mesa_mobility.crowd.tactics.deciding import Deciding
from mesa_mobility.crowd.tactics.unchanged import Given
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import Targets
from mesa_mobility.plugins.output import numbers_given, whole_numbers_given

_BAD_POINTS, _BAD_DISTANCES, _BAD_GATES, _BAD_CORNERS = 1, 2, 3, 4

_NO_CORNERS = np.empty((0, 2), dtype=np.int64)


class TargetChoice(Plugin):
    """A behaviour that gives each deciding pedestrian a target.

    The model asks it for targets when the movements of people end, as in section 6 of the paper,
    "A Data-Driven Model of Pedestrian Movement". Subclasses set ``name`` and define
    ``targets``. A model has one target choice.
    """

    @abstractmethod
    def targets(self, deciding: Deciding) -> Targets:
        """Target of each deciding pedestrian, and the length of their remaining route.

        Returns:
            ``Targets`` of the n deciding people: ``points`` (n, 2), the point to which each walks,
            and ``distances`` (n,), the length of each route, both in metres. A distance is inf
            where there is no way. People with smaller distances decide first. The tactic
            ``visits`` also reads ``distances``: with it, people slow down before a place of their
            route at which they stay. Copy ``gates`` (n,) and ``corners`` (n, 2) from what
            ``deciding.site.targets`` gives. If you do not use that, set all gates to -1, and
            ``corners`` to None. The model raises ModelError if this is not ``Targets``, or if an
            array has a wrong shape or values out of range (see ``query_targets``).
        """


def query_targets(choice: TargetChoice, deciding: Deciding, crowd: Crowd, frozen: Given) -> Targets:
    """The targets that a choice gives, checked and as arrays for compiled functions.

    The length of each route is written to the crowd.

    Raises:
        ModelError: not ``Targets``, arrays of the wrong shape, values out of range, or what the
            choice was given is changed.
    """
    outside = frozen.keep(choice)
    given, giver = choice.targets(deciding), f"behaviour {choice.name!r}"
    if outside:
        frozen.check(choice)
    if not isinstance(given, Targets):
        raise ModelError(f"{giver}: gave {type(given).__name__}, expected Targets")
    rows, n = deciding.pedestrians, len(deciding.pedestrians)
    points = numbers_given(giver, "points", given.points, (n, 2))
    distances = numbers_given(giver, "distances", given.distances, (n,))
    gates = whole_numbers_given(giver, "gates", given.gates, (n,))
    corners = _NO_CORNERS
    if given.corners is not None:
        corners = whole_numbers_given(giver, "corners", given.corners, (n, 2))
    openings, known = len(deciding.site.plan.openings()), deciding.site.corners.count
    wrong = _note_ways(rows, points, distances, gates, corners, openings, known, crowd.records)
    if not wrong and not deciding.site.corners.of_one_router(corners):
        wrong = _BAD_CORNERS
    if wrong:
        expected = {
            _BAD_POINTS: f"points, expected finite ones within {FARTHEST:g} m",
            _BAD_DISTANCES: "distances, expected metres, or inf where there is no way",
            _BAD_GATES: f"gates, expected -1 or numbers of openings, 0 to {openings - 1}",
            _BAD_CORNERS: f"corners, expected two of the site's, 0 to {known - 1}, or -1 for none",
        }
        raise ModelError(f"{giver}: gave other {expected[wrong]}")
    known_corners = None if given.corners is None else corners
    return Targets(points, gates, distances, known_corners, given.floor)


@entry_point()
def _note_ways(
    rows: NDArray[np.int64],
    points: NDArray[np.float64],
    distances: NDArray[np.float64],
    gates: NDArray[np.int64],
    corners: NDArray[np.int64],
    openings: int,
    known: int,
    state: CrowdState,
) -> int:
    """Write the route lengths of those in ``rows``; returns 0, or a code of what is wrong."""
    for k in range(len(rows)):
        if not (abs(points[k, 0]) <= FARTHEST and abs(points[k, 1]) <= FARTHEST):
            return _BAD_POINTS
        if not distances[k] > -np.inf:
            return _BAD_DISTANCES
        if not -1 <= gates[k] < openings:
            return _BAD_GATES
    for k in range(len(corners)):
        corner, following = corners[k, 0], corners[k, 1]
        # A corner to pass is followed by another node.
        if not (-1 <= corner < known and -1 <= following < known and following >= min(corner, 0)):
            return _BAD_CORNERS
    for k in range(len(rows)):
        state[rows[k]].route = distances[k]
    return 0
