"""Cost terms: what a behaviour is made of.

The cost of a movement option is the weighted sum of its terms (equation 1 of
the paper).  A behaviour is one more term.  Terms see all options of everybody
who decides now and give one number for each; they never see one another, so
their order changes nothing.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mesa_mobility.crowd.candidates import Candidates
from mesa_mobility.crowd.kernels import CostKernel, OptionKernel, PairKernel, call_kernel
from mesa_mobility.errors import ModelError


class CostTerm(ABC):
    """One additive term of the cost of a movement option.

    Subclasses set ``name`` and give ``cost``.  The engine multiplies by ``weight``.

    Attributes:
        name: unique name of the term, as it is registered and shown.
        weight: factor of the term in the sum; may be changed while a model runs.
    """

    name: ClassVar[str]
    default_weight: ClassVar[float] = 1.0

    def __init__(self, weight: float | None = None) -> None:
        self.weight = self.default_weight if weight is None else weight

    @property
    def weight(self) -> float:
        """Factor of this term in the sum."""
        return self._weight

    @weight.setter
    def weight(self, value: float) -> None:
        if not np.isfinite(value):
            raise ModelError(f"weight of {self.name!r}: got {value}, expected a finite number")
        self._weight = float(value)

    @abstractmethod
    def cost(self, candidates: Candidates) -> NDArray[np.float64]:
        """Cost of each option, without the weight.

        Args:
            candidates: options of any number of pedestrians.

        Returns:
            (n,) one finite number per option.
        """


class CompiledTerm(CostTerm):
    """A term given as a kernel: evaluated inside the compiled choice.

    Attributes:
        kernel: an ``option_kernel``, or a ``pair_kernel`` that is summed over the neighbours.
            A pair kernel must never be negative: the other terms are then a lower bound of
            the whole, and pairs are worked out only for options that can still win.
    """

    kernel: ClassVar[CostKernel]

    def parameters(self) -> tuple[float, ...]:
        """Numbers that the kernel reads as ``parameters[0]``, ``parameters[1]``, ..."""
        return ()

    def cost(self, candidates: Candidates) -> NDArray[np.float64]:
        """Cost of each option, by calling the kernel on each row."""
        numbers = np.array(self.parameters() or (0.0,), dtype=np.float64)
        if isinstance(self.kernel, PairKernel):
            rows, neighbours = candidates.pairs()
            costs = _each_pair(
                self.kernel.address, candidates.points[rows], candidates.headings[rows],
                candidates.durations[rows], candidates.speeds[rows],
                candidates.neighbour_positions[neighbours],
                candidates.neighbour_velocities[neighbours], numbers,
            )  # fmt: skip
            return np.bincount(rows, costs, minlength=len(candidates)).astype(np.float64)
        assert isinstance(self.kernel, OptionKernel)
        return _each_option(
            self.kernel.address, candidates.points, candidates.headings,
            candidates.displacements, candidates.durations, candidates.speeds,
            candidates.targets[candidates.owner], candidates.preferred_speeds[candidates.owner],
            numbers,
        )  # fmt: skip


@njit(cache=True)
def _each_option(
    address: int,
    points: NDArray[np.float64],
    headings: NDArray[np.float64],
    displacements: NDArray[np.float64],
    durations: NDArray[np.float64],
    speeds: NDArray[np.float64],
    targets: NDArray[np.float64],
    preferred: NDArray[np.float64],
    numbers: NDArray[np.float64],
) -> NDArray[np.float64]:
    out = np.empty(len(points))
    for i in range(len(points)):
        out[i] = call_kernel(
            address, points[i, 0], points[i, 1], headings[i], displacements[i], durations[i],
            speeds[i], targets[i, 0], targets[i, 1], preferred[i], numbers,
        )  # fmt: skip
    return out


@njit(cache=True)
def _each_pair(
    address: int,
    points: NDArray[np.float64],
    headings: NDArray[np.float64],
    durations: NDArray[np.float64],
    speeds: NDArray[np.float64],
    positions: NDArray[np.float64],
    velocities: NDArray[np.float64],
    numbers: NDArray[np.float64],
) -> NDArray[np.float64]:
    out = np.empty(len(points))
    for i in range(len(points)):
        out[i] = call_kernel(
            address, points[i, 0], points[i, 1], headings[i], durations[i], speeds[i],
            positions[i, 0], positions[i, 1], velocities[i, 0], velocities[i, 1], numbers,
        )  # fmt: skip
    return out
