"""Which of the given places people of each type get, where some are wider than others."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree


def suited(
    points: NDArray[np.float64],
    kinds: NDArray[np.int64],
    cores: NDArray[np.float64],
    suits: Callable[[int], NDArray[np.bool_]],
    others: tuple[NDArray[np.float64], NDArray[np.float64]],
    rng: np.random.Generator,
) -> tuple[NDArray[np.int64], tuple[int, int] | None]:
    """Give wide people places with room for them; the narrowest take what is left.

    From the widest type on, each person gets a random one of the suitable places: those in
    ``suits``, far enough from people there and from wider ones placed before, with room for one of
    the narrowest at every other place.

    Args:
        points: (n, 2) places, metres.
        kinds: (n,) type of each person.
        cores: (types,) core radii, metres.
        suits: gives (n,) whether a body of this type can stand at each place and leave.
        others: (k, 2) places and (k,) core radii of people who are there, metres.
        rng: drawn from.

    Returns:
        (n,) the same types in another order; and None, or a type with the number of people of it
        for whom there is room, if those are too few.
    """
    narrowest = float(cores[kinds].min())
    there = np.unique(kinds)
    wide = sorted(there[cores[there] > narrowest].tolist(), key=lambda kind: -cores[kind])
    if not wide:
        return kinds, None
    tree = cKDTree(points)
    found = np.full(len(points), -1, dtype=np.int64)
    order = rng.permutation(len(points))
    for kind in wide:
        core, wanted, got = float(cores[kind]), int((kinds == kind).sum()), 0
        free = suits(kind) & (found < 0)
        if len(others[0]):
            away = np.hypot(*(points[:, None] - others[0][None]).transpose(2, 0, 1))
            free &= (away >= core + others[1]).all(axis=1)
        for place in order[free[order]].tolist():
            if got == wanted:
                break
            near = [
                k
                for k in tree.query_ball_point(points[place], 2.0 * float(cores.max()))
                if k != place
            ]
            away = np.hypot(*(points[near] - points[place]).T)
            beside = np.where(found[near] >= 0, cores[found[near]], narrowest)
            if (away >= core + beside).all():
                found[place] = kind
                got += 1
        if got < wanted:
            return kinds, (kind, got)
    rest = np.flatnonzero(found < 0)
    left = kinds[np.isin(kinds, wide, invert=True)]
    found[rest] = left
    return found, None
