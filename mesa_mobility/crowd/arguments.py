"""The arguments of a model's constructor, read and checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from mesa_mobility.crowd.costs.layout import KERNEL_FIELDS
from mesa_mobility.crowd.people.pedestrian import Pedestrian, check_pedestrian_class
from mesa_mobility.crowd.people.pedestrian_type import PedestrianType, types_of
from mesa_mobility.crowd.presets import Preset, read_preset
from mesa_mobility.crowd.scene import Scene, make_scene
from mesa_mobility.crowd.state.fields import read_fields
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.populations import Population


def read_scene(
    floor_plan: FloorPlan,
    *,
    preset: str | Preset,
    mobility_map: MobilityMap | str | Path | None,
    pedestrian_types: Sequence[PedestrianType] | None,
    population: Population | Mapping[str | PedestrianType, float] | str | None,
    pedestrian_class: type[Pedestrian],
    fields: Mapping[str, type] | None,
) -> Scene:
    """A scene without people, from arguments of ``PedestrianModel``.

    Raises:
        ModelError: an unknown preset, or types, fields or a class of agents that do not fit.
        MapError: an unusable map file.
    """
    rules = read_preset(preset)
    check_pedestrian_class(pedestrian_class)
    kinds = read_fields(fields, taken=[*dir(pedestrian_class), "row", *KERNEL_FIELDS])
    shares = None if population is None else Population.of(population)
    types = types_of(mobility_map, pedestrian_types, shares)
    return make_scene(floor_plan, types, rules, shares=shares, fields=kinds)


def check_frames_per_step(frames: object) -> None:
    """Raise ModelError unless a step can advance so many frames."""
    if not isinstance(frames, int) or frames < 1:
        raise ModelError(f"frames_per_step: got {frames!r}, expected 1, 2, 3 or more")


def check_record(record: object) -> None:
    """Raise ModelError unless this is what a model can record."""
    if record not in (False, True, "decisions"):
        raise ModelError(f"record: got {record!r}, expected True, False or 'decisions'")
