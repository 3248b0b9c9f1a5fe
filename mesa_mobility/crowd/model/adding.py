"""Adding people to a model: at once, or over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from numpy.typing import ArrayLike

from mesa_mobility.crowd.doors.door import Door
from mesa_mobility.crowd.doors.doors import DoorControl
from mesa_mobility.crowd.insertion.inflow import Inflow
from mesa_mobility.crowd.insertion.newcomers import Newcomers
from mesa_mobility.crowd.insertion.source import Source
from mesa_mobility.crowd.journeys.visit import Route
from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.crowd.people.pedestrian import Pedestrian
from mesa_mobility.crowd.types.pedestrian_type import PedestrianType
from mesa_mobility.distributions import Distribution
from mesa_mobility.populations import Population


def add_pedestrians(
    model: CrowdModel,
    positions: ArrayLike,
    *,
    headings: ArrayLike | None = None,
    preferred_speeds: ArrayLike | Distribution | None = None,
    pre_movement: ArrayLike | Distribution = 0.0,
    exits: Sequence[str] | None = None,
    route: Route = (),
    loop: bool = False,
    group: str | int | None = None,
    type_index: ArrayLike | None = None,
    population: Population | Mapping[str | PedestrianType, float] | str | None = None,
    fields: Mapping[str, ArrayLike] | None = None,
) -> list[Pedestrian]:
    """Put people on the floor of a model, standing.

    Args:
        positions: (n, 2) metres, on free floor, with room for the body between walls.
        headings: (n,) radians; by default everybody faces their first target.
        preferred_speeds: (n,) m/s or a distribution; by default drawn from the type.
        pre_movement: (n,) seconds, or a distribution of them, for which they stand before they
            set off; their first decision is in the first frame after that.
        exits: names of the exits by which they may leave; by default all.
        route: names of gates that they cross, in either direction, and places that they visit
            (``Visit``), in this order, before they leave.
        loop: whether the route starts over after its last stop, and they never leave. On a
            closed track three gates or more determine the direction.
        group: name or number of the group that they join.
        type_index: index of their type in ``pedestrian_types``, or (n,) of them; by default
            types are drawn from ``population``.
        population: the shares of types, of which each gets its share of n, rounded up or down;
            by default those of the model, or the first type alone. Positions are exchanged so
            that wide people stand where they have room and a way out.
        fields: (n,) values of fields that the model declares; 0 or false by default.

    Raises:
        ModelError: positions off the floor, too near to a wall, or where somebody is or will
            be; an unknown type; arrays of the wrong length; numbers out of range; shares that
            do not add up to 1, or too few places for people of a wide type.
        FloorPlanError: an unknown exit or gate, a place to visit without room for their bodies,
            or no way from a position to any exit, or to the route's first stop, or on from one.
    """
    new = Newcomers(
        headings=headings,
        preferred_speeds=preferred_speeds,
        pre_movement=pre_movement,
        exits=exits,
        route=route,
        loop=loop,
        group=group,
        type_index=type_index,
        population=None if population is None else Population.of(population),
        fields=fields or {},
    )
    people = model.dynamics.insert(positions, new)
    model.go_on()
    return people


def add_door(model: CrowdModel, door: Door) -> DoorControl:
    """Let a gate or an exit let people by at a rate, close at times, or close when full.

    Returns:
        The door's control, which counts those who have passed.

    Raises:
        ModelError: the gate or exit has one already.
        FloorPlanError: there is no such gate or exit.
    """
    return model.doors.add(door)


def add_source(model: CrowdModel, source: Source) -> Inflow:
    """Let people in over time.

    Each appears at a random place of the source's area with room for their body. While there is
    no room, people are held back in order.

    Returns:
        The inflow, which counts those who have come and those held back.

    Raises:
        ModelError: an unknown type, or what ``add_pedestrians`` refuses.
        FloorPlanError: an area without room for a body, an unknown exit or gate, or no route
            from there.
    """
    inflow = model.sources.add(source, model.frame)
    model.go_on()
    return inflow
