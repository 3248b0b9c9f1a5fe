"""Cost terms as the search needs them: kernels in a table, NumPy terms as costs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.costs.candidates import Candidates, Moment
from mesa_mobility.crowd.costs.compiled_terms import CompiledTerm
from mesa_mobility.crowd.costs.kernel_reads import parameters_read
from mesa_mobility.crowd.costs.kernels import (
    BoundKernel,
    CostKernel,
    PairBoundKernel,
    PairKernel,
    WallKernel,
)
from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.crowd.options.table import OptionTable
from mesa_mobility.crowd.planning.evaluation.candidate_batch import make_candidates, pairs_of
from mesa_mobility.crowd.planning.evaluation.option_costs import Terms
from mesa_mobility.crowd.planning.workspace import Rules
from mesa_mobility.crowd.state.people_grid import Grid
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.state.surroundings import Surroundings
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.output import numbers_given

NO_EXTRA = np.empty(0), np.zeros(1, dtype=np.int64)
"""What ``extra_costs`` returns without NumPy terms."""

PAST_THE_END = 8
"""Parameters behind those of a term that are no numbers."""

BATCH_PAIRS = 2_000_000
"""Pairs of an option and a neighbour laid out at once for terms in NumPy; bounds memory."""


def compile_terms(
    terms: Sequence[CostTerm], types: Sequence[str] = ("",)
) -> tuple[Terms, list[CostTerm]]:
    """Split terms into a table of compiled terms and a list of the others.

    Args:
        terms: the terms.
        types: names of the model's pedestrian types.

    Raises:
        ModelError: a bound of another kind, of a kernel with fields, or a weight for an unknown
            type.
    """
    option: list[CompiledTerm] = []
    pair: list[CompiledTerm] = []
    wall: list[CompiledTerm] = []
    others: list[CostTerm] = []
    for term in terms:
        if not isinstance(term, CompiledTerm):
            others.append(term)
        elif isinstance(term.kernel, PairKernel):
            pair.append(term)
        elif isinstance(term.kernel, WallKernel):
            wall.append(term)
        else:
            option.append(term)
    pairs_address = [
        term.kernel.pairs_address for term in pair if isinstance(term.kernel, PairKernel)
    ]
    names = fields_of(terms)
    option_bounds = _bounds(option, BoundKernel, types)
    pair_bounds = _bounds(pair, PairBoundKernel, types)
    compiled = Terms(
        np.array(option_bounds, dtype=np.int64),
        *_table(option, types),
        _taken(option, names),
        *_table(pair, types),
        _taken(pair, names),
        np.array(pairs_address, dtype=np.int64),
        np.array(pair_bounds, dtype=np.int64),
        *_table(wall, types),
        np.empty((1, 0)),
    )
    return compiled, others


def fields_of(terms: Sequence[CostTerm]) -> list[str]:
    """Names of the fields that any of the compiled terms takes."""
    compiled = [term for term in terms if isinstance(term, CompiledTerm)]
    return list(dict.fromkeys(name for term in compiled for name in term.kernel.fields))


def _taken(terms: Sequence[CompiledTerm], names: list[str]) -> NDArray[np.int64]:
    """(terms, most) which of the named fields each term takes."""
    width = max([1] + [len(term.kernel.fields) for term in terms])
    taken = np.zeros((len(terms), width), dtype=np.int64)
    for row, term in enumerate(terms):
        taken[row, : len(term.kernel.fields)] = [names.index(name) for name in term.kernel.fields]
    return taken


def field_values(names: Sequence[str], crowd: Crowd) -> NDArray[np.float64]:
    """(people, names) the values of fields, as kernels take them.

    Raises:
        ModelError: the model does not declare one of them.
    """
    at_hand: dict[str, NDArray[Any]] = {
        "type": crowd.type_index,
        "group": crowd.agenda["group"],
        "heading": crowd.heading,
        "core": crowd.core,
        **crowd.fields,
    }
    values = np.empty((len(crowd.x), len(names)))
    for column, name in enumerate(names):
        if name not in at_hand:
            raise ModelError(
                f"a behaviour takes the field {name!r}, which is not declared; there are "
                f"{', '.join(at_hand)}"
            )
        values[:, column] = at_hand[name]
    return values


def _bounds(
    terms: Sequence[CompiledTerm], kind: type[CostKernel], types: Sequence[str]
) -> list[int]:
    """Addresses of the lower bounds; 0 for none, or where a negative weight turns one over."""
    for term in terms:
        if not isinstance(term.bound, kind | None):
            raise ModelError(
                f"behaviour {term.name!r}: its bound is a {type(term.bound).__name__}, "
                f"expected a {kind.__name__}"
            )
        if term.bound is not None and term.kernel.fields:
            raise ModelError(
                f"behaviour {term.name!r}: has a bound and a kernel with fields, expected no bound"
            )
    bounds = [term.bound if (term.weights(types) >= 0.0).all() else None for term in terms]
    return [0 if bound is None else bound.address for bound in bounds]


class CompiledTerms:
    """``compile_terms``, cached until a term, a weight or a parameter changes.

    Args:
        types: names of the model's pedestrian types.
    """

    def __init__(self, types: Sequence[str]) -> None:
        self._types = tuple(types)
        self._terms: list[CostTerm] = []
        self._compiled: list[CompiledTerm] = []
        self._key: object = None

    def __call__(self, terms: Sequence[CostTerm], crowd: Crowd) -> tuple[Terms, list[CostTerm]]:
        """The table of the compiled terms, with the fields that they take, and the others."""
        if self._terms != terms:
            self._terms, self._key = list(terms), None
            self._compiled = [term for term in terms if isinstance(term, CompiledTerm)]
        key = (
            [(term.weight, term.weight_by_type, term.for_types) for term in self._terms],
            [term.parameters() for term in self._compiled],
        )
        if key != self._key:
            self._key = key
            self._now = compile_terms(terms, self._types)
            self._fields = fields_of(terms)
        compiled, others = self._now
        if self._fields:
            compiled = compiled._replace(fields=field_values(self._fields, crowd))
        return compiled, others


def _table(
    terms: Sequence[CompiledTerm], types: Sequence[str]
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Address of each term, its weights by type, and its parameters."""
    # An index that is computed and past the end gives no number, which the search refuses.
    width = max([0] + [len(term.parameters()) for term in terms]) + PAST_THE_END
    parameters = np.full((len(terms), width), np.nan)
    for row, term in enumerate(terms):
        own = term.parameters()
        for kernel in (term.kernel, term.bound):
            _check_reads(term, kernel, len(own))
        parameters[row, : len(own)] = numbers_given(
            f"behaviour {term.name!r}", "parameters", own, (len(own),)
        )
    addresses = np.array([term.kernel.address for term in terms], dtype=np.int64)
    weights = np.array([term.weights(types) for term in terms]).reshape(len(terms), len(types))
    return addresses, np.ascontiguousarray(weights.T), parameters


