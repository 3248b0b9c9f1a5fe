"""Filling rooms with people, by number, density or use."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.crowd.insertion.newcomers import draw_column
from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.crowd.people.pedestrian import Pedestrian
from mesa_mobility.distributions import Distribution, parse
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.floorplan import Room
from mesa_mobility.floorplan.rooms.loads import Load, fits, occupant_numbers

AFTER = " after "
"""What stands between a load and the time before people set off."""

EVERY = "*"
"""The pattern that fits every room."""

PreMovement = float | Distribution


def fill(
    model: CrowdModel,
    rooms: str | Iterable[str | Room] | Mapping[str, Load] | None = None,
    load: Load = None,
    *,
    pre_movement: PreMovement | Mapping[str, PreMovement] = 0.0,
    spacing: float = 0.5,
    clearance: float = 0.3,
    **who: Any,
) -> dict[str, list[Pedestrian]]:
    """Put people at random places of rooms, as many as each of them holds.

    Args:
        rooms: names of rooms, or patterns such as "office*"; rooms; or a load for each pattern,
            of which a room gets the first one that fits; by default all rooms.
        load: a number of people in all these rooms, shared by area; a density such as "0.5/m2"; the
            space of each person, "10 m2"; or a use, "office" or "nfpa101:office". By default each
            room gets the load of its own use, and those without one are left empty.
            `occupant_numbers` says how numbers are rounded.
        pre_movement: seconds before people set off, or a distribution of them; or these by name or
            pattern of a room, of which the first one counts that fits, and 0 if none does.
        spacing: least distance of people to each other, metres.
        clearance: least distance to walls and exits, metres.
        who: further arguments of ``add_pedestrians``, such as ``exits`` or ``population``, that
            hold for all these people.

    Returns:
        The people of each room, by its name; only rooms that are not left empty.

    Raises:
        FloorPlanError: no such room or use, a load out of range, or too little room in a room.
        ModelError: what ``add_pedestrians`` refuses.
    """
    floor = model.building or model.floor_plan
    loads = _loads(rooms, load)
    numbers = [(room, n) for room, n in occupant_numbers(floor.rooms, loads) if n > 0]
    places, waits = np.empty((0, 2)), []
    for room, n in numbers:
        found = _places(model, room, n, places, spacing, clearance)
        places = np.concatenate([places, found])
        given = _of_room(room, pre_movement)
        waits.append(draw_column(f"pre_movement of {room.name!r}", given, n, model.rng))
    people = model.add_pedestrians(
        places, pre_movement=np.concatenate([np.empty(0), *waits]), **who
    )
    ends = np.cumsum([0, *(n for _, n in numbers)]).tolist()
    return {
        room.name: people[first:last]
        for (room, _), first, last in zip(numbers, ends, ends[1:], strict=False)
    }


def fill_as(model: CrowdModel, text: str, pre_movement: PreMovement = 0.0) -> None:
    """Fill rooms as a text says, such as ``hall=120; office*=office after uniform(0, 30)``.

    Args:
        text: loads with semicolons between them, each after the name of a room or a pattern and =.
            Without these it holds for all rooms. After the word ``after`` stands the time before
            people set off, a number or a distribution.
        pre_movement: the time of people for whom the text has none.

    Raises:
        FloorPlanError: see ``fill``.
        ModelError: a text that cannot be read, or what ``fill`` refuses.
    """
    loads: dict[str, Load] = {}
    waits: dict[str, PreMovement] = {}
    for part in text.split(";"):
        what, _, wait = part.partition(AFTER)
        pattern, equals, load = (each.strip() for each in what.partition("="))
        if not equals:
            pattern, load = EVERY, pattern
        if not pattern or not load or pattern in loads:
            raise ModelError(
                f"fill: got {part.strip()!r:.60}, expected ROOM=LOAD once for each room, such as "
                "'hall=120; office*=office after uniform(0, 30)'"
            )
        loads[pattern] = load
        waits[pattern] = parse(wait) if wait else pre_movement
    fill(model, loads, pre_movement=waits)


def _loads(
    rooms: str | Iterable[str | Room] | Mapping[str, Load] | None, load: Load
) -> Mapping[str, Load]:
    if isinstance(rooms, Mapping):
        if load is not None:
            raise ModelError("fill: got loads by room and another load, expected one of them")
        return rooms
    named = [EVERY] if rooms is None else [rooms] if isinstance(rooms, str | Room) else list(rooms)
    if len(named) == 1 or not isinstance(load, int):
        return dict.fromkeys((str(getattr(each, "name", each)) for each in named), load)
    raise ModelError(
        "fill: got a number of people for several rooms, expected a pattern that fits them, or a "
        "number for each"
    )


def _of_room(
    room: Room, given: PreMovement | Mapping[str, PreMovement]
) -> ArrayLike | Distribution:
    if isinstance(given, Mapping):
        return next((each for pattern, each in given.items() if fits(room, pattern)), 0.0)
    return given


def _places(
    model: CrowdModel,
    room: Room,
    n: int,
    taken: NDArray[np.float64],
    spacing: float,
    clearance: float,
) -> NDArray[np.float64]:
    """(n, 2) places in a room in the plane of the model, metres, away from those taken."""
    building = model.building
    corners = np.array(room.shape.bounds).reshape(2, 2)
    if building is not None:
        corners = building.places(corners, room.level)
    crowd, rows = model.crowd, model.population.present
    others = np.concatenate([taken, np.column_stack([crowd.x[rows], crowd.y[rows]])])
    near = others[((others > corners[0] - spacing) & (others < corners[1] + spacing)).all(axis=1)]
    keep: dict[str, Any] = {"spacing": spacing, "clearance": clearance, "avoid": near}
    try:
        if building is not None:
            return building.random_points(n, model.rng, level=room.level, within=room.shape, **keep)
        return model.floor_plan.random_points(n, model.rng, within=room.shape, **keep)
    except FloorPlanError as error:
        said = str(error).removeprefix("the floor plan leaves ")
        raise FloorPlanError(f"room {room.name!r}: {said}") from None
