"""Checks of behaviours on a sample of decisions.

The search takes it from a term that pair and wall costs are not negative and that bounds are lower
bounds. A kernel that breaks its word would make the search miss the best option, and nobody would
notice. So terms of others are looked at in the first decision and in ever fewer later ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.costs.compiled_terms import CompiledTerm, nearest_ahead
from mesa_mobility.crowd.costs.kernels import CostKernel, PairKernel, WallKernel
from mesa_mobility.crowd.costs.records import Option, Options, Wall
from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.crowd.hooks import SHIPPED
from mesa_mobility.crowd.options.option_groups import OptionGroups
from mesa_mobility.errors import ModelError

MOST_BETWEEN = 4096
"""Frames with decisions after which one is looked at, at the latest."""

OPTIONS, NEIGHBOURS, WALLS = 24, 6, 6
"""How many options, nearest neighbours and walls of a decision are looked at."""

ROUNDING = 1e-6
"""Cost by which a bound may exceed a cost, or a cost lie below 0."""


class SampleChecks:
    """Decides which decisions are looked at, and looks."""

    def __init__(self) -> None:
        self._seen = 0
        self._next = 1

    def due(self, terms: Sequence[CostTerm]) -> list[CompiledTerm]:
        """The terms to look at in this frame; none in most frames, or if all of them ship."""
        others = [
            term
            for term in terms
            if isinstance(term, CompiledTerm)
            and not term.kernel.function.__module__.startswith(SHIPPED)
        ]
        if not others:
            return []
        self._seen += 1
        if self._seen < self._next:
            return []
        self._next += min(self._seen, MOST_BETWEEN)
        return others


def check_terms(
    terms: Sequence[CompiledTerm], candidates: Candidates, groups: OptionGroups, cluster: int
) -> None:
    """Check terms against one decision.

    Args:
        terms: compiled terms.
        candidates: the options of one pedestrian.
        groups: the options of all types in groups.
        cluster: the pedestrian's cluster, of all types.

    Raises:
        ModelError: a pair or wall kernel is negative, or a bound exceeds a cost.
    """
    for term in terms:
        for kernel in term.kernels():
            if isinstance(kernel, PairKernel | WallKernel):
                _check_sign(term, kernel, candidates)
        if term.bound is not None:
            _check_bound(term, term.bound, candidates, groups, cluster)


def _check_sign(term: CompiledTerm, kernel: CostKernel, candidates: Candidates) -> None:
    n = len(candidates)
    whole = isinstance(kernel, PairKernel)
    others = _nearest(candidates) if whole else range(min(len(candidates.walls), WALLS))
    for k in np.unique(np.linspace(0, n - 1, min(n, OPTIONS)).astype(int)).tolist():
        option = _option(candidates, k)
        for other in others:
            if whole:
                beside = {"other": _neighbour(kernel, candidates, other)}
            else:
                beside = {"wall": Wall(*candidates.walls[other].tolist())}
            cost = _value(term, kernel, candidates, option=option, **beside)
            if cost < -ROUNDING:
                what = "neighbour" if whole else "wall"
                raise ModelError(
                    f"behaviour {term.name!r}: its kernel gives {cost:.6g} for option {k} and a "
                    f"{what} of pedestrian {candidates.pedestrians[0]}, expected 0 or more"
                )


def _check_bound(
    term: CompiledTerm,
    bound: CostKernel,
    candidates: Candidates,
    groups: OptionGroups,
    cluster: int,
) -> None:
    costs = term.cost(candidates)
    for first, last, group in _groups(groups, cluster):
        least = _value(term, bound, candidates, options=_extent(group, candidates))
        _compare(term, least, costs[first:last], first, candidates)


def _compare(
    term: CompiledTerm, least: float, costs: NDArray[np.float64], first: int, candidates: Candidates
) -> None:
    if least > costs.min() + ROUNDING * max(1.0, abs(least)):
        raise ModelError(
            f"behaviour {term.name!r}: its bound is {least:.6g} for a group with option "
            f"{first + int(costs.argmin())} of pedestrian {candidates.pedestrians[0]}, which costs "
            f"{costs.min():.6g}; expected a bound of at most that"
        )


def _groups(groups: OptionGroups, cluster: int) -> list[tuple[int, int, NDArray[np.float64]]]:
    """First option of each group of a cluster and the one after its last, counted within the
    cluster, and its extent."""
    of = range(groups.clusters["first"][cluster], groups.clusters["last"][cluster])
    begin = int(groups.first[of[0]])
    return [
        (int(groups.first[g]) - begin, int(groups.first[g + 1]) - begin, groups.ends[:, g])
        for g in of
    ]


def _extent(group: NDArray[np.float64], candidates: Candidates) -> Options:
    """A group of options where the pedestrian stands."""
    x, y, radius, ux, uy, turn, duration, slowest, fastest = group.tolist()
    heading = float(candidates.facings[0])
    c, s = float(np.cos(heading)), float(np.sin(heading))
    px, py = candidates.positions[0].tolist()
    facing = c * ux - s * uy, s * ux + c * uy
    place = px + c * x - s * y, py + s * x + c * y
    return Options(*place, radius, *facing, turn, duration, slowest, fastest)


def _option(candidates: Candidates, k: int) -> Option:
    heading = float(candidates.headings[k])
    x, y = candidates.points[k].tolist()
    facing = float(np.cos(heading)), float(np.sin(heading))
    return Option(x, y, *facing, float(candidates.durations[k]), float(candidates.speeds[k]))


def _me(kernel: CostKernel, of: Candidates) -> Any:
    places = [*of.positions[0], *of.targets[0]]
    body = [of.cores[0], nearest_ahead(of)[0], of.facings[0]]
    values = [*places, of.preferred_speeds[0], *of.velocities[0], *body]
    declared = [of.field(name)[0] for name in kernel.declared]
    return kernel.kinds["me"](*map(float, [*values, of.types[0], of.groups[0], *declared]))


def _neighbour(kernel: CostKernel, of: Candidates, k: int) -> Any:
    moving = [*of.neighbour_positions[k], *of.neighbour_velocities[k]]
    values = [*moving, *of.neighbour_directions[k], of.leads[k], of.neighbour_cores[k]]
    kinds = [of.neighbour_facings[k], of.neighbour_types[k], of.neighbour_groups[k]]
    declared = [of.neighbour_field(name)[k] for name in kernel.declared]
    return kernel.kinds["other"](*map(float, [*values, *kinds, *declared]))


def _nearest(candidates: Candidates) -> list[int]:
    away = np.linalg.norm(candidates.neighbour_positions - candidates.positions[0], axis=1)
    order: list[int] = np.argsort(away, kind="stable")[:NEIGHBOURS].tolist()
    return order


def _value(term: CompiledTerm, kernel: CostKernel, candidates: Candidates, **records: Any) -> float:
    """What a kernel's Python function gives; nan where compiled code divides by zero and goes on.

    The search itself refuses what is not a number.
    """
    try:
        with np.errstate(all="ignore"):
            return float(kernel.value(me=_me(kernel, candidates), p=term, **records))
    except (ZeroDivisionError, ValueError, OverflowError):
        return float("nan")