def _check_reads(term: CompiledTerm, kernel: CostKernel | None, given: int) -> None:
    """Raise ModelError where a kernel reads parameters that the term does not give."""
    read = set() if kernel is None else parameters_read(kernel.function)
    wrong = sorted(index for index in read if not 0 <= index < given)
    if wrong:
        raise ModelError(
            f"behaviour {term.name!r}: its kernel reads parameters[{wrong[-1]}], but parameters() "
            f"gives {given} numbers"
        )


def extra_costs(
    terms: Sequence[CostTerm],
    rows: NDArray[np.int64],
    table: OptionTable,
    state: Crowd,
    grid: Grid,
    around: Surroundings,
    rules: Rules,
    moment: Moment,
    types: Sequence[str],
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Weighted sum of terms in NumPy over all options of the pedestrians in ``rows``.

    Returns:
        The costs, options of each pedestrian in turn, and (len(rows) + 1,) the start of each one's
        part.

    Raises:
        ModelError: a term gives the wrong number of costs, or values that are not numbers.
    """
    parts = []
    counts = []
    batch = np.cumsum(pairs_of(rows, table, state, grid, rules)) // BATCH_PAIRS
    for part in np.split(rows, np.flatnonzero(np.diff(batch)) + 1):
        candidates = make_candidates(part, table, state, grid, around, rules, moment)
        total = np.zeros(len(candidates))
        for term in terms:
            if term.for_types is None:
                total += _weighted(term, candidates, types)
                continue
            having = (term.weights(types) != 0.0)[candidates.types]
            if having.any():
                own = make_candidates(part[having], table, state, grid, around, rules, moment)
                total[having[candidates.owner]] += _weighted(term, own, types)
        parts.append(total)
        counts.append(np.diff(candidates.offsets))
    offsets = np.concatenate([[0], np.cumsum(np.concatenate(counts))]).astype(np.int64)
    return np.concatenate(parts), offsets


def _weighted(term: CostTerm, candidates: Candidates, types: Sequence[str]) -> NDArray[np.float64]:
    """(n,) costs of options with their weights."""
    giver = f"behaviour {term.name!r}"
    cost = numbers_given(giver, "costs", term.cost(candidates), (len(candidates),))
    if not np.isfinite(cost).all():
        option = int(np.argmin(np.isfinite(cost)))
        raise ModelError(
            f"{giver}: gave a cost of {cost[option]} for option {option} of {len(cost)}, "
            "expected finite numbers"
        )
    if term.weight_by_type:
        return cost * term.weights(types)[candidates.types[candidates.owner]]
    return term.weight * cost
