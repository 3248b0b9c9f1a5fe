"""Observed choices with the costs of some terms: all that weights are estimated from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.errors import ModelError
from mesa_mobility.estimation.choices.observations import Observations
from mesa_mobility.estimation.likelihood import (
    Layout,
    Rows,
    Value,
    evaluate,
    latent,
    layout_of,
    rows_of,
    standard,
)
from mesa_mobility.plugins.registry import load_behavior

ALIKE = 1.0 - 1e-6
"""Share of a term's variance over options from which on others explain it."""


def as_terms(terms: Sequence[CostTerm | str]) -> list[CostTerm]:
    """Cost terms, or those registered by name.

    Raises:
        ModelError: nothing, something else, an unknown name, or one name twice.
    """
    found = [load_behavior(each)() if isinstance(each, str) else each for each in terms]
    for each in found:
        if not isinstance(each, CostTerm):
            raise ModelError(f"terms: got {each!r:.60}, expected cost terms or their names")
    names = [each.name for each in found]
    twice = [name for name in names if names.count(name) > 1]
    if twice or not found:
        got = f"{twice[0]!r} twice" if twice else "nothing"
        raise ModelError(f"terms: got {got}, expected cost terms of different names")
    return found


class Sample(NamedTuple):
    """Choices, and what their options cost.

    Attributes:
        rows: the options.
        costs: (rows, p) cost of each term, without weights.
        choices: (n,) numbers of the choices among those observed.
    """

    rows: Rows
    costs: NDArray[np.float64]
    choices: NDArray[np.int64]

    def value(self, weights: NDArray[np.float64]) -> Value:
        """The likelihood with (p,) weights."""
        return evaluate(self.rows, self.costs, weights)


@dataclass(frozen=True, eq=False)
class Problem:
    """Observed choices and terms.

    Attributes:
        observations: the choices.
        terms: the terms.
        costs: (rows, p) what options cost by each.
    """

    observations: Observations
    terms: tuple[CostTerm, ...]
    costs: NDArray[np.float64]

    @classmethod
    def of(cls, terms: Sequence[CostTerm | str], observations: Observations) -> Problem:
        """The costs of these terms.

        Raises:
            ModelError: what ``as_terms`` refuses, or costs that are not finite numbers.
        """
        found = as_terms(terms)
        return cls(
            observations,
            tuple(found),
            np.column_stack([observations.costs(each) for each in found]),
        )

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the terms."""
        return tuple(each.name for each in self.terms)

    @property
    def given(self) -> NDArray[np.float64]:
        """(p,) the weights that the terms have."""
        return np.array([each.weight for each in self.terms])

    @cached_property
    def layout(self) -> Layout:
        """The rows of all choices."""
        return layout_of(self.observations)

    @cached_property
    def segments(self) -> NDArray[np.int64]:
        """(segments,) first row of each."""
        return np.cumsum(self.layout.sizes) - self.layout.sizes

    def with_terms(self, kept: Sequence[int]) -> Problem:
        """The same choices with some of the terms, by number."""
        return Problem(
            self.observations, tuple(self.terms[k] for k in kept), self.costs[:, list(kept)]
        )

    def sample(self, measure: str = "latent", chosen: NDArray[np.bool_] | None = None) -> Sample:
        """Matched choices, by one of two measures.

        Args:
            measure: ``"latent"``, the likelihood of ends, or ``"standard"``, that of an end among
                options drawn uniformly.
            chosen: (choices,) which; by default all.
        """
        matched = self.layout.matched if chosen is None else self.layout.matched & chosen
        fit, counts = (latent if measure == "latent" else standard)(self.layout)
        rows, at = rows_of(self.layout, matched, fit, counts)
        return Sample(rows, self.costs[at], np.flatnonzero(matched))

    @cached_property
    def spreads(self) -> NDArray[np.float64]:
        """(rows, p) costs less their means over the options of a choice."""
        means = np.add.reduceat(self.costs, self.segments) / self.layout.sizes[:, None]
        return self.costs - np.repeat(means, self.layout.sizes, axis=0)

    def check(self) -> None:
        """Refuse terms whose weights cannot be told.

        Raises:
            ModelError: a term is constant over all options, or others add up to it; it is named.
        """
        spreads = self.spreads
        size = np.sqrt(np.mean(spreads**2, axis=0))
        scale = np.maximum(np.abs(self.costs).max(axis=0), 1e-12)
        for name, own, least in zip(self.names, size, 1e-9 * scale, strict=True):
            if own <= least:
                raise ModelError(
                    f"behaviour {name!r}: costs the same for all options of every choice, expected "
                    "a term that tells them apart; leave it out"
                )
        correlation = spreads.T @ spreads / len(spreads) / np.outer(size, size)
        for k, name in enumerate(self.names):
            others = [j for j in range(len(self.names)) if j != k]
            if not others:
                continue
            own = correlation[k, others]
            solved = np.linalg.lstsq(correlation[np.ix_(others, others)], own, rcond=None)[0]
            if own @ solved > ALIKE:
                shares = np.abs(solved)
                of = [self.names[others[j]] for j in np.flatnonzero(shares > 1e-3 * shares.max())]
                raise ModelError(
                    f"behaviour {name!r}: is collinear with {', '.join(map(repr, of))} over the "
                    "options of all choices, expected terms that differ; leave one of them out"
                )
