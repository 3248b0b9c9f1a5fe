"""Places in buildings: true coordinates for clients, the plane of sheets for the model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd import PedestrianModel
from mesa_mobility.crowd.lifts.lifts import NOBODY
from mesa_mobility.errors import LiveError
from mesa_mobility.live.fields import shown


class Where(NamedTuple):
    """Where n people are.

    Attributes:
        x: (n,) metres.
        y: (n,) metres.
        z: (n,) metres in a building, otherwise None.
        level: (n,) numbers of levels, or ``ON_STAIRS``, in a building, otherwise None.
    """

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    z: NDArray[np.float64] | None = None
    level: NDArray[np.int16] | None = None


def where(model: PedestrianModel, rows: NDArray[np.int64]) -> Where:
    """Where the people in ``rows`` are, in true coordinates."""
    crowd, building = model.crowd, model.building
    x, y = crowd.x[rows], crowd.y[rows]
    if building is None:
        return Where(x, y)
    points = np.column_stack([x, y])
    places, levels = building.true_places(points)
    z = places[:, 2] + model.lifts.log.risen(np.full(len(rows), model.frame), points)
    return Where(places[:, 0], places[:, 1], z, levels)


def in_plane(
    model: PedestrianModel,
    field: str,
    places: Sequence[tuple[float, float]],
    level: int | None,
) -> NDArray[np.float64]:
    """(n, 2) points, metres, at which a model has the places that a command names.

    Args:
        model: the model.
        field: of the command, for errors.
        places: n of them, x and y in metres.
        level: on which they are; None in a model of one level.

    Raises:
        LiveError: no level, or one that the building does not have; a level where there is but one;
            a place that is not on the floor of its level.
    """
    building, given = model.building, np.array(places, dtype=np.float64)
    if building is None:
        if level is not None:
            raise LiveError(f"level: got {shown(level)}, expected none: the model has one level")
        return given
    known = [each.number for each in building.levels]
    if level not in known:
        got = "missing" if level is None else f"got {shown(level)}"
        raise LiveError(f"level: {got}, expected one of {', '.join(map(str, known))}")
    points = building.places(given, level)
    on = building.true_places(points)[1] == level
    on &= model.floor_plan.contains(points) & (model.lifts.car_of(points) == NOBODY)
    if not on.all():
        x, y = given[np.argmin(on)].tolist()
        raise LiveError(
            f"{field}: ({x:g}, {y:g}) is not on level {level}, expected a place on its floor, off "
            "stairs and lifts"
        )
    return points


def in_true_places(
    message: str, points: NDArray[np.float64], places: Sequence[tuple[float, float]]
) -> str:
    """A message of the model about one of (n, 2) points in its plane, with the place that a command
    has named instead."""
    for (x, y), (true_x, true_y) in zip(points.tolist(), places, strict=True):
        for form in ("[{}, {}]", "({:.2f}, {:.2f})"):
            if form.format(x, y) in message:
                return message.replace(form.format(x, y), form.format(true_x, true_y))
    return message
