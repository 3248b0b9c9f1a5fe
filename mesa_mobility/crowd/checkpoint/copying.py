"""Deep copies of a running model."""

from __future__ import annotations

from copy import deepcopy
from typing import TYPE_CHECKING, Any, TypeVar

from mesa_mobility.crowd.people.pedestrian import last_number, number_from
from mesa_mobility.floorplan.occupants import add_occupants

if TYPE_CHECKING:
    from mesa_mobility.crowd.model import PedestrianModel

Model = TypeVar("Model", bound="PedestrianModel")


def copy_model(model: Model, memo: dict[int, Any]) -> Model:
    """An independent copy that continues exactly as the model would.

    Args:
        model: the model.
        memo: copies made so far, as for ``copy.deepcopy``.
    """
    copied = type(model).__new__(type(model))
    memo[id(model)] = copied
    # Its agents go into registers that use their model's number.
    number_from(copied, last_number(model))
    for name, value in vars(model).items():
        copied.__dict__[name] = value if name == "made_with" else deepcopy(value, memo)
    add_occupants(copied.floor_plan, copied.population)
    return copied
