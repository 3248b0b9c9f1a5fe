"""The list of `mesa-mobility plan --check`: oddities for an evacuation, on each level."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mesa_mobility.buildings import Building, Ramp
from mesa_mobility.floorplan.oddities import WHEELCHAIR, Oddity, oddities_of

if TYPE_CHECKING:
    from mesa_mobility.floorplan import FloorPlan
    from mesa_mobility.results.floor import Storey


def numbered_oddities(
    found: FloorPlan | Building, storeys: list[Storey]
) -> list[list[tuple[int, Oddity]]]:
    """The oddities of each storey, with numbers from 1 on.

    Args:
        found: the floor plan or the building.
        storeys: what its pictures show, from the top.
    """
    numbered: list[list[tuple[int, Oddity]]] = []
    count = 0
    levels = [] if not isinstance(found, Building) else _from_the_top(found)
    for k, storey in enumerate(storeys):
        if isinstance(found, Building):
            doors = found.exits(levels[k])
            ends = [each.name for each in storey.plan.exits if each.name not in doors]
            own = [*oddities_of(storey.plan, ends), *_without_lift(found, levels[k], storey)]
        else:
            own = oddities_of(storey.plan)
        numbered.append([(count + n, each) for n, each in enumerate(own, start=1)])
        count += len(own)
    return numbered


def rows_of(
    numbered: list[list[tuple[int, Oddity]]], storeys: list[Storey]
) -> list[dict[str, Any]]:
    """One row for each oddity, with what it is, the level and the place."""
    return [
        {
            "number": number,
            "kind": each.kind,
            "text": each.text,
            "level": storey.title,
            "place": [round(value, 2) for value in each.place],
        }
        for own, storey in zip(numbered, storeys, strict=True)
        for number, each in own
    ]


def _from_the_top(building: Building) -> list[int]:
    ordered = sorted(building.levels, key=lambda level: level.elevation, reverse=True)
    return [each.number for each in ordered]


def _without_lift(building: Building, number: int, storey: Storey) -> list[Oddity]:
    """A level that people in wheelchairs cannot leave, and on which they have no refuge."""
    level = building.level(number)
    steps_only = not any(number in each.numbers for each in building.lifts) and not any(
        isinstance(each, Ramp) and number in (each.upper, each.lower) for each in building.stairs
    )
    wide = [each for each in level.exits if each.length >= WHEELCHAIR - 1e-6]
    if not steps_only or wide or level.refuges:
        return []
    spot = storey.plan.walkable.representative_point()
    text = "no exit, lift or ramp for wheelchairs, and no refuge"
    return [Oddity("no way out for wheelchairs", text, (float(spot.x), float(spot.y)))]
