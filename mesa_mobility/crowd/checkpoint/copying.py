"""Deep copies of a running model, and why there are no others."""

from __future__ import annotations

from copy import deepcopy
from typing import Any, TypeVar

from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.crowd.people.pedestrian import last_number, number_from
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan.occupants import add_occupants

Model = TypeVar("Model", bound="CrowdModel")


def copy_model(model: Model, memo: dict[int, Any]) -> Model:
    """An independent copy that continues exactly as the model would.

    Both share the mobility map and compiled code, which neither changes.

    Args:
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


def refuse_to_pickle(model: CrowdModel, protocol: Any) -> Any:
    """Raise ModelError: a model holds what no pickle can, such as compiled code."""
    raise ModelError(
        f"{type(model).__name__}: a model can be copied by copy.deepcopy, neither by copy.copy "
        "nor by pickle; expected its parameters and seed, which make it anew"
    )
