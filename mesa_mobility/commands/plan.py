"""`mesa-mobility plan`: what a floor plan's file holds, and the same in another format."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mesa_mobility.commands.console import (
    FormatSettings,
    answer_json,
    answer_rows,
    answer_table,
    say,
    some_path,
)
from mesa_mobility.commands.exits import ExitOptions
from mesa_mobility.commands.grouping import grouped

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan, Oddity, Room


@grouped
def plan(
    file: Annotated[
        Path,
        typer.Argument(metavar="FILE", help="A floor plan; `mesa-mobility formats` lists formats."),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            help="File to write, such as a .geojson.",
            parser=some_path,
            metavar="FILE",
        ),
    ] = None,
    *,
    doors: ExitOptions,
    picture: Annotated[
        Path | None,
        typer.Option(
            help="Picture to draw: .png, .svg or .pdf. By default NAME_plan.png in this folder.",
            parser=some_path,
            metavar="FILE",
        ),
    ] = None,
    layers: Annotated[
        list[str] | None,
        typer.Option(
            "--layer",
            metavar="LAYER=KIND",
            help="What a layer of a drawing holds: walkable, obstacle, gate or exit, and a name, "
            "such as 'A-DOOR=exit street'; repeatable.",
        ),
    ] = None,
    unit: Annotated[
        str | None, typer.Option(help="Unit of a drawing that does not say it: mm, cm, m, in, ft.")
    ] = None,
    settings: FormatSettings = None,
    check: Annotated[
        bool,
        typer.Option(
            "--check",
            help="Also list what is odd for an evacuation, and mark it in the picture: narrow "
            "doors, dead ends, floor without a way out, gaps.",
        ),
    ] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print one JSON object instead of a table.")
    ] = False,
) -> None:
    """Check a floor plan or a building, say what it holds, and draw it; -o writes it to a file.

    DXF needs the extra `cad`, IFC the extra `ifc`. Buildings are written to GeoJSON.
    """
    from mesa_mobility.buildings import Building, read_floor
    from mesa_mobility.commands.oddities import numbered_oddities, rows_of
    from mesa_mobility.commands.picture import check_picture, draw_plan
    from mesa_mobility.errors import FloorPlanError
    from mesa_mobility.floorplan.formats.plan_format import PLANS
    from mesa_mobility.plugins.formats import READ, WRITE
    from mesa_mobility.results.floor import storeys_alone

    given = {"layers": _kinds(layers), "unit": unit}
    options = PLANS.chosen_options(PLANS.of(file, READ), READ, given, settings or ())
    if output is not None:
        PLANS.of(output, WRITE)  # before anything is read
    picture = picture or Path(f"{file.stem}_plan.png")
    check_picture(picture)
    found = read_floor(file, doors.text, level=doors.level, **options)
    if isinstance(found, Building):
        if output is not None:
            if output.suffix.lower() not in (".geojson", ".json"):
                raise FloorPlanError(f"{output}: buildings are written to .geojson files alone")
            found.write_geojson(output)
        values, rows = _of_building(found)
    else:
        if output is not None:
            found.to_file(output)
        values, rows = _of_plan(found)
    marks: list[list[tuple[int, Oddity]]] = []
    if check:
        storeys = storeys_alone(found)
        marks = numbered_oddities(found, storeys)
        values["odd"] = rows_of(marks, storeys)
    if as_json:
        answer_json(values)
    else:
        answer_table(rows)
        if check:
            _say_odd(values["odd"])
    draw_plan(found, picture, marks)
    say(f"drawn to {picture}")
    if output is not None:
        say(f"written to {output}")


def _of_building(building: Building) -> tuple[dict[str, Any], dict[str, str]]:
    """The parts of a building, as values and as the rows of a table."""
    plan = building.floor_plan
    exits = {each.name: each.length for each in plan.exits}
    levels = {str(each.number): each.elevation for each in building.levels}
    stairs = {each.name: each.kind for each in building.stairs}
    lifts, refuges = [each.name for each in building.lifts], [e.name for e in building.refuges]
    values = {
        "name": building.name,
        "levels": levels,
        "stairs": stairs,
        "lifts": lifts,
        "refuges": refuges,
        "exits": exits,
        "rooms": [_room(each) for each in building.rooms],
    }
    return values, {
        "levels": ", ".join(f"{name} at {height:g} m" for name, height in levels.items()),
        "stairs": ", ".join(f"{name} ({kind})" for name, kind in stairs.items()) or "none",
        "lifts": ", ".join(lifts) or "none",
        "refuges": ", ".join(refuges) or "none",
        "exits": _listed(exits),
        "rooms": _rooms(building.rooms),
    }


def _of_plan(found: FloorPlan) -> tuple[dict[str, Any], dict[str, str]]:
    """The parts of a floor plan, as values and as the rows of a table."""
    low, high = found.bounds[:2], found.bounds[2:]
    exits = {each.name: each.length for each in found.exits}
    gates = {each.name: each.length for each in found.gates}
    size = (high[0] - low[0], high[1] - low[1])
    values = {
        "name": found.name,
        "size_m": size,
        "free_area_m2": found.area,
        "exits": exits,
        "gates": gates,
        "obstacles": len(found.obstacles),
        "zones": [each.name for each in found.zones],
        "rooms": [_room(each) for each in found.rooms],
    }
    return values, {
        "size": f"{size[0]:.2f} by {size[1]:.2f} m",
        "free area": f"{found.area:.2f} m\u00b2",
        "exits": _listed(exits),
        "gates": _listed(gates),
        "obstacles": str(len(found.obstacles)),
        "zones": ", ".join(each.name for each in found.zones) or "none",
        "rooms": _rooms(found.rooms),
    }


def _say_odd(odd: list[dict[str, Any]]) -> None:
    """List what is odd, in the order of its numbers."""
    if not odd:
        print("nothing odd was found")
        return
    has_levels = any(each["level"] for each in odd)
    columns = ["", *(["level"] if has_levels else []), "x, y (m)", "what is odd"]
    rows = [
        [
            str(each["number"]),
            *([each["level"]] if has_levels else []),
            "{:.2f}, {:.2f}".format(*each["place"]),
            f"{each['kind']}: {each['text']}",
        ]
        for each in odd
    ]
    answer_rows(columns, rows)


def _room(room: Room) -> dict[str, Any]:
    return {
        "name": room.name,
        "level": room.level,
        "use": room.use,
        "area_m2": room.area,
        "stated_area_m2": room.stated_area,
        "doors": list(room.doors),
    }


def _rooms(rooms: Sequence[Room]) -> str:
    return ", ".join(str(each) for each in rooms) or "none"


def _kinds(texts: list[str] | None) -> dict[str, str] | None:
    if not texts:
        return None
    kinds = {}
    for text in texts:
        layer, equals, kind = text.rpartition("=")
        if not equals or not layer:
            raise typer.BadParameter(f"--layer: got {text!r}, expected LAYER=KIND")
        kinds[layer] = kind
    return kinds


def _listed(openings: dict[str, float]) -> str:
    return ", ".join(f"{name} ({length:.2f} m)" for name, length in openings.items()) or "none"
