"""Several storeys of a file and what joins them, before they are checked together."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats.content import Content

LEVEL_ZERO = 0
"""Number of the storey that is read where one is needed and none is named."""


@dataclass(frozen=True)
class Link:
    """Stairs, a ramp, an escalator or a lift, as in a building's GeoJSON.

    Attributes:
        kind: "stairs", "ramp", "escalator" or "lift".
        name: unique in the file.
        line: two points (x, y) in metres: the upper edge, or the door of a lift.
        levels: numbers of the storeys that it joins; of all but lifts the upper and the lower one.
        given: further properties of such a feature.
    """

    kind: str
    name: str
    line: tuple[tuple[float, float], tuple[float, float]]
    levels: tuple[int, ...]
    given: dict[str, Any] = field(default_factory=dict)


@dataclass
class Storey:
    """A storey: its number, what the file calls it, its height in metres, and its floor."""

    number: int
    name: str
    elevation: float
    content: Content


@dataclass
class Storeys:
    """The storeys of a file.

    Attributes:
        storeys: from the lowest.
        links: what joins them.
        name: of the building.
        notes: what the reader has changed or left out, a line each; those of one storey are in its
            content.
    """

    storeys: list[Storey]
    links: list[Link] = field(default_factory=list)
    name: str = ""
    notes: list[str] = field(default_factory=list)

    def named(self, level: str | None, where: str) -> Storey:
        """The storey of a number or a name.

        Args:
            level: the number or the name; None for number 0, or the lowest.
            where: name of the file in an error message.

        Raises:
            FloorPlanError: there is no such storey.
        """
        if level is None:
            ground = [each for each in self.storeys if each.number == LEVEL_ZERO]
            return ground[0] if ground else self.storeys[0]
        asked = level.strip()
        for each in self.storeys:
            if asked in (str(each.number), each.name):
                return each
        raise FloorPlanError(
            f"{where}: has no level {asked!r:.40}, expected one of {', '.join(self.called())}"
        )

    def called(self) -> list[str]:
        """Number and name of each storey, for messages."""
        return [
            str(each.number)
            if each.name in ("", str(each.number))
            else f"{each.number} ({each.name})"
            for each in self.storeys
        ]

    def content(self, level: str | None, where: str) -> Content:
        """One storey alone; see ``named``. Notes say which one of several it is."""
        storey = self.named(level, where)
        content = storey.content
        content.name = content.name or self.name
        content.notes = [*self.notes, *content.notes]
        if level is None and len(self.storeys) > 1:
            content.notes.append(
                f"level {storey.number} of {', '.join(self.called())}; --level names another"
            )
        return content


def numbered(elevations: Sequence[float]) -> list[int]:
    """Numbers of storeys from the lowest: 0 for the one whose height is nearest to 0."""
    ground = min(range(len(elevations)), key=lambda k: (abs(elevations[k]), k))
    return [k - ground for k in range(len(elevations))]
