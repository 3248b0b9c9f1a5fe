"""Cost terms that are kernels, evaluated inside the compiled search."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import kept
from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.costs.kernel_calls import (
    call_option_loop,
    call_pair_loop,
    call_wall_loop,
)
from mesa_mobility.crowd.costs.kernels import (
    BoundKernel,
    CostKernel,
    PairBoundKernel,
    PairKernel,
    WallKernel,
)
from mesa_mobility.crowd.costs.layout import (
    COST,
    END_UX,
    END_UY,
    END_X,
    END_Y,
    FIELDS,
    LEAD,
    OTHER_EX,
    OTHER_EY,
    OTHER_VX,
    OTHER_VY,
    OTHER_X,
    OTHER_Y,
    SECONDS,
    SPEED,
)
from mesa_mobility.crowd.costs.terms import CostTerm


class CompiledTerm(CostTerm):
    """A term given as a kernel, evaluated inside the compiled search.

    Attributes:
        kernel: an ``option_kernel``, a ``pair_kernel`` that is summed over the neighbours, or a
            ``wall_kernel`` that counts for the worst wall.  Pair and wall kernels must never be
            negative: the other terms are then a lower bound of the sum, and pairs and walls are
            evaluated only for options that can still win.
        bound: a ``bound_kernel`` of an option kernel, a ``pair_bound_kernel`` of a pair kernel, or
            None.  Without a bound of an option kernel, every term is evaluated for all options,
            not only for those that can still win.  A bound of a pair kernel saves time where the
            kernel often decides which option wins.
    """

    kernel: ClassVar[CostKernel]
    bound: ClassVar[BoundKernel | PairBoundKernel | None] = None

    def parameters(self) -> tuple[float, ...]:
        """Numbers that the kernel reads as ``parameters[0]``, ``parameters[1]``, ..."""
        return ()

    def cost(self, candidates: Candidates) -> NDArray[np.float64]:
        """Cost of each option, by calling the kernel on each row."""
        numbers = np.array((*self.parameters(), np.nan), dtype=np.float64)
        ends = np.array(
            [
                *candidates.points.T,
                np.cos(candidates.headings),
                np.sin(candidates.headings),
                candidates.durations,
                candidates.speeds,
            ]
        )
        mine = np.zeros((len(candidates.pedestrians), len(self.kernel.fields)))
        for column, name in enumerate(self.kernel.fields):
            mine[:, column] = candidates.field(name)
        at = np.arange(max(len(self.kernel.fields), 1))
        if isinstance(self.kernel, PairKernel):
            x, y = candidates.neighbour_positions.T
            vx, vy = candidates.neighbour_velocities.T
            ex, ey = candidates.neighbour_directions.T
            return _each_pair(
                self.kernel.address, candidates.owner, ends, candidates.positions,
                candidates.targets, candidates.neighbour_offsets,
                np.array(
                    [x, y, vx, vy, ex, ey, candidates.leads, np.empty_like(x),
                     *(candidates.neighbour_field(name) for name in self.kernel.fields)]
                ),
                mine, at, numbers,
            )  # fmt: skip
        if isinstance(self.kernel, WallKernel):
            return _each_wall(
                self.kernel.address, candidates.owner, ends, candidates.positions,
                candidates.targets, candidates.cores, candidates.wall_offsets,
                np.pad(candidates.walls, ((0, 0), (0, 1))), numbers,
            )  # fmt: skip
        return _each_option(
            self.kernel.address, candidates.offsets, ends, candidates.positions,
            candidates.targets, candidates.preferred_speeds, candidates.velocities, mine, at,
            numbers,
        )  # fmt: skip


@kept()
def _each_option(
    address: int,
    offsets: NDArray[np.int64],
    ends: NDArray[np.float64],
    starts: NDArray[np.float64],
    targets: NDArray[np.float64],
    preferred: NDArray[np.float64],
    own: NDArray[np.float64],
    mine: NDArray[np.float64],
    fields: NDArray[np.int64],
    numbers: NDArray[np.float64],
) -> NDArray[np.float64]:
    out = np.zeros(ends.shape[1])
    for b in range(len(preferred)):
        at = slice(offsets[b], offsets[b + 1])
        call_option_loop(
            address, offsets[b + 1] - offsets[b], ends[END_X, at], ends[END_Y, at],
            ends[END_UX, at], ends[END_UY, at], ends[SECONDS, at], ends[SPEED, at],
            starts[b, 0], starts[b, 1], targets[b, 0], targets[b, 1], preferred[b], own[b, 0],
            own[b, 1], mine[b], fields, numbers, 1.0, out[at],
        )  # fmt: skip
    return out


@kept()
def _each_pair(
    address: int,
    owner: NDArray[np.int64],
    ends: NDArray[np.float64],
    starts: NDArray[np.float64],
    targets: NDArray[np.float64],
    offsets: NDArray[np.int64],
    others: NDArray[np.float64],
    mine: NDArray[np.float64],
    fields: NDArray[np.int64],
    numbers: NDArray[np.float64],
) -> NDArray[np.float64]:
    out = np.empty(len(owner))
    for k in range(len(owner)):
        b = owner[k]
        at = slice(offsets[b], offsets[b + 1])
        call_pair_loop(
            address, offsets[b + 1] - offsets[b], ends[END_X, k], ends[END_Y, k],
            ends[END_UX, k], ends[END_UY, k], ends[SECONDS, k], ends[SPEED, k],
            starts[b, 0], starts[b, 1], targets[b, 0], targets[b, 1],
            others[OTHER_X, at], others[OTHER_Y, at], others[OTHER_VX, at], others[OTHER_VY, at],
            others[OTHER_EX, at], others[OTHER_EY, at], others[LEAD, at], mine[b],
            others[FIELDS:, offsets[b] :], others.shape[1], fields, numbers, others[COST, at],
        )  # fmt: skip
        summed = 0.0
        for cost in others[COST, at]:
            summed += cost
        out[k] = summed
    return out


@kept()
def _each_wall(
    address: int,
    owner: NDArray[np.int64],
    ends: NDArray[np.float64],
    starts: NDArray[np.float64],
    targets: NDArray[np.float64],
    cores: NDArray[np.float64],
    offsets: NDArray[np.int64],
    walls: NDArray[np.float64],
    numbers: NDArray[np.float64],
) -> NDArray[np.float64]:
    out = np.empty(len(owner))
    for k in range(len(owner)):
        b = owner[k]
        out[k] = call_wall_loop(
            address, offsets[b + 1] - offsets[b], ends[END_X, k], ends[END_Y, k],
            ends[END_UX, k], ends[END_UY, k], ends[SECONDS, k], ends[SPEED, k],
            starts[b, 0], starts[b, 1], targets[b, 0], targets[b, 1], cores[b],
            walls[offsets[b] : offsets[b + 1]], numbers,
        )  # fmt: skip
    return out
