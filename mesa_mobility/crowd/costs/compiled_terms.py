"""Cost terms that are kernels, evaluated inside the compiled search."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import kept
from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.costs.kernel_calls import (
    call_option_loop,
    call_pair_loop,
    call_wall_loop,
)
from mesa_mobility.crowd.costs.kernels import CostKernel, PairKernel, WallKernel
from mesa_mobility.crowd.costs.layout import COST, FIELDS
from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.output import numbers_given
from mesa_mobility.plugins.registry import did_you_mean


class CompiledTerm(CostTerm):
    """A term given as a kernel, evaluated inside the compiled search.

    A kernel reads the term's attributes by ``p``: ``p.width`` is the setting ``width``, another
    attribute or a property. They may change while a model runs.

    Attributes:
        kernel: an ``option_kernel``, which counts for the worst wall if it asks for ``wall``, or a
            ``pair_kernel``, which is summed over the neighbours. Those over walls and neighbours
            must never be negative: the other terms are then a lower bound of the sum, and they are
            evaluated only for options that can still win.
        walls: an ``option_kernel`` that asks for ``wall``, beside another ``kernel``: an option
            costs the sum of both.
        bound: a lower bound of an option kernel: an ``option_kernel`` that asks for ``options``.
            Without one, every term is evaluated for all options, not only for those that can still
            win.
    """

    kernel: ClassVar[CostKernel]
    walls: ClassVar[CostKernel | None] = None
    bound: ClassVar[CostKernel | None] = None

    @classmethod
    def kernels(cls) -> list[CostKernel]:
        """Those whose costs are summed."""
        return [cls.kernel] if cls.walls is None else [cls.kernel, cls.walls]

    def cost(self, candidates: Candidates) -> NDArray[np.float64]:
        """Cost of each option, by calling the kernels on each row."""
        costs = [self._cost(kernel, candidates) for kernel in self.kernels()]
        return costs[0] if len(costs) == 1 else costs[0] + costs[1]

    def _cost(self, kernel: CostKernel, of: Candidates) -> NDArray[np.float64]:
        directions = [np.cos(of.headings), np.sin(of.headings)]
        ends = np.array([*of.points.T, *directions, of.durations, of.speeds])
        own = np.column_stack(
            [
                of.positions,
                of.targets,
                of.preferred_speeds,
                of.velocities,
                of.cores,
                nearest_ahead(of),
                *(of.field(name) for name in kernel.fields),
            ]
        )
        at = np.arange(FIELDS, own.shape[1] + 1)
        numbers = checked_numbers(self, kernel)
        if isinstance(kernel, PairKernel):
            others = np.array(
                [
                    *of.neighbour_positions.T,
                    *of.neighbour_velocities.T,
                    *of.neighbour_directions.T,
                    of.leads,
                    np.empty_like(of.leads),
                    np.empty_like(of.leads),
                    *(of.neighbour_field(name) for name in kernel.fields),
                ]
            )
            offsets = of.neighbour_offsets
            return _each_pair(kernel.address, of.owner, ends, offsets, others, own, at, numbers)
        if isinstance(kernel, WallKernel):
            offsets = of.wall_offsets
            return _each_wall(kernel.address, of.owner, ends, offsets, of.walls, own, at, numbers)
        return _each_option(kernel.address, of.offsets, ends, own, at, numbers)


def nearest_ahead(of: Candidates) -> NDArray[np.float64]:
    """(b,) metres to the nearest neighbour on the side of the target; inf without any."""
    counts = np.diff(of.neighbour_offsets)
    whose = np.repeat(np.arange(len(counts)), counts)
    there = of.neighbour_positions - of.positions[whose]
    ahead = (there * (of.targets - of.positions)[whose]).sum(axis=1) > 0.0
    nearest = np.full(len(counts), np.inf)
    np.minimum.at(nearest, whose[ahead], np.hypot(*there[ahead].T))
    return nearest


def numbers_of(term: CompiledTerm, kernel: CostKernel) -> list[Any]:
    """The attributes of a term that a kernel reads by ``p``.

    Raises:
        ModelError: the term does not have one of them.
    """
    for name in kernel.numbers:
        if not hasattr(term, name):
            known = dict.fromkeys(each for each in dir(term) if not each.startswith("_"))
            raise ModelError(
                f"behaviour {term.name!r}: its kernel reads p.{name}, but it has no attribute "
                f"{name!r}{did_you_mean(name, known)}"
            )
    return [getattr(term, name) for name in kernel.numbers]


def checked_numbers(term: CompiledTerm, kernel: CostKernel) -> NDArray[np.float64]:
    """The numbers of ``numbers_of`` as an array, with one more at the end that nothing reads.

    Raises:
        ModelError: an attribute that is no number.
    """
    giver, names = f"behaviour {term.name!r}", kernel.numbers
    numbers = np.zeros(len(names) + 1)
    for at, (name, value) in enumerate(zip(names, numbers_of(term, kernel), strict=True)):
        numbers[at] = numbers_given(giver, f"p.{name}", value, ())
    return numbers


@kept()
def _each_option(
    address: int,
    offsets: NDArray[np.int64],
    ends: NDArray[np.float64],
    own: NDArray[np.float64],
    at: NDArray[np.int64],
    numbers: NDArray[np.float64],
) -> NDArray[np.float64]:
    out = np.zeros(ends.shape[1])
    for b in range(len(own)):
        first, last = offsets[b], offsets[b + 1]
        call_option_loop(
            address, (last - first, ends[:, first:], own[b], at, numbers, 1.0, out[first:])
        )
    return out


@kept()
def _each_pair(
    address: int,
    owner: NDArray[np.int64],
    ends: NDArray[np.float64],
    offsets: NDArray[np.int64],
    others: NDArray[np.float64],
    own: NDArray[np.float64],
    at: NDArray[np.int64],
    numbers: NDArray[np.float64],
) -> NDArray[np.float64]:
    out = np.empty(len(owner))
    for k in range(len(owner)):
        b = owner[k]
        first, last = offsets[b], offsets[b + 1]
        costs = others[COST, first:last]
        call_pair_loop(
            address, (last - first, ends[:, k:], others[:, first:], own[b], at, numbers, costs)
        )
        summed = 0.0
        for cost in costs:
            summed += cost
        out[k] = summed
    return out


@kept()
def _each_wall(
    address: int,
    owner: NDArray[np.int64],
    ends: NDArray[np.float64],
    offsets: NDArray[np.int64],
    walls: NDArray[np.float64],
    own: NDArray[np.float64],
    at: NDArray[np.int64],
    numbers: NDArray[np.float64],
) -> NDArray[np.float64]:
    out = np.empty(len(owner))
    for k in range(len(owner)):
        b = owner[k]
        first, last = offsets[b], offsets[b + 1]
        out[k] = call_wall_loop(
            address, (last - first, ends[:, k:], walls[first:], own[b], at, numbers)
        )
    return out
