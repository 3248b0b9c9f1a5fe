"""The search: CMA-ES between bounds, asked for sets of numbers and told how good they are."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from mesa_mobility.calibration.settings import Free, Search
from mesa_mobility.errors import ModelError


class Optimiser:
    """CMA-ES (Hansen, arXiv:1604.00772) of the package `cmaes`.

    The numbers asked for depend on the seed and on what was told, and on nothing else: a search is
    resumed by telling it the same again.

    Args:
        free: the numbers, each with bounds and start.
        search: how to search.
        seed: of the search.

    Raises:
        ModelError: `cmaes` is not installed.
    """

    def __init__(self, free: Sequence[Free], search: Search, seed: int) -> None:
        try:
            from cmaes import CMA
        except ImportError as error:
            raise ModelError(
                "calibration needs cmaes: pip install 'mesa-mobility[calibration]'"
            ) from error
        self._free = tuple(free)
        start = np.array([each.place(float(each.start or 0.0)) for each in free])
        self.candidates = search.candidates or 4 + math.floor(3.0 * math.log(len(free)))
        self._cma = CMA(
            mean=start,
            sigma=float(search.spread),
            bounds=np.tile([0.0, 1.0], (len(free), 1)),
            seed=seed,
            population_size=self.candidates,
        )

    def ask(self) -> list[dict[str, float]]:
        """The sets of numbers of the next generation."""
        self._asked = [self._cma.ask() for _ in range(self.candidates)]
        return [self._values(each) for each in self._asked]

    def tell(self, costs: Sequence[float]) -> None:
        """Say how good the sets are that were asked for last; small is good."""
        self._cma.tell(list(zip(self._asked, map(float, costs), strict=True)))

    @property
    def middle(self) -> dict[str, float]:
        """The middle of the distribution that the next sets are drawn from."""
        return self._values(self._cma.mean)

    @property
    def has_ended(self) -> bool:
        """Whether the sets hardly differ any more."""
        return bool(self._cma.should_stop())

    def _values(self, places: np.ndarray) -> dict[str, float]:
        return {each.name: each.value(at) for each, at in zip(self._free, places, strict=True)}


def costs_of(totals: Mapping[int, float | None], count: int) -> list[float]:
    """Costs for the search: sets of numbers with a run that failed are worse than all others.

    Args:
        totals: by number of the set; None where a run has failed.
        count: of sets.
    """
    known = [value for value in totals.values() if value is not None]
    worst = max(known) + 1.0
    return [worst if (value := totals[number]) is None else value for number in range(count)]
