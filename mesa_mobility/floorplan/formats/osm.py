"""OpenStreetMap indoor as floor plans: rooms, corridors and doors of a level."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Annotated, Any

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats.assembling.texts import LARGEST_FILE, read_text
from mesa_mobility.floorplan.formats.content import Content
from mesa_mobility.floorplan.formats.indoor.rooms import HEIGHT, read_rooms
from mesa_mobility.floorplan.formats.plan_format import PlanFormat
from mesa_mobility.floorplan.formats.storeys import Storeys
from mesa_mobility.plugins.annotations import Range


class OpenStreetMap(PlanFormat):
    """OpenStreetMap XML: what is tagged indoor, door, level, and steps and lifts between levels."""

    name = "osm"
    suffixes = (".osm",)

    def read(
        self, path: Path, *, height: Annotated[float, Range(1.5, 20)] = HEIGHT
    ) -> Content | Storeys:
        """Read all levels, ``height`` metres apart; see ``read_rooms``.

        Raises:
            FloorPlanError: the file cannot be read, or has no rooms.
        """
        text = read_text(path, LARGEST_FILE, "XML of OpenStreetMap")
        if re.search(r"<!(DOCTYPE|ENTITY)", text):
            raise FloorPlanError(f"{path}: has a document type, expected none")
        try:
            root = ElementTree.fromstring(text)
        except (ElementTree.ParseError, ValueError) as error:
            raise FloorPlanError(f"{path}: is not XML that can be read ({error})") from None
        return read_rooms(_features(root, str(path)), str(path), height)


def _features(root: ElementTree.Element, where: str) -> list[dict[str, Any]]:
    """Nodes with tags as points, closed ways as areas."""
    places: dict[str, list[float]] = {}
    features: list[dict[str, Any]] = []
    for node in root.iter("node"):
        key = node.get("id", "")
        try:
            places[key] = [float(node.get("lon", "")), float(node.get("lat", ""))]
        except ValueError:
            raise FloorPlanError(f"{where}: node {key:.20}: lon and lat must be numbers") from None
        tags = _tags(node)
        if "door" in tags or "entrance" in tags:
            features.append(_feature(tags, "Point", places[key]))
    for way in root.iter("way"):
        tags = _tags(way)
        points = [places[ref] for each in way.iter("nd") if (ref := each.get("ref")) in places]
        closed = len(points) > 3 and points[0] == points[-1]
        if closed and ("indoor" in tags or tags.get("highway") == "elevator"):
            features.append(_feature(tags, "Polygon", [points]))
        elif tags.get("highway") == "steps" and len(points) > 1:
            features.append(_feature(tags, "LineString", points))
    return features


def _tags(element: ElementTree.Element) -> dict[str, str]:
    return {each.get("k", ""): each.get("v", "") for each in element.iter("tag")}


def _feature(tags: dict[str, str], kind: str, coordinates: Any) -> dict[str, Any]:
    return {"properties": tags, "geometry": {"type": kind, "coordinates": coordinates}}
