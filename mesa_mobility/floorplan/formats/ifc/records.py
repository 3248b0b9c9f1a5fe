"""The content of a building model, checked: its storeys and their elements."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor.extent import check_coordinates


@dataclass(frozen=True)
class Storey:
    """A storey: number in the file, name, and height in metres."""

    key: int
    name: str
    elevation: float


@dataclass(frozen=True)
class Step:
    """A level face of stairs: its height and what it covers in plan, metres."""

    height: float
    area: BaseGeometry


@dataclass(frozen=True)
class Element:
    """A room, a wall, a slab, an opening, a door, stairs or a lift; metres.

    Attributes:
        kind: which of these.
        key: its number in the file.
        name: its name.
        long_name: the longer name of a room.
        storey: number of its storey in the file, or None.
        type: what type of its kind it says that it is.
        area: what it covers in plan; empty without a body.
        bottom: its lowest height.
        top: its greatest height.
        external: whether it says that it leads, or is, outside; None if it says neither.
        width: of a door as a whole.
        clear: width of a door that it says is free.
        lining: thickness of a door's lining.
        door: number of the door in an opening.
        host: number of what an opening is cut out of.
        in_slab: whether this is a slab or a roof.
        risers: number of risers that stairs give, or None.
        steps: level faces of stairs.
        stated_area: square metres that the file gives for a room, or None.
    """

    kind: str
    key: int
    name: str = ""
    long_name: str = ""
    storey: int | None = None
    type: str = ""
    area: BaseGeometry = field(default_factory=Polygon)
    bottom: float = 0.0
    top: float = 0.0
    external: bool | None = None
    width: float | None = None
    clear: float | None = None
    lining: float | None = None
    door: int | None = None
    host: int | None = None
    in_slab: bool = False
    risers: int | None = None
    steps: tuple[Step, ...] = ()
    stated_area: float | None = None


@dataclass(frozen=True)
class Model:
    """A building model: its name, its storeys from the lowest, and its elements."""

    name: str
    storeys: tuple[Storey, ...]
    elements: tuple[Element, ...]
    counts: Mapping[str, int]

    def of(self, *kinds: str) -> list[Element]:
        """The elements of some kinds."""
        return [each for each in self.elements if each.kind in kinds]


def model_of(answer: Mapping[str, Any], where: str) -> Model:
    """The model of what the other process has printed.

    Raises:
        FloorPlanError: coordinates that are too large.
    """
    storeys = [Storey(each["id"], each["name"], each["elevation"]) for each in answer["storeys"]]
    return Model(
        answer["name"],
        tuple(sorted(storeys, key=lambda each: (each.elevation, each.key))),
        tuple(_element(each, where) for each in answer["elements"]),
        answer["counts"],
    )


def _element(values: Mapping[str, Any], where: str) -> Element:
    given = dict(values)
    key, external = given.pop("id"), given.pop("external")
    steps = [Step(height, _area(text, where)) for height, text in given.pop("steps", ())]
    area = _area(given.pop("area"), where) if "area" in given else Polygon()
    sure = external if isinstance(external, bool) else None
    return Element(key=key, external=sure, area=area, steps=tuple(steps), **given)


def _area(text: str, where: str) -> BaseGeometry:
    area = shapely.force_2d(shapely.from_wkb(text))
    check_coordinates(shapely.get_coordinates(area), where)
    return area if area.is_valid else shapely.make_valid(area)
