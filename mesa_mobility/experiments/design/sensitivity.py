"""Designs for sensitivity analysis: samples after Saltelli, trajectories after Morris.

SALib draws them: the extra `sensitivity`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from types import ModuleType
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError
from mesa_mobility.experiments.design.designs import (
    Bounds,
    bound_types,
    check_drawn,
    checked_bounds,
    scaled,
)
from mesa_mobility.experiments.design.points import Point, check_whole


@dataclass(frozen=True)
class _Drawn:
    between: Bounds
    seed: int = 0
    bounds: Bounds = field(init=False, repr=False)

    kind: ClassVar[str] = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "bounds", checked_bounds(self.kind, self.between))

    def __len__(self) -> int:
        return len(self.unit)

    def __getitem__(self, index: int) -> Point:
        if not 0 <= index < len(self):
            raise IndexError(index)
        return scaled(self.unit[index], self.bounds)

    def column_types(self) -> dict[str, str]:
        """Name of the Arrow type of each parameter."""
        return bound_types(self.bounds)

    @property
    def problem(self) -> dict[str, Any]:
        """What SALib calls the problem, in the unit cube."""
        names = list(self.bounds)
        return {"num_vars": len(names), "names": names, "bounds": [[0.0, 1.0]] * len(names)}

    def definition(self) -> dict[str, Any]:
        """Bounds and seed."""
        return {"between": {n: list(b) for n, b in self.bounds.items()}, "seed": self.seed}

    @cached_property
    def unit(self) -> NDArray[np.float64]:
        """(points, parameters) in the unit cube."""
        raise NotImplementedError


@dataclass(frozen=True)
class SaltelliSamples(_Drawn):
    """Points for Sobol' indices of first and total order, ``samples * (parameters + 2)`` of them.

    Source: A. Saltelli et al., Variance based sensitivity analysis of model output, Computer
    Physics Communications 181 (2010) 259-270.

    Args:
        between: lowest and highest value by parameter.
        seed: of the draw.
        samples: a power of two.

    Raises:
        ModelError: no parameters, wrong bounds, or a number that is not a power of two.
    """

    kind: ClassVar[str] = "sobol_indices"
    samples: int = 256

    def __post_init__(self) -> None:
        super().__post_init__()
        check_whole("samples", self.samples, 2, math.inf, "a power of two")
        if self.samples & (self.samples - 1):
            raise ModelError(f"samples is {self.samples!r}, expected a power of two")
        check_drawn(self.kind, len(self), self.seed)

    def __len__(self) -> int:
        return self.samples * (len(self.bounds) + 2)

    @cached_property
    def unit(self) -> NDArray[np.float64]:
        """(points, parameters) in the unit cube."""
        salib()
        from SALib.sample import sobol

        return np.asarray(
            sobol.sample(self.problem, self.samples, calc_second_order=False, seed=self.seed)
        )

    def definition(self) -> dict[str, Any]:
        """Bounds, seed and number."""
        return {**super().definition(), "samples": self.samples}


@dataclass(frozen=True)
class MorrisTrajectories(_Drawn):
    """Points for Morris screening, ``trajectories * (parameters + 1)`` of them.

    Source: M. D. Morris, Factorial sampling plans for preliminary computational experiments,
    Technometrics 33 (1991) 161-174.

    Args:
        between: lowest and highest value by parameter.
        seed: of the draw.
        trajectories: through the parameter space.
        levels: an even number of values of each parameter.

    Raises:
        ModelError: no parameters, wrong bounds, or a number out of range.
    """

    kind: ClassVar[str] = "morris"
    trajectories: int = 20
    levels: int = 4

    def __post_init__(self) -> None:
        super().__post_init__()
        check_whole("trajectories", self.trajectories, 2, math.inf, "2 or more")
        check_whole("levels", self.levels, 2, 1000, "an even one from 2 to 1000")
        if self.levels % 2:
            raise ModelError(f"levels is {self.levels!r}, expected an even number")
        check_drawn(self.kind, len(self), self.seed)

    def __len__(self) -> int:
        return self.trajectories * (len(self.bounds) + 1)

    @cached_property
    def unit(self) -> NDArray[np.float64]:
        """(points, parameters) in the unit cube."""
        salib()
        from SALib.sample import morris

        return np.asarray(
            morris.sample(self.problem, self.trajectories, num_levels=self.levels, seed=self.seed)
        )

    def definition(self) -> dict[str, Any]:
        """Bounds, seed and numbers."""
        return {**super().definition(), "trajectories": self.trajectories, "levels": self.levels}


def salib() -> ModuleType:
    """SALib.

    Raises:
        ModelError: SALib is not installed.
    """
    try:
        import SALib
    except ImportError as error:
        raise ModelError(
            "sensitivity analysis needs SALib: pip install 'mesa-mobility[sensitivity]'"
        ) from error
    return SALib
