"""The values by which pedestrians are coloured."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import PedestrianModel
from mesa_mobility.dashboard.session.observer import Observer, densities
from mesa_mobility.errors import ModelError


@dataclass(frozen=True)
class Colouring:
    """One way to colour people.

    Attributes:
        label: title of the legend.
        low: value of the scale's first colour, which is dark.
        high: value of its last, bright colour; less than ``low`` where little is a jam. Values
            beyond either end have its colour.
        values: (n,) value of everybody inside, in order of the model's rows.
        by_type: whether values are indices of pedestrian types.
    """

    label: str
    low: float
    high: float
    values: Callable[[PedestrianModel, Observer], NDArray[np.float64]]
    by_type: bool = False

    def legend(self, model: PedestrianModel) -> dict[str, Any]:
        """Colours and legend for the canvas."""
        names = [kind.name for kind in model.pedestrian_types] if self.by_type else []
        return {"label": self.label, "low": self.low, "high": self.high, "names": names}


def _speeds(model: PedestrianModel, _: Observer) -> NDArray[np.float64]:
    return np.hypot(model.crowd.vx[model.rows], model.crowd.vy[model.rows])


def _types(model: PedestrianModel, _: Observer) -> NDArray[np.float64]:
    return model.crowd.type_index[model.rows].astype(np.float64)


COLOURINGS = {
    "speed": Colouring("speed of the movement under way, m/s", 1.8, 0.0, _speeds),
    "type": Colouring("type", 0.0, 1.0, _types, by_type=True),
    "waiting time": Colouring(
        "seconds spent below 0.2 m/s",
        0.0,
        60.0,
        lambda model, observer: observer.waited(model.rows),
    ),
    "density": Colouring(
        "people within 1 m, per m\u00b2", 0.0, 4.0, lambda model, _: densities(model)
    ),
}


def colourings_of(model: PedestrianModel) -> dict[str, Colouring]:
    """The colourings of a model by name: those of every model, and its people's fields."""
    return {**COLOURINGS, **{name: _of_field(model, name) for name in model.crowd.fields}}


def colouring_named(name: str, model: PedestrianModel) -> Colouring:
    """The colouring of this name.

    Raises:
        ModelError: the model has none.
    """
    known = colourings_of(model)
    if name not in known:
        raise ModelError(f"colour_by: got {name!r}, expected one of {', '.join(known)}")
    return known[name]


def _of_field(model: PedestrianModel, name: str) -> Colouring:
    """By a field: false to true, or from its least to its greatest value at the time."""
    now = model.crowd.fields[name][model.rows].astype(np.float64)
    now = now[np.isfinite(now)]
    low, high = 0.0, 1.0
    if model.crowd.fields[name].dtype != np.bool_ and len(now) and now.min() < now.max():
        low, high = float(now.min()), float(now.max())

    def values(model: PedestrianModel, _: Observer) -> NDArray[np.float64]:
        found = model.crowd.fields[name][model.rows].astype(np.float64)
        return np.where(np.isfinite(found), found, low)

    return Colouring(name, low, high, values)
