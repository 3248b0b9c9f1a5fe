"""Cost terms: behaviours that rank movement options.

The cost of a movement option is the weighted sum of its terms (equation 1 of the paper).  A
behaviour is one more term.  A term gets all options of all deciding pedestrians and returns one
number for each.  Terms are independent of one another, so their order does not matter.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
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
from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.errors import ModelError

MOST_WEIGHT = 1e9
"""Largest weight of a term, either way.  Beyond it no other term counts, and sums overflow."""


def is_weight(value: float) -> bool:
    """Whether the number can be the weight of a term."""
    return bool(abs(value) <= MOST_WEIGHT)


EXPECTED_WEIGHT = f"a finite number, {MOST_WEIGHT:.0e} at most either way"


def _checked_weight(of: str, value: float) -> float:
    """The weight, or one error that names what it is of."""
    if not is_weight(value):
        raise ModelError(f"weight of {of}: got {value}, expected {EXPECTED_WEIGHT}")
    return float(value)


class CostTerm(Plugin):
    """One additive term of the cost of a movement option.

    Subclasses set ``name`` and define ``cost``.  The engine multiplies by ``weight``.

    Attributes:
        name: unique name of the term, as it is registered and shown.
        weight: factor of the term in the sum; may be changed while a model runs.
        weight_by_type: factors for people of some types, as ``{"child": 0.0}``; 0 switches the
            term off for them.
        for_types: names of the types whose people alone have the term, as ``["child"]``; None, by
            default, for everybody. Terms of one name may have different parameters for different
            types.

    Examples:
        >>> import numpy as np
        >>> from mesa_mobility import CostTerm
        >>> class StraightOn(CostTerm):
        ...     name = "straight_on"
        ...
        ...     def cost(self, candidates):
        ...         turn = candidates.headings - candidates.facings[candidates.owner]
        ...         return np.abs(np.angle(np.exp(1j * turn)))
        >>> term = StraightOn(weight=0.5)
        >>> term.name, term.weight
        ('straight_on', 0.5)
    """

    default_weight: ClassVar[float] = 1.0

    _by_type: Mapping[str, float] = MappingProxyType({})
    _for_types: tuple[str, ...] | None = None

    def __init__(self, weight: float | None = None) -> None:
        self.weight = self.default_weight if weight is None else weight

    @property
    def _called(self) -> str:
        """The name, or that of the class: a term without a name is refused later."""
        return getattr(self, "name", type(self).__name__)

    @property
    def weight(self) -> float:
        """Factor of this term in the sum."""
        return self._weight

    @weight.setter
    def weight(self, value: float) -> None:
        self._weight = _checked_weight(repr(self._called), value)

    @property
    def weight_by_type(self) -> Mapping[str, float]:
        """Factors for people of some types, by the types' names, in place of ``weight``."""
        return MappingProxyType(dict(self._by_type))

    @weight_by_type.setter
    def weight_by_type(self, weights: Mapping[str, float]) -> None:
        self._by_type = {
            name: _checked_weight(f"{self._called!r} for {name!r}", value)
            for name, value in weights.items()
        }

    @property
    def for_types(self) -> tuple[str, ...] | None:
        """Names of the types whose people alone have the term; None for everybody."""
        return self._for_types

    @for_types.setter
    def for_types(self, names: Iterable[str] | None) -> None:
        if isinstance(names, str):
            raise ModelError(
                f"for_types of {self.name!r}: got {names!r}, expected a list such as [{names!r}]"
            )
        self._for_types = None if names is None else tuple(dict.fromkeys(names))

    def is_for(self, type_name: str) -> bool:
        """Whether people of the type of this name have the term."""
        return self._for_types is None or type_name in self._for_types

    def weights(self, types: Sequence[str]) -> NDArray[np.float64]:
        """(types,) the factor for people of each of a model's types, given by their names.

        It is 0 for types that do not have the term.

        Raises:
            ModelError: a weight for a type that the model does not have, or a term for one.
        """
        for what, names in (("has a weight", self._by_type), ("is", self._for_types or ())):
            unknown = [name for name in names if name not in types]
            if unknown:
                raise ModelError(
                    f"behaviour {self.name!r}: {what} for the type {unknown[0]!r}; the model has "
                    f"{', '.join(types)}"
                )
        return np.array(
            [self._by_type.get(name, self.weight) if self.is_for(name) else 0.0 for name in types]
        )

    @abstractmethod
    def cost(self, candidates: Candidates) -> NDArray[np.float64]:
        """Cost of each option, without the weight.

        Args:
            candidates: options of any number of pedestrians.

        Returns:
            (n,) one finite number per option.
        """


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
