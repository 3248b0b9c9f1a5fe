"""Exponential decay for cost kernels."""

from mesa_mobility.steering import compiled


@compiled()
def decay(d: float) -> float:
    """e to the -d, for d of at least 0, to 1e-8 of itself; beyond d = 40 it is 4e-18.

    It is the 1024th power of a polynomial. Unlike a call of exp, arithmetic alone runs for several
    neighbours at once.
    """
    d = min(d, 40.0) * (1.0 / 1024.0)
    e = 1.0 - d * (1.0 - d * (1.0 / 2.0 - d * (1.0 / 6.0 - d * (1.0 / 24.0 - d * (1.0 / 120.0)))))
    e *= e
    e *= e
    e *= e
    e *= e
    e *= e
    e *= e
    e *= e
    e *= e
    e *= e
    e *= e
    return e
