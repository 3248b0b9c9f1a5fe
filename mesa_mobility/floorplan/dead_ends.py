"""Corridors that lead nowhere: people come to an exit at one of their ends only."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import networkx as nx
import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.floor.openings import Opening
from mesa_mobility.floorplan.rooms.finding import floor_between_gates

CORRIDOR = 2.5
"""Metres; wider floor is no corridor."""

NARROWEST = 0.2
"""Metres; narrower floor is no corridor, either."""

LONGEST = 6.1
"""Metres of a corridor that may lead nowhere: 20 feet in section 1020.5 of the International
Building Code 2021. With sprinklers throughout, 15.2 m (50 feet) in most uses."""

SLENDER = 2.5
"""A corridor that is shorter than so many times its width may lead nowhere (exception 3 there)."""

TOUCHING = 2e-3
"""Metres between pieces of floor that people go to and fro."""

AT_A_DOOR = 0.1
"""Metres between a door and the floor before it."""

OUT = -1
"""The node beyond the exits."""


class DeadEnd(NamedTuple):
    """A corridor that leads nowhere: its width and length in metres, and its blind end (x, y)."""

    width: float
    length: float
    place: tuple[float, float]


class _Part(NamedTuple):
    """Floor of one width: its area, the piece of floor between gates that it is of, and whether it
    is a corridor."""

    area: Polygon
    piece: int
    narrow: bool


def dead_ends_of(plan: Floor) -> list[DeadEnd]:
    """The corridors of a floor plan that lead nowhere.

    They do so for more than 6.1 m, and for more than 2.5 times their width. Corridors are floor at
    most 2.5 m wide that ends at gates and at wider floor. One leads nowhere if people come to an
    exit at one of its ends, and not at another. With one exit alone, corridors to rooms are none:
    section 1020.5 of the International Building Code is for buildings that need two. A room that
    has one gate, and no other door, is no corridor.

    Lengths are measured in a straight line.
    """
    pieces = floor_between_gates(plan)
    parts = [part for k, piece in enumerate(pieces) for part in _parts(piece, k)]
    if not any(part.narrow for part in parts):
        return []
    ways = _ways(plan, parts)
    rooms = {k for k, piece in enumerate(pieces) if _doors(plan, piece) == (1, 0)}
    found = []
    for k, part in enumerate(parts):
        low, high = np.split(np.array(part.area.bounds), 2)
        if part.narrow and part.piece not in rooms and np.hypot(*(high - low)) > LONGEST:
            end = _only_way(ways, k, len(plan.exits))
            width = width_of(part.area)
            if end is None or not NARROWEST < width <= CORRIDOR:
                continue
            corners = shapely.get_coordinates(part.area)
            away = shapely.distance(end, shapely.points(corners))
            far = int(np.argmax(away))
            if away[far] > max(LONGEST, SLENDER * width):
                x, y = corners[far].tolist()
                found.append(DeadEnd(width, float(away[far]), (x, y)))
    return found


def width_of(area: Polygon) -> float:
    """Metres: the shorter side of a rectangle as large, and with an edge as long, as an area."""
    half = area.length / 2.0
    return (half - math.sqrt(max(half * half - 4.0 * area.area, 0.0))) / 2.0


def _parts(piece: Polygon, number: int) -> Iterator[_Part]:
    """The wide and the narrow floor of a piece."""
    half = CORRIDOR / 2
    wide = piece.buffer(-half, join_style="mitre").buffer(half + 1e-3, join_style="mitre")
    for area, narrow in ((piece.intersection(wide), False), (piece.difference(wide), True)):
        for part in shapely.get_parts(area):
            if isinstance(part, Polygon) and not part.is_empty:
                yield _Part(part, number, narrow)


def _ways(plan: Floor, parts: Sequence[_Part]) -> nx.MultiGraph:
    """A graph of the parts between which people go; each edge has the place where they do."""
    ways = nx.MultiGraph()
    ways.add_nodes_from([*range(len(parts)), OUT])
    tree = shapely.STRtree([each.area for each in parts])
    for a, b in tree.query([each.area for each in parts], "dwithin", TOUCHING).T.tolist():
        if a < b and parts[a].piece == parts[b].piece:
            shared = parts[a].area.intersection(parts[b].area.buffer(TOUCHING))
            for place in shapely.get_parts(shared.buffer(CORRIDOR / 4)):
                ways.add_edge(a, b, place=place.intersection(shared))
    for gate in plan.gates:
        ways.add_edges_from(
            (a, b, {"place": gate.line}) for a, b in pairwise(_at(gate, parts, tree))
        )
    for each in plan.exits:
        ways.add_edges_from((k, OUT, {"place": each.line}) for k in _at(each, parts, tree))
    return ways


def _at(door: Opening, parts: Sequence[_Part], tree: shapely.STRtree) -> list[int]:
    """The part of each piece of floor that is nearest to the middle of a door beside it."""
    middle = shapely.Point(door.midpoint)
    near = tree.query(middle, "dwithin", AT_A_DOOR).tolist()
    near.sort(key=lambda k: parts[k].area.distance(middle))
    return list({parts[k].piece: k for k in reversed(near)}.values())


def _only_way(ways: nx.MultiGraph, part: int, exits: int) -> BaseGeometry | None:
    """The end of a corridor at which people come to an exit; None if there is none, or another way
    on."""
    ends = list(ways.edges(part, data="place"))
    without = ways.subgraph(node for node in ways if node != part)
    outside = nx.node_connected_component(without, OUT)
    out = [place for _, other, place in ends if other in outside]
    if len(out) != 1 or (len(ends) > 1 and exits < 2):
        return None
    return out[0]


def _doors(plan: Floor, piece: Polygon) -> tuple[int, int]:
    """The numbers of gates and of exits of a piece of floor."""
    near = piece.buffer(AT_A_DOOR)
    gates, exits = (
        sum(near.intersects(shapely.Point(each.midpoint)) for each in doors)
        for doors in (plan.gates, plan.exits)
    )
    return gates, exits
