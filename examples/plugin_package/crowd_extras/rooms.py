"""A format of floor plans: rectangles and doors, line by line."""

from __future__ import annotations

from pathlib import Path

import shapely
from shapely import box

from mesa_mobility import Exit
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Content, PlanFormat


class Rooms(PlanFormat):
    """Rooms as rectangles: `room x0 y0 x1 y1`, and `door NAME x0 y0 x1 y1`."""

    name = "rooms"
    suffixes = (".rooms",)

    def read(self, path: Path, *, scale: float = 1.0) -> Content:
        """Read rooms, which make up the floor, and doors on its edge.

        Args:
            path: the file.
            scale: metres in a unit of the file.

        Raises:
            FloorPlanError: the file cannot be read, or a line is neither a room nor a door.
        """
        try:
            lines = path.read_text(encoding="utf-8").splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise FloorPlanError(f"{path}: cannot be read ({error})") from None
        rooms, doors = [], []
        for number, line in enumerate(lines, start=1):
            words = line.split()
            try:
                x0, y0, x1, y1 = (scale * float(word) for word in words[-4:])
                if words[0] == "room":
                    rooms.append(box(x0, y0, x1, y1))
                elif words[0] == "door":
                    doors.append(Exit(" ".join(words[1:-4]), (x0, y0), (x1, y1)))
                else:
                    raise ValueError
            except (ValueError, IndexError):
                raise FloorPlanError(
                    f"{path}: line {number}: got {line[:40]!r}, expected `room x0 y0 x1 y1` or "
                    "`door NAME x0 y0 x1 y1`"
                ) from None
        return Content(shapely.union_all(rooms), exits=doors)
