"""What every distribution is: quantiles, and draws in strata."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray


class Distribution(ABC):
    """A distribution of numbers: seconds, or m/s.

    Examples:
        >>> import numpy as np
        >>> from mesa_mobility.distributions import Normal, Uniform, parse
        >>> rng = np.random.default_rng(1)
        >>> np.sort(Uniform(0.0, 4.0).draw(4, rng)).astype(int)  # one from each quarter
        array([0, 1, 2, 3])
        >>> parse("normal(1.34, 0.26)") == Normal(1.34, 0.26)
        True
    """

    @abstractmethod
    def quantile(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) values below which these shares of the distribution lie, each in (0, 1)."""

    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) draws, one from each of n equal parts of the distribution, in random order.

        One draw alone has the distribution itself. For draws that are independent of one another,
        as many single ones.
        """
        return self.quantile(strata(n, rng))


EXTREMES = (2.0**-54, 1.0 - 2.0**-53)
"""Least and greatest share of a distribution that is drawn."""


def strata(n: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """(n,) shares in (0, 1), one at random in each nth part, in random order.

    Latin hypercube sampling in one dimension (McKay, Beckman and Conover 1979, Technometrics 21:
    239-245).
    """
    share = (rng.permutation(n) + rng.random(n)) / max(n, 1)
    # 0 and 1, which rounding can give, have no quantile.
    return np.clip(share, *EXTREMES)
