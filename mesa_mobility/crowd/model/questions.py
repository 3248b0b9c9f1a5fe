"""The methods of a model that say what people do, why, and who is in whose way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.crowd.planning.explanation import Explanation
from mesa_mobility.crowd.running.blocking import Blockers
from mesa_mobility.crowd.running.recorder import movements_under_way
from mesa_mobility.errors import ModelError


def decided(model: CrowdModel, since: int = 0) -> dict[str, NDArray[np.generic]] | None:
    """The decisions from frame ``since`` on, as ``DecisionRecorder.arrays``.

    None if the model does not record decisions.
    """
    if model.decisions is None:
        return None
    return model.decisions.arrays(model._scene, since)


def under_way(model: CrowdModel) -> dict[str, NDArray[np.generic]]:
    """The movement of everybody inside now, as arrays like those of ``decided``.

    Entry k belongs to the person ``rows[k]`` of the model, and ``frame`` is when the movement
    began. This works without recorded decisions, too.
    """
    return movements_under_way(model.crowd, model.rows, model._scene)


def explain(model: CrowdModel, row: int) -> Explanation:
    """The decision of the person in ``row`` if they decided now, before all others.

    They keep the target of their last decision. Set ``watch`` to have decisions as they are taken.

    Raises:
        ModelError: nobody inside has this row, or an escalator carries the person.
    """
    model.check_inside(row)
    if len(model.escalators) and len(model.escalators.riders(np.array([row]))):
        raise ModelError(f"pedestrian {row}: decides nothing while an escalator carries them")
    return model.dynamics.explain(row)


def blocked_by(model: CrowdModel, row: int) -> list[int]:
    """A chain of people, each in the way of the one before; the first is in the way of ``row``.

    A is in the way of B if B has made no progress for 5 s, and would hit A first with the movement
    that B would take alone (see ``wishes``). The chain ends with somebody who gets on, who waits on
    purpose, or who has nobody in their way. If the people block each other in a ring, the chain
    ends with the first of them who comes up again: ``[4, 0]`` for the person in row 0 says that 0
    and 4 block each other; ``[4, 7, 4]`` says that 4 and 7 do, and 4 is in the way of 0.

    Returns:
        Rows; none if the person gets on, waits or has nobody in their way.

    Raises:
        ModelError: nobody inside has this row.
    """
    model.check_inside(row)
    model.bind()
    return Blockers(model, model._standing_watch.minute).chain(row)
