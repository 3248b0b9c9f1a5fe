"""Standard errors of weights, for choices that are not independent of each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.estimation.likelihood import Value


def information(value: Value, free: NDArray[np.bool_]) -> NDArray[np.float64]:
    """(free, free) inverse of the observed information: what variances are without clusters."""
    inverse = np.linalg.pinv(-value.hessian[np.ix_(free, free)], hermitian=True)
    return np.asarray(inverse, dtype=np.float64)


def clustered(
    value: Value, free: NDArray[np.bool_], groups: NDArray[np.int64]
) -> NDArray[np.float64]:
    """(free, free) covariance of the weights, robust against dependence within groups.

    The sandwich of Huber (1967) and White (1982) with sums of scores by group, times G / (G - 1).

    Args:
        value: the likelihood at its maximum.
        free: (p,) which weights were estimated.
        groups: (choices,) group of each choice, such as its person.
    """
    sums = _sums(value, free, groups)
    bread, g = information(value, free), len(sums)
    return bread @ (sums.T @ sums) @ bread * (g / max(g - 1, 1))


def bootstrapped(
    value: Value,
    free: NDArray[np.bool_],
    blocks: NDArray[np.int64],
    repeats: int,
    rng: np.random.Generator,
) -> NDArray[np.float64]:
    """(repeats, free) changes of the weights when blocks of choices are drawn anew.

    One step of Newton's method for each draw of blocks with replacement (Davidson and MacKinnon,
    International Economic Review 40 (1999) 487-508).

    Args:
        value: the likelihood at its maximum.
        free: (p,) which weights were estimated.
        blocks: (choices,) block of each choice: a time within a run.
        repeats: number of draws.
        rng: the generator.
    """
    sums = _sums(value, free, blocks)
    drawn = rng.multinomial(len(sums), np.full(len(sums), 1.0 / len(sums)), size=repeats)
    steps: NDArray[np.float64] = drawn @ sums @ information(value, free)
    return steps


def _sums(value: Value, free: NDArray[np.bool_], groups: NDArray[np.int64]) -> NDArray[np.float64]:
    """(groups, free) sums of scores."""
    _, number = np.unique(groups, return_inverse=True)
    sums = np.zeros((int(number.max(initial=-1)) + 1, int(free.sum())))
    np.add.at(sums, number, value.scores[:, free])
    return sums


def blocks_of(
    run: NDArray[np.int64], second: NDArray[np.float64], length: float
) -> NDArray[np.int64]:
    """(choices,) number of the block of ``length`` seconds in its run."""
    of_run = np.floor(second / length).astype(np.int64)
    _, number = np.unique(np.column_stack([run, of_run]), axis=0, return_inverse=True)
    return number.reshape(-1)
