"""What is known of each person besides its place."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.distributions import Distribution


def describe_people(model: CrowdModel) -> dict[str, ArrayLike]:
    """What trajectories say of each person besides its place; models may add to it.

    Returns:
        (n,) ``type`` and ``group``, names, of everybody who has ever been in the model, by row.
        The group is an empty text for people without one. Where a type's core radii are drawn
        from a distribution, ``core_radius``, metres, as well.
    """
    crowd, count = model.crowd, model.population.count
    types = np.array([kind.name for kind in model.pedestrian_types])
    groups = np.array(["", *map(str, model.population.groups)])
    data: dict[str, ArrayLike] = {
        "type": types[crowd.type_index[:count]],
        "group": groups[crowd.agenda["group"][:count]],
    }
    if any(isinstance(kind.core_radius, Distribution) for kind in model.pedestrian_types):
        data["core_radius"] = model.core_radii
    return data
