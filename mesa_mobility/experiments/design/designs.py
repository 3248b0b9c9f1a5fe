"""Designs: which points of the parameter space an experiment runs.

A design gives its points one by one, so that a million of them take no more memory than a table of
numbers.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError
from mesa_mobility.experiments.design.points import (
    ARROW_TYPES,
    Point,
    Value,
    check_whole,
    plain_value,
)

Bounds: TypeAlias = Mapping[str, tuple[float, float]]

MOST_POINTS = 10_000_000


class Design(Protocol):
    """Points of the parameter space, in their order."""

    kind: ClassVar[str]
    """Name of the design in a file."""

    def __len__(self) -> int: ...

    def __getitem__(self, index: int) -> Point: ...

    def column_types(self) -> dict[str, str]:
        """Name of the Arrow type of each parameter that varies."""

    def definition(self) -> Any:
        """What a file says of the design."""


@dataclass(frozen=True)
class Grid:
    """All combinations of values; the last parameter changes fastest.

    Args:
        values: values by parameter.

    Raises:
        ModelError: a parameter without values, with a value twice, or one that cannot be kept.
    """

    kind: ClassVar[str] = "grid"
    values: Mapping[str, Sequence[Value]]

    def __post_init__(self) -> None:
        checked: dict[str, list[Value]] = {}
        for name, values in self.values.items():
            if isinstance(values, str | Mapping) or not hasattr(values, "__iter__"):
                several: Sequence[Any] = [values]
            else:
                several = values
            checked[name] = [plain_value(name, value) for value in several]
            if not checked[name]:
                raise ModelError(f"grid: {name} has no values, expected one or more")
            if len(set(checked[name])) < len(checked[name]):
                raise ModelError(f"grid: {name} has a value twice")
        object.__setattr__(self, "values", checked)
        _check_count(self.kind, len(self))

    def __len__(self) -> int:
        return math.prod(len(values) for values in self.values.values())

    def __getitem__(self, index: int) -> Point:
        _check_index(index, self)
        point: Point = {}
        for name, values in reversed(list(self.values.items())):
            index, at = divmod(index, len(values))
            point[name] = values[at]
        return dict(reversed(list(point.items())))

    def column_types(self) -> dict[str, str]:
        """Name of the Arrow type of each parameter."""
        return {name: _type_of(name, values) for name, values in self.values.items()}

    def definition(self) -> dict[str, Any]:
        """The values by parameter."""
        return {name: list(values) for name, values in self.values.items()}


@dataclass(frozen=True)
class Table:
    """Points given one by one.

    Args:
        rows: points, all with the same parameters.

    Raises:
        ModelError: no points, a point with other parameters than the first, or a point twice.
    """

    kind: ClassVar[str] = "table"
    rows: Sequence[Mapping[str, Value]]

    def __post_init__(self) -> None:
        rows = []
        for number, row in enumerate(self.rows, start=1):
            if not isinstance(row, Mapping):
                raise ModelError(f"table: point {number} is {row!r}, expected values by parameter")
            rows.append({name: plain_value(name, value) for name, value in row.items()})
        _check_count(self.kind, len(rows))
        for number, row in enumerate(rows, start=1):
            if set(row) != set(rows[0]):
                raise ModelError(
                    f"table: point {number} has {', '.join(row) or 'no parameters'}, expected "
                    f"{', '.join(rows[0])} as the first"
                )
        if len({tuple(sorted(row.items(), key=lambda item: item[0])) for row in rows}) < len(rows):
            raise ModelError("table: has a point twice")
        object.__setattr__(self, "rows", rows)

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, index: int) -> Point:
        _check_index(index, self)
        return dict(self.rows[index])

    def column_types(self) -> dict[str, str]:
        """Name of the Arrow type of each parameter."""
        return {name: _type_of(name, [row[name] for row in self.rows]) for name in self.rows[0]}

    def definition(self) -> list[dict[str, Any]]:
        """The points."""
        return [dict(row) for row in self.rows]


@dataclass(frozen=True)
class Sampled:
    """Points drawn between bounds; base of the designs that draw them.

    A parameter whose bounds are both whole numbers takes whole numbers, both bounds included.

    Args:
        between: lowest and highest value by parameter.
        points: number of points.
        seed: of the draw.

    Raises:
        ModelError: no parameters, bounds that are not finite or not in order, no points, or a
            seed below 0.
    """

    kind: ClassVar[str] = "sampled"
    between: Bounds
    points: int
    seed: int = 0
    bounds: Bounds = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "bounds", checked_bounds(self.kind, self.between))
        check_drawn(self.kind, self.points, self.seed)

    def __len__(self) -> int:
        return self.points

    def __getitem__(self, index: int) -> Point:
        _check_index(index, self)
        return scaled(self._unit[index], self.bounds)

    def column_types(self) -> dict[str, str]:
        """Name of the Arrow type of each parameter."""
        return bound_types(self.bounds)

    def definition(self) -> dict[str, Any]:
        """Bounds, number and seed."""
        return {
            "between": {n: list(b) for n, b in self.bounds.items()},
            "points": self.points,
            "seed": self.seed,
        }

    @cached_property
    def _unit(self) -> NDArray[np.float64]:
        """(points, parameters) in the unit cube."""
        raise NotImplementedError


@dataclass(frozen=True)
class LatinHypercube(Sampled):
    """A Latin hypercube; another number of points gives other points."""

    kind: ClassVar[str] = "latin_hypercube"

    @cached_property
    def _unit(self) -> NDArray[np.float64]:
        from scipy.stats import qmc

        drawn = qmc.LatinHypercube(len(self.bounds), seed=np.random.default_rng(self.seed))
        return np.asarray(drawn.random(self.points))


@dataclass(frozen=True)
class SobolSequence(Sampled):
    """A scrambled Sobol' sequence; more points leave the first ones as they are.

    Powers of two are balanced; other numbers of points are allowed.
    """

    kind: ClassVar[str] = "sobol"

    @cached_property
    def _unit(self) -> NDArray[np.float64]:
        from scipy.stats import qmc

        drawn = qmc.Sobol(len(self.bounds), seed=np.random.default_rng(self.seed))
        return np.asarray(drawn.random_base2(math.ceil(math.log2(self.points)))[: self.points])


def scaled(unit: NDArray[np.float64], bounds: Bounds) -> Point:
    """The point between bounds that a (parameters,) place in the unit cube stands for."""
    point: Point = {}
    for share, (name, (low, high)) in zip(unit.tolist(), bounds.items(), strict=True):
        if isinstance(low, int) and isinstance(high, int):
            point[name] = min(low + math.floor(share * (high - low + 1)), high)
        else:
            point[name] = float(low + share * (high - low))
    return point


def checked_bounds(kind: str, between: Bounds) -> dict[str, tuple[float, float]]:
    """Bounds of a design, checked.

    Raises:
        ModelError: none, or bounds that are not two finite numbers in order.
    """
    if not isinstance(between, Mapping) or not between:
        raise ModelError(f"{kind}: has no parameters, expected bounds of one or more")
    checked: dict[str, tuple[float, float]] = {}
    for name, pair in between.items():
        numbers = [plain_value(name, value) for value in pair] if hasattr(pair, "__iter__") else []
        if len(numbers) != 2 or any(
            isinstance(n, bool) or not isinstance(n, int | float) for n in numbers
        ):
            raise ModelError(f"{kind}: {name} is {pair!r}, expected a lowest and a highest number")
        low, high = numbers
        assert isinstance(low, int | float)
        assert isinstance(high, int | float)
        if not low < high:
            raise ModelError(f"{kind}: {name} is from {low} to {high}, expected rising bounds")
        checked[name] = (low, high)
    return checked


def check_drawn(kind: str, points: Any, seed: Any) -> None:
    """Raise ModelError unless a design may have this number of points, drawn with this seed."""
    _check_count(kind, points)
    check_whole(f"{kind}: seed", seed, 0, 2**63 - 1, "0 or more")


def bound_types(bounds: Bounds) -> dict[str, str]:
    """Name of the Arrow type of each parameter between bounds."""
    return {
        name: "int64" if isinstance(low, int) and isinstance(high, int) else "double"
        for name, (low, high) in bounds.items()
    }


def _type_of(name: str, values: Sequence[Value]) -> str:
    types = {type(value) for value in values if value is not None}
    if types == {int, float}:
        types = {float}
    if len(types) > 1:
        raise ModelError(
            f"parameter {name}: has values of the types "
            f"{' and '.join(sorted(each.__name__ for each in types))}, expected one type"
        )
    return ARROW_TYPES[types.pop()] if types else "string"


def _check_count(kind: str, count: int) -> None:
    if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= MOST_POINTS:
        raise ModelError(f"{kind}: got {count!r} points, expected 1 to {MOST_POINTS:,}")


def _check_index(index: int, design: Design) -> None:
    if not 0 <= index < len(design):
        raise IndexError(index)
