"""The methods of a model that say what people do, why, and who is in whose way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.crowd.planning.explanation import Explanation
from mesa_mobility.crowd.running.blocking import Blockers
from mesa_mobility.crowd.running.recorder import movements_under_way


def decided(model: CrowdModel, since: int = 0) -> dict[str, NDArray[np.generic]] | None:
    """The decisions from frame ``since`` on, see ``DecisionRecorder.arrays``; None if they are not
    recorded."""
    if model.decisions is None:
        return None
    return model.decisions.arrays(model._scene.repertoire, since)


def under_way(model: CrowdModel) -> dict[str, NDArray[np.generic]]:
    """What everybody inside is doing now: an entry for each of ``rows``, otherwise as
    ``decided``."""
    return movements_under_way(model.crowd, model.rows, model._scene.repertoire)


def explain(model: CrowdModel, row: int) -> Explanation:
    """The decision of the person in ``row`` if they decided now, before all others.

    They keep the target of their last decision. Set ``watch`` to have decisions as they are taken.

    Raises:
        ModelError: nobody inside has this row.
    """
    model.check_inside(row)
    return model.dynamics.explain(row)


def blocked_by(model: CrowdModel, row: int) -> list[int]:
    """The people of whom each is in the way of the one before, beginning with whoever is in the way
    of the person in ``row``.

    Somebody is in the way of another if that one has made no progress for 5 s, and would hit them
    first with what they would do alone (``wishes``). The chain ends with somebody who gets on, who
    waits on purpose, or who has nobody in their way. If the people block each other in a ring, it
    ends with the first of them who comes up again: ``[4, 0]`` for the person in row 0 says that 0
    and 4 block each other; ``[4, 7, 4]``, that 4 and 7 do, and 4 is in the way of 0.

    Returns:
        Rows; none if the person gets on, waits or has nobody in their way.

    Raises:
        ModelError: nobody inside has this row.
    """
    model.check_inside(row)
    model.bind()
    return Blockers(model, model._standing_watch.minute).chain(row)
