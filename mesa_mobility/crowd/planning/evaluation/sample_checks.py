"""Checks of behaviours on a sample of decisions.

The search takes it from a term that pair and wall costs are not negative and that bounds are lower
bounds. A kernel that breaks its word would make the search miss the best option, and nobody would
notice. So terms of others are looked at in the first decision and in ever fewer later ones.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.costs.compiled_terms import CompiledTerm
from mesa_mobility.crowd.costs.kernels import (
    BoundKernel,
    OptionKernel,
    PairBoundKernel,
    PairKernel,
    WallKernel,
)
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
        if isinstance(term.kernel, PairKernel | WallKernel):
            _check_sign(term, candidates)
        if isinstance(term.bound, BoundKernel) and isinstance(term.kernel, OptionKernel):
            _check_bound(term, term.bound, candidates, groups, cluster)
        elif isinstance(term.bound, PairBoundKernel):
            _check_pair_bound(term, term.bound, candidates, groups, cluster)


def _check_sign(term: CompiledTerm, candidates: Candidates) -> None:
    n = len(candidates)
    whole = isinstance(term.kernel, PairKernel)
    others = _nearest(candidates) if whole else range(min(len(candidates.walls), WALLS))
    for k in np.unique(np.linspace(0, n - 1, min(n, OPTIONS)).astype(int)).tolist():
        for other in others:
            cost = (
                _pair_cost(term, candidates, k, other)
                if whole
                else _wall_cost(term, candidates, k, other)
            )
            if cost < -ROUNDING:
                what = "neighbour" if whole else "wall"
                raise ModelError(
                    f"behaviour {term.name!r}: its kernel gives {cost:.6g} for option {k} and a "
                    f"{what} of pedestrian {candidates.pedestrians[0]}, expected 0 or more"
                )


def _check_bound(
    term: CompiledTerm,
    bound: BoundKernel,
    candidates: Candidates,
    groups: OptionGroups,
    cluster: int,
) -> None:
    costs = term.cost(candidates)
    own = [candidates.preferred_speeds[0]]
    if bound.own_velocity:
        own += candidates.velocities[0].tolist()
    for first, last, group in _groups(groups, cluster):
        least = _value(bound.function, *_extent(group, candidates), *own, _numbers(term))
        _compare(term, least, costs[first:last], first, candidates)


def _check_pair_bound(
    term: CompiledTerm,
    bound: PairBoundKernel,
    candidates: Candidates,
    groups: OptionGroups,
    cluster: int,
) -> None:
    for first, last, group in _groups(groups, cluster)[:OPTIONS]:
        for other in _nearest(candidates):
            costs = [_pair_cost(term, candidates, k, other) for k in range(first, last)]
            extent, them = _extent(group, candidates), _neighbour(candidates, other)
            least = _value(bound.function, *extent, *them, _numbers(term))
            _compare(term, least, np.array(costs), first, candidates)


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


def _extent(group: NDArray[np.float64], candidates: Candidates) -> list[float]:
    """The arguments of a bound up to the target."""
    x, y, radius, ux, uy, turn, duration, slowest, fastest = group.tolist()
    heading = float(candidates.facings[0])
    c, s = np.cos(heading), np.sin(heading)
    px, py = candidates.positions[0]
    return [
        px + c * x - s * y, py + s * x + c * y, radius, c * ux - s * uy, s * ux + c * uy, turn,
        duration, slowest, fastest, px, py, *candidates.targets[0],
    ]  # fmt: skip


def _option(candidates: Candidates, k: int) -> list[float]:
    """The arguments of a kernel up to the target."""
    heading = float(candidates.headings[k])
    return [
        *candidates.points[k], np.cos(heading), np.sin(heading), candidates.durations[k],
        candidates.speeds[k], *candidates.positions[0], *candidates.targets[0],
    ]  # fmt: skip


def _neighbour(candidates: Candidates, other: int) -> list[float]:
    return [
        *candidates.neighbour_positions[other], *candidates.neighbour_velocities[other],
        *candidates.neighbour_directions[other], candidates.leads[other],
    ]  # fmt: skip


def _pair_cost(term: CompiledTerm, candidates: Candidates, k: int, other: int) -> float:
    mine = [candidates.field(name)[0] for name in term.kernel.fields]
    theirs = [candidates.neighbour_field(name)[other] for name in term.kernel.fields]
    return _value(
        term.kernel.function,
        *_option(candidates, k),
        *_neighbour(candidates, other),
        *mine,
        *theirs,
        _numbers(term),
    )


def _wall_cost(term: CompiledTerm, candidates: Candidates, k: int, wall: int) -> float:
    return _value(
        term.kernel.function,
        *_option(candidates, k),
        *candidates.walls[wall],
        candidates.cores[0],
        _numbers(term),
    )


def _numbers(term: CompiledTerm) -> tuple[float, ...]:
    return tuple(term.parameters()) or (0.0,)


def _nearest(candidates: Candidates) -> list[int]:
    away = np.linalg.norm(candidates.neighbour_positions - candidates.positions[0], axis=1)
    order: list[int] = np.argsort(away, kind="stable")[:NEIGHBOURS].tolist()
    return order


def _value(function: Callable[..., float], *given: Any) -> float:
    """What a kernel's Python function gives; nan where compiled code divides by zero and goes on.

    The search itself refuses what is not a number.
    """
    try:
        with np.errstate(all="ignore"):
            return float(function(*given))
    except (ZeroDivisionError, ValueError, OverflowError):
        return float("nan")
