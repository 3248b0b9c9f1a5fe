"""Buildings from the storeys of a file that another program wrote."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import networkx as nx
import shapely

from mesa_mobility.buildings.building import Building
from mesa_mobility.buildings.connections.escalator import Escalator
from mesa_mobility.buildings.connections.flights import Flight, Landing
from mesa_mobility.buildings.connections.lift import Lift
from mesa_mobility.buildings.connections.ramp import Ramp
from mesa_mobility.buildings.connections.stairs import Stairs
from mesa_mobility.buildings.features import part_of
from mesa_mobility.buildings.geojson import level_of
from mesa_mobility.buildings.headroom import HEADROOM_M, check_headroom, close_to
from mesa_mobility.buildings.level import Level, sheet_of
from mesa_mobility.buildings.sheets import sheets_of
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats.assembling.given_exits import exits_for
from mesa_mobility.floorplan.formats.assembling.parts import tied
from mesa_mobility.floorplan.formats.storeys import Link, Storeys

Joining = Stairs | Ramp | Escalator | Lift

ASIDE = 0.01
"""Metres beside stairs that are taken from floors too close to them."""

LEAST_PIECE = 0.1
"""Metres; a piece of floor in which no point is this far from its edge is left out."""

MOST_LINKS = 500
"""Stairs, ramps, escalators and lifts of a building."""


def building_of(found: Storeys, exits: str | None, where: str, notes: list[str]) -> Building | None:
    """The building of the storeys of a file; None where no two of them are joined.

    Stairs and lifts that do not fit are left out, and then storeys from which nothing leads to an
    exit.

    Args:
        found: storeys and links.
        exits: as ``FloorPlan.from_file`` takes them, of the storey with number 0, or the lowest,
            where no storey has any.
        where: name of the file in messages.
        notes: takes what was changed or left out; where there is no building, only what is missing
            for one.

    Raises:
        FloorPlanError: exits that cannot be placed, or a storey that is no floor.
    """
    # What is given to its floors here is not part of the file.
    own = [replace(each, content=replace(each.content)) for each in found.storeys]
    with_exits = replace(found, storeys=own)
    said = [*found.notes]
    _add_exits(with_exits, exits, said)
    for storey in own:
        said += [f"level {storey.number}: {note}" for note in storey.content.notes]
    left_out: list[str] = []
    levels = _levels(with_exits, where)
    levels, joining = _fitting(levels, found.links, left_out)
    kept = _with_way_out(levels, joining)
    for level in levels:
        if level.number not in kept:
            title = f" ({level.name})" if level.name else ""
            left_out.append(
                f"left out level {level.number}{title}: nothing leads from there to an exit"
            )
    if len(kept) < 2 or not joining:
        notes += left_out
        return None
    notes += [*said, *left_out]
    try:
        return Building(
            [each for each in levels if each.number in kept],
            [each for each in joining if not isinstance(each, Lift) and each.upper in kept],
            lifts=[each for each in joining if isinstance(each, Lift) and each.numbers[0] in kept],
            name=found.name,
        )
    except FloorPlanError as error:
        raise FloorPlanError(f"{where}: {error}") from None


def _add_exits(found: Storeys, exits: str | None, notes: list[str]) -> None:
    """Give exits to the ground storey, if they are asked for and no storey has any."""
    if exits is None:
        return
    if count := sum(len(each.content.exits) for each in found.storeys):
        notes.append(f"--exits is ignored: the file has {count} exit{'s' if count > 1 else ''}")
        return
    content = found.named(None, "").content
    content.exits = exits_for(exits, content.walkable, content.obstacles, notes)


def _levels(found: Storeys, where: str) -> list[Level]:
    """The storeys as levels of a building, in which each door has a name of its own."""
    taken: set[str] = set()
    levels = []
    for storey in found.storeys:
        content = storey.content
        content.name = content.name or storey.name
        exits = [_named_apart(each, storey.number, taken) for each in content.exits]
        gates = [_named_apart(each, storey.number, taken) for each in content.gates]
        content = replace(content, exits=exits, gates=gates)
        try:
            levels.append(level_of(storey.number, content, storey.elevation, ()))
        except FloorPlanError as error:
            raise FloorPlanError(f"{where}: {error}") from None
    return levels


def _named_apart(opening: Any, number: int, taken: set[str]) -> Any:
    name, count = opening.name, 1
    while name in taken:
        name = f"{opening.name} on level {number}" + (f" ({count})" if count > 1 else "")
        count += 1
    taken.add(name)
    return replace(opening, name=name)


def _fitting(
    levels: list[Level], links: Sequence[Link], notes: list[str]
) -> tuple[list[Level], list[Joining]]:
    """Stairs, ramps, escalators and lifts that fit their levels and those before them, and the
    levels without what lies too close above or below them."""
    kept: list[Joining] = []
    names = {each.name for level in levels for each in (*level.exits, *level.gates)}
    heights = {each.number: each.elevation for each in levels}
    for link in links[:MOST_LINKS]:
        name = f"{link.name} ({link.kind})" if link.name in names else link.name
        try:
            part = _made(link, name)
            flights, landings = _parts(part, heights)
            cleared = [_cleared(each, flights, landings) for each in levels]
            _check_fit(cleared, [*kept, part], heights)
        except FloorPlanError as error:
            notes.append(f"left out {link.kind} {link.name!r}: {error}")
        else:
            kept.append(part)
            names.add(name)
            levels = cleared
    if len(links) > MOST_LINKS:
        notes.append(f"left out {len(links) - MOST_LINKS} further stairs and lifts")
    return levels, kept


def _parts(part: Joining, heights: Mapping[int, float]) -> tuple[list[Flight], list[Landing]]:
    """Flights and landings of what joins levels of some heights."""
    if isinstance(part, Lift):
        return [], []
    for number in (part.upper, part.lower):
        if number not in heights:
            raise FloorPlanError(f"there is no level {number}")
    return part.parts(heights[part.upper], heights[part.lower])


def _cleared(level: Level, flights: Sequence[Flight], landings: Sequence[Landing]) -> Level:
    """A level without the floor above or below which flights and landings are too close.

    Raises:
        FloorPlanError: an exit is there.
    """
    cut = [each.area for each in landings if abs(each.elevation - level.elevation) < HEADROOM_M]
    for flight in flights:
        if sheet_of(level.number) not in (flight.upper, flight.lower):
            first, last = close_to(flight, level.elevation)
            cut += [flight.part(first, last)] if last > first else []
    taken = shapely.union_all(cut).buffer(ASIDE, join_style="mitre")
    if not taken.intersection(level.area).area > 0.0:
        return level
    for each in level.exits:
        if taken.intersects(each.line):
            raise FloorPlanError(f"exit {each.name!r} of level {level.number} is above or below it")
    left = [
        part
        for part in shapely.get_parts(level.area.difference(taken))
        if part.geom_type == "Polygon" and not part.buffer(-LEAST_PIECE).is_empty
    ]
    if not left:
        raise FloorPlanError(f"leaves no floor of level {level.number}")
    floor, ties = tied(left, [taken.buffer(1.0)])
    room = floor.buffer(0.01)
    return replace(
        level,
        walkable=floor,
        gates=[each for each in level.gates if room.covers(each.line)],
        obstacles=[*level.obstacles, *ties],
        rooms=[each for each in level.rooms if each.shape.intersection(floor).area > 0.0],
    )


def _made(link: Link, name: str) -> Joining:
    """What a link is in a building."""
    coordinates = [list(each) for each in link.line]
    feature = {"geometry": {"type": "LineString", "coordinates": coordinates}}
    ends: dict[str, Any] = {"levels": list(link.levels)}
    if link.kind != "lift":
        ends = {"from": link.levels[0], "to": link.levels[1]}
    part = part_of(link.kind, feature, {**link.given, **ends, "name": name}, "its numbers")
    assert isinstance(part, Joining)
    return part


def _check_fit(
    levels: Sequence[Level], joining: Sequence[Joining], heights: Mapping[int, float]
) -> None:
    """Raise FloorPlanError where the last of some parts does not fit the levels or the others."""
    flights: list[Flight] = []
    landings: list[Landing] = []
    for each in joining:
        more, between = _parts(each, heights)
        flights, landings = flights + more, landings + between
    lifts = [each for each in joining if isinstance(each, Lift)]
    check_headroom(sheets_of(levels, flights, landings, lifts), flights)


def _with_way_out(levels: Sequence[Level], joining: Sequence[Joining]) -> set[int]:
    """Numbers of the levels from which a way leads to an exit."""
    graph = nx.Graph()
    graph.add_nodes_from(each.number for each in levels)
    for each in joining:
        ends = each.numbers if isinstance(each, Lift) else (each.upper, each.lower)
        nx.add_path(graph, ends)
    out = {each.number for each in levels if each.exits}
    parts = [part for part in nx.connected_components(graph) if part & out]
    return set().union(*parts)
