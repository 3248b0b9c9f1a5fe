"""The methods of a model that say who is in whose way."""

from __future__ import annotations

from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.crowd.running.blocking import Blockers


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
