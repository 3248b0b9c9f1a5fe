"""Cost terms as the search needs them: kernels in a table, NumPy terms as costs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.costs.compiled_terms import CompiledTerm, checked_numbers
from mesa_mobility.crowd.costs.kernels import (
    BoundKernel,
    CostKernel,
    OptionKernel,
    PairKernel,
    WallKernel,
)
from mesa_mobility.crowd.costs.layout import FIELDS, KernelTable, Terms
from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.crowd.planning.evaluation.candidate_batch import (
    Outlook,
    make_candidates,
    pairs_of,
)
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.output import numbers_given

NO_EXTRA = np.empty(0), np.zeros(1, dtype=np.int64)
"""What ``extra_costs`` returns without NumPy terms."""

_WEIGHTS = "weight", "weight_by_type", "for_types"

BATCH_PAIRS = 2_000_000
"""Pairs of an option and a neighbour laid out at once for terms in NumPy; bounds memory."""


def compile_terms(
    terms: Sequence[CostTerm], types: Sequence[str] = ("",)
) -> tuple[Terms, list[CostTerm]]:
    """Split terms into tables of compiled terms and a list of the others.

    Args:
        terms: the terms.
        types: names of the model's pedestrian types.

    Raises:
        ModelError: a kernel or a bound of the wrong kind, a term without an attribute that its
            kernel reads, or a weight for an unknown type.
    """
    compiled = [term for term in terms if isinstance(term, CompiledTerm)]
    names, of_others = fields_of(compiled)
    option, pair, wall = (
        [
            (term, kernel)
            for term in compiled
            for kernel in term.kernels()
            if isinstance(kernel, kind)
        ]
        for kind in (OptionKernel, PairKernel, WallKernel)
    )
    # A negative weight makes a lower bound an upper one.
    bounds = [
        (term, term.bound if (term.weights(types) >= 0.0).all() else None) for term, _ in option
    ]
    pairs = [kernel.pairs_address for _, kernel in pair if isinstance(kernel, PairKernel)]
    tables = Terms(
        option=_table(option, types, names),
        bound=_table(bounds, types, names),
        pair=_table(pair, types, names),
        pairs_address=np.array(pairs, dtype=np.int64),
        wall=_table(wall, types, names),
        fields=np.empty((1, 0)),
        of_others=of_others,
    )
    return tables, [term for term in terms if not isinstance(term, CompiledTerm)]


def fields_of(terms: Sequence[CostTerm]) -> tuple[list[str], int]:
    """Names of the fields that compiled terms take, and how many they take of neighbours.

    The latter come first.
    """
    compiled = [term for term in terms if isinstance(term, CompiledTerm)]
    kernels = [kernel for term in compiled for kernel in kernels_of(term)]
    of_others = dict.fromkeys(name for kernel in kernels for name in kernel.of_others)
    names = of_others | dict.fromkeys(name for kernel in kernels for name in kernel.fields)
    return list(names), len(of_others)


def kernels_of(term: CompiledTerm) -> list[CostKernel]:
    """The kernels of a term, and its bound if it has one.

    Raises:
        ModelError: one of them is of the wrong kind.
    """
    kernel, bound, called = term.kernel, term.bound, f"behaviour {term.name!r}"
    if not isinstance(kernel, OptionKernel | PairKernel | WallKernel):
        raise ModelError(
            f"{called}: its kernel is a {type(kernel).__name__}, expected what option_kernel or "
            "pair_kernel gives for one option"
        )
    if term.walls is not None and not (
        isinstance(term.walls, WallKernel) and isinstance(kernel, OptionKernel | PairKernel)
    ):
        raise ModelError(
            f"{called}: has a {type(kernel).__name__} and walls of a {type(term.walls).__name__}, "
            "expected an OptionKernel or a PairKernel, and a WallKernel"
        )
    if bound is None:
        return term.kernels()
    if not isinstance(bound, BoundKernel):
        raise ModelError(
            f"{called}: its bound is a {type(bound).__name__}, expected a BoundKernel: an "
            "option_kernel that asks for options"
        )
    if not isinstance(kernel, OptionKernel):
        raise ModelError(
            f"{called}: has a bound and a {type(kernel).__name__}, expected an OptionKernel"
        )
    return [*term.kernels(), bound]


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
        **crowd.kernel_fields,
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


class CompiledTerms:
    """``compile_terms``, cached until a term, a weight or a parameter changes.

    Args:
        types: names of the model's pedestrian types.
    """

    def __init__(self, types: Sequence[str]) -> None:
        self._types = tuple(types)
        self._terms: list[CostTerm] = []
        self._reads: list[Callable[[CostTerm], object]] = []
        self._key: object = None

    def __call__(self, terms: Sequence[CostTerm], crowd: Crowd) -> tuple[Terms, list[CostTerm]]:
        """The table of the compiled terms, with the fields that they take, and the others."""
        if self._terms != terms or self._key != self._read():
            self._terms = list(terms)
            self._now = compile_terms(terms, self._types)
            self._fields, _ = fields_of(terms)
            self._reads = [_reader(term) for term in terms]
            self._key = self._read()
        compiled, others = self._now
        if self._fields:
            compiled = compiled._replace(fields=field_values(self._fields, crowd))
        return compiled, others

    def _read(self) -> list[object]:
        """All that the table is made of; this is compared in each frame."""
        try:
            return [read(term) for read, term in zip(self._reads, self._terms, strict=True)]
        except AttributeError:  # compiling names what is missing
            return []


def _reader(term: CostTerm) -> Callable[[CostTerm], object]:
    """What reads all of a term that its table is made of."""
    if not isinstance(term, CompiledTerm):
        return attrgetter(*_WEIGHTS)
    numbers = [name for kernel in kernels_of(term) for name in kernel.numbers]
    return attrgetter(*_WEIGHTS, "kernel", "bound", *numbers)


def _table(
    kernels: Sequence[tuple[CompiledTerm, CostKernel | None]],
    types: Sequence[str],
    names: list[str],
) -> KernelTable:
    """The table of a kernel of each term, where it has one; ``names`` are the fields laid out."""
    numbers, fields = [], []
    for term, kernel in kernels:
        numbers.append(np.zeros(1) if kernel is None else checked_numbers(term, kernel))
        taken = () if kernel is None else kernel.fields
        fields.append(np.array([FIELDS + names.index(name) for name in taken], dtype=np.int64))
    weights = np.array([term.weights(types) for term, _ in kernels])
    return KernelTable(
        np.array([0 if each is None else each.address for _, each in kernels], dtype=np.int64),
        np.ascontiguousarray(weights.reshape(len(kernels), len(types)).T),
        _rows(numbers, np.float64),
        _rows(fields, np.int64),
    )


def _rows(rows: Sequence[NDArray[Any]], kind: type) -> NDArray[Any]:
    """Rows of unequal lengths as an array, filled up with 0."""
    filled: NDArray[Any] = np.zeros((len(rows), max([1, *map(len, rows)])), dtype=kind)
    for at, row in enumerate(rows):
        filled[at, : len(row)] = row
    return filled


def extra_costs(
    terms: Sequence[CostTerm],
    rows: NDArray[np.int64],
    outlook: Outlook,
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
    batch = np.cumsum(pairs_of(rows, outlook)) // BATCH_PAIRS
    for part in np.split(rows, np.flatnonzero(np.diff(batch)) + 1):
        candidates = make_candidates(part, outlook)
        total = np.zeros(len(candidates))
        for term in terms:
            if term.for_types is None:
                total += _weighted(term, candidates, types)
                continue
            having = (term.weights(types) != 0.0)[candidates.types]
            if having.any():
                own = make_candidates(part[having], outlook)
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
