"""Objects that all parts of a model share: the floor, the people's types, options and records."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.journeys.journeys import Journeys
from mesa_mobility.crowd.lifts.escalators import Escalators
from mesa_mobility.crowd.lifts.lifts import Lifts
from mesa_mobility.crowd.options.repertoire import Repertoire, repertoire
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.planning.workspace import Rules
from mesa_mobility.crowd.presets.preset import Preset
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.state.grounds import GroundMaps, Grounds
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.state.twins import strips_of
from mesa_mobility.crowd.types.pedestrian_type import PedestrianType
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.populations import Population


@dataclass(frozen=True, eq=False)
class Scene:
    """The parts of a model that are never replaced while it runs.

    Attributes:
        plan: the floor plan.
        types: the pedestrian types.
        shares: the population that people are drawn from unless a type is given, if there is one.
        preset: the rules by which they move.
        repertoire: the movement options of all maps: those of the types, then those for stairs.
        grounds: by which map people walk where.
        rules: the constants of a decision.
        environment: walls and routes.
        journeys: the routes of people who cross gates in order.
        crowd: a record for each person.
        reach: metres from a person within which their movements, body included, end.
        strips: the strips of the plan's seams, as in ``Twins``.
        lifts: the lifts of the plan.
        escalators: the escalators of the plan.
    """

    plan: FloorPlan
    types: tuple[PedestrianType, ...]
    shares: Population | None
    preset: Preset
    repertoire: Repertoire
    grounds: Grounds
    rules: Rules
    environment: Environment
    journeys: Journeys
    crowd: Crowd
    reach: float
    strips: NDArray[np.float64]
    lifts: Lifts
    escalators: Escalators


def make_scene(
    plan: FloorPlan,
    types: tuple[PedestrianType, ...],
    preset: Preset,
    shares: Population | None = None,
    fields: Mapping[str, np.dtype[Any]] | None = None,
) -> Scene:
    """A scene without people.

    Args:
        plan: the floor plan.
        types: the pedestrian types.
        preset: the rules by which they move.
        fields: types of the fields that the model declares for its people.

    Raises:
        ModelError: a map has no option of the preset's durations.
        MapError: a map for stairs that does not say for which treads it is.
    """
    maps = GroundMaps(plan.zones, types)
    known = repertoire(
        maps.maps,
        preset.durations,
        preset.shares,
        preset.most_acceleration,
    )
    radii = np.array([each.half_width for each in types])
    reaches, extents = maps.longest(known.reach), maps.longest(known.extent)
    reach, extent, largest = reaches.max(), extents.max(), radii.max()
    environment = Environment(
        plan,
        reach=float(reach + largest) + 0.02,
        core_radii=radii.tolist(),
        climbs=[bool(each.climbs) for each in types],
    )
    return Scene(
        plan=plan,
        types=types,
        shares=shares,
        preset=preset,
        repertoire=known,
        grounds=Grounds(maps, known, 0.5 * max(preset.durations) * FRAME_SECONDS),
        rules=Rules(
            search_radius=float(reach + extent + 2.0 * largest) + 0.01,
            # One range for all would let people heed others from farther away as soon as a faster
            # type might walk there as well.
            interaction_ranges=np.add.outer(reaches, extents) + np.add.outer(radii, radii) + 0.01,
            hard_bodies=preset.hard_bodies,
            standing=known.standing,
            first_option=known.first_option,
        ),
        environment=environment,
        journeys=Journeys(plan, environment),
        crowd=Crowd(64, fields),
        reach=float(reach + largest) + 0.02,
        strips=strips_of(plan.seams),
        lifts=Lifts(plan.shafts, environment),
        escalators=Escalators(plan.seams, float(reach + 2.0 * largest) + 0.02),
    )
