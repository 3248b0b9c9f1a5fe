"""Building models in IFC: storeys with rooms, doors and walls, and the stairs between them."""

from collections.abc import Sequence
from pathlib import Path

import shapely
from shapely import Polygon

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.room import Room, rooms_named_apart
from mesa_mobility.floorplan.formats.assembling.parts import tied
from mesa_mobility.floorplan.formats.content import Content
from mesa_mobility.floorplan.formats.ifc.child import extracted
from mesa_mobility.floorplan.formats.ifc.doors import add_doors
from mesa_mobility.floorplan.formats.ifc.drafts import Draft, drafts_of
from mesa_mobility.floorplan.formats.ifc.joining import Join, joins_of
from mesa_mobility.floorplan.formats.ifc.records import model_of
from mesa_mobility.floorplan.formats.plan_format import PlanFormat
from mesa_mobility.floorplan.formats.storeys import Storey, Storeys

LEFT_OUT = {"furniture": "pieces of furniture", "lift": "lifts", "escalator": "escalators"}
"""Kinds of elements that are left out, in words."""

LEAST_PIECE = 0.1
"""Metres; a piece of floor in which no point is this far from its edge is left out."""


class Ifc(PlanFormat):
    """Building model in IFC: storeys, rooms, doors, stairs and ramps. Needs the extra `ifc`."""

    name = "ifc"
    suffixes = (".ifc",)

    def read(self, path: Path, *, furniture: bool = False) -> Storeys:
        """Read the storeys of a building and what joins them.

        Rooms without walls are the floor, doors lead through the walls, and doors that lead outside
        are exits. With ``furniture``, this stands in the way, too.

        Raises:
            FloorPlanError: the file cannot be read, or has no floor.
            MobilityError: IfcOpenShell is not installed.
        """
        model = model_of(extracted(path, furniture), str(path))
        notes: list[str] = []
        drafts = drafts_of(model, notes)
        if not drafts:
            raise FloorPlanError(f"{path}: has no rooms and no slabs, expected a floor to walk on")
        taken: set[str] = set()
        ground = next(each.elevation for each in drafts if each.number == 0)
        for draft in drafts:
            add_doors(draft, model, ground, taken)
        joins = joins_of(model, drafts, notes)
        for kind, words in LEFT_OUT.items():
            if model.counts.get(kind) and not (kind == "furniture" and furniture):
                notes.append(f"left out {model.counts[kind]} {words}")
        storeys = [
            Storey(each.number, each.storey.name, each.elevation, _content(each, joins))
            for each in drafts
        ]
        return Storeys(storeys, [each.link for each in joins], model.name, notes)


def _content(draft: Draft, joins: Sequence[Join]) -> Content:
    """The floor of a storey: the pieces with a way out, tied together."""
    pieces = [
        piece
        for piece in shapely.get_parts(draft.floor())
        if piece.geom_type == "Polygon" and not piece.buffer(-LEAST_PIECE).is_empty
    ]
    ends = [each.before[draft.number] for each in joins if draft.number in each.before]
    ways = [*ends, *(each.line for each in draft.exits)]
    kept = [piece for piece in pieces if any(piece.distance(way) < 1e-3 for way in ways)]
    left = [piece for piece in pieces if not any(piece.distance(way) < 1e-3 for way in ways)]
    if kept:
        for piece in left:
            spot = piece.representative_point()
            draft.notes.append(
                f"left out {piece.area:.2f} m² around ({spot.x:.2f}, {spot.y:.2f}): no way leads "
                "from there to an exit or to stairs"
            )
    floor, obstacles = tied(kept or pieces, [each.taken for each in joins])
    room = floor.buffer(0.01)
    return Content(
        floor,
        name=draft.storey.name,
        exits=draft.exits,
        gates=[each for each in draft.gates if room.covers(each.line)],
        obstacles=obstacles,
        rooms=_rooms(draft, floor),
        notes=draft.notes,
        foreign=True,
    )


def _rooms(draft: Draft, floor: Polygon) -> list[Room]:
    """The rooms of a storey, as large as the file draws them, of which some floor is left."""
    named = []
    for each in draft.rooms:
        parts = [part for part in shapely.get_parts(each.area) if part.geom_type == "Polygon"]
        shape = max(parts, key=lambda part: part.area, default=Polygon())
        if each.kind == "room" and shape.intersection(floor).area > 0.0:
            words = dict.fromkeys(word for word in (each.name, each.long_name) if word)
            named.append((" ".join(words) or "room", shape, each.stated_area))
    return rooms_named_apart(named)
