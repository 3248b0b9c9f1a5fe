"""The arguments of a model's constructor, read and checked."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, cast

from mesa_mobility._numbers import is_number
from mesa_mobility.buildings import Building
from mesa_mobility.crowd.costs.layout import KERNEL_FIELDS
from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.crowd.hooks import Plugin, check_behaviours
from mesa_mobility.crowd.people.pedestrian import Pedestrian, check_pedestrian_class
from mesa_mobility.crowd.presets.preset import Preset
from mesa_mobility.crowd.scene import Scene, make_scene
from mesa_mobility.crowd.state.fields import read_fields
from mesa_mobility.crowd.state.records import GROUND_FIELDS
from mesa_mobility.crowd.tactics.speed_rules import SpeedRule
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.crowd.tactics.target_choice import TargetChoice
from mesa_mobility.crowd.types.pedestrian_type import PedestrianType, types_of
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.mobility.judging.verdict import warn_unless_passed
from mesa_mobility.plugins.settings import being_made, has_attribute, near_miss
from mesa_mobility.populations import Population

MOST_FRAMES = 108_000
"""Most frames in one step: an hour."""


def building_of(
    floor: FloorPlan | Building, fields: Mapping[str, type] | None
) -> tuple[Building | None, FloorPlan]:
    """The building if there are several levels, and the floor plan on which people are simulated.

    Raises:
        ModelError: fields with names of columns that the results of buildings have.
    """
    if not isinstance(floor, Building):
        return None, floor
    if len(floor.levels) == 1:
        return None, floor.floor_plan
    taken = sorted({"z", "level"} & (fields or {}).keys())
    if taken:
        raise ModelError(f"fields: {taken[0]!r} is a column of all results of buildings")
    return floor, floor.floor_plan


def read_scene(
    floor_plan: FloorPlan,
    *,
    rules: Preset,
    mobility_map: MobilityMap | str | Path | None,
    pedestrian_types: Sequence[PedestrianType] | None,
    population: Population | Mapping[str | PedestrianType, float] | str | None,
    pedestrian_class: type[Pedestrian],
    fields: Mapping[str, type] | None,
) -> Scene:
    """A scene without people, from arguments of ``PedestrianModel``.

    Warns of maps that have failed their examination or have never been examined.

    Raises:
        ModelError: types, fields or a class of agents that do not fit.
        MapError: an unusable map file.
    """
    check_pedestrian_class(pedestrian_class)
    kinds = read_fields(
        fields, taken=[*dir(pedestrian_class), "row", *KERNEL_FIELDS, *GROUND_FIELDS]
    )
    shares = None if population is None else Population.of(population)
    types = types_of(mobility_map, pedestrian_types, shares)
    given = [each for kind in types for each in (kind.mobility_map, kind.up, kind.down)]
    for map_ in dict.fromkeys(given):
        if map_ is not None:
            warn_unless_passed(map_)
    return make_scene(floor_plan, types, rules, shares=shares, fields=kinds)


_LISTS: dict[str, type[Plugin]] = {"terms": CostTerm, "speed_rules": SpeedRule, "tactics": Tactic}

SETTABLE = (*_LISTS, "target_choice", "frames_per_step", "watch")
"""What users set of a model."""


def checked_attribute(model: object, name: str, value: Any) -> Any:
    """What a model takes for one of its attributes.

    Subclasses of models, and scripts, keep what they like in attributes of their own, so that only
    misspellings of those in ``SETTABLE`` are refused, and not in a constructor.

    Raises:
        ModelError: another value than expected, or a misspelt name.
    """
    if name in _LISTS:
        if isinstance(value, str | Plugin) or not isinstance(value, Iterable):
            raise ModelError(f"{name}: got {value!r:.80}, expected a list")
        value = value if isinstance(value, list) and name in vars(model) else list(value)
        check_behaviours(name, value, _LISTS[name])
    elif name == "target_choice":
        check_behaviours(name, [value], TargetChoice)
    elif name == "frames_per_step":
        check_frames_per_step(value)
    elif name not in SETTABLE and not being_made(model) and not has_attribute(model, name):
        meant = near_miss(name, SETTABLE)
        if meant is not None:
            raise ModelError(
                f"{type(model).__name__}: no attribute {name!r}, did you mean {meant!r}? One of "
                f"your own is set in the constructor, or declared in the class"
            )
    return value


def check_seconds(name: str, seconds: object) -> None:
    """Raise ModelError unless this is a time, 0 or more; it may be endless."""
    if not is_number(seconds) or cast("float", seconds) < 0.0:
        raise ModelError(f"{name}: got {seconds!r:.60}, expected seconds, 0 or more")


def check_frames_per_step(frames: object) -> None:
    """Raise ModelError unless a step can advance so many frames."""
    if not isinstance(frames, int) or isinstance(frames, bool) or not 1 <= frames <= MOST_FRAMES:
        raise ModelError(f"frames_per_step: got {frames!r}, expected 1 to {MOST_FRAMES}")


def check_record(record: object) -> None:
    """Raise ModelError unless this is what a model can record."""
    if record not in (False, True, "decisions"):
        raise ModelError(f"record: got {record!r}, expected True, False or 'decisions'")
