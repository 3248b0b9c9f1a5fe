"""Curves of a CAD drawing in DXF, by layer, in metres."""

import logging
import os
from collections.abc import Iterable, Iterator
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import FloorPlanError, MobilityError
from mesa_mobility.floorplan.floor.extent import check_coordinates

METRES = {
    "mm": 0.001,
    "cm": 0.01,
    "dm": 0.1,
    "m": 1.0,
    "km": 1000.0,
    "in": 0.0254,
    "ft": 0.3048,
    "yd": 0.9144,
}
"""Metres in a unit."""

UNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m", 7: "km", 10: "yd", 14: "dm"}
"""Units by the code in a drawing's header, $INSUNITS."""

LARGEST_FILE = 64_000_000
"""Bytes of a drawing; to read more takes minutes."""

MOST_ENTITIES, MOST_POINTS, DEEPEST = 200_000, 1_000_000, 16
"""Limits after blocks are resolved: a small file can nest them a million times."""

SAGITTA = 0.005
"""Metres that a chord lies from its arc at most."""

_CURVES = ("LINE", "LWPOLYLINE", "POLYLINE", "CIRCLE", "ARC", "ELLIPSE", "SPLINE")
_NOTES = (
    "ATTDEF",
    "ATTRIB",
    "DIMENSION",
    "HATCH",
    "LEADER",
    "MTEXT",
    "MULTILEADER",
    "POINT",
    "TEXT",
)
"""Entities that only say something about others, or fill what others outline."""


# Faults of a file are errors here, or of no account; without a handler they would be printed.
logging.getLogger("ezdxf").addHandler(logging.NullHandler())


class Curve(NamedTuple):
    """A curve of a drawing.

    Attributes:
        layer: name of the curve's layer.
        what: kind and handle of the curve, for error messages.
        points: (n, 2) metres.
    """

    layer: str
    what: str
    points: NDArray[np.float64]


class Drawing:
    """A drawing in DXF.

    Args:
        path: the file.
        unit: one of ``METRES``, for a drawing that does not say its own or says a wrong one.

    Attributes:
        unit: the unit of its coordinates.
        layers: names of the layers on which something is drawn.

    Raises:
        FloorPlanError: the file cannot be read or is no DXF, or its unit is not known.
        MobilityError: ezdxf is not installed.
    """

    def __init__(self, path: "str | os.PathLike[str]", unit: str | None = None) -> None:
        if find_spec("ezdxf") is None:
            raise MobilityError(
                f"{path}: DXF needs ezdxf: pip install 'mesa-mobility[cad]' brings what it needs"
            )
        self._path = path
        if unit is not None and unit not in METRES:
            raise FloorPlanError(f"unit: got {unit!r}, expected one of {', '.join(METRES)}")
        document = _read(path)
        self.unit = unit or self._unit_of(document)
        self._count = 0
        try:
            self._entities = list(self._all(document.modelspace(), "", 0))
        except FloorPlanError:
            raise
        except Exception as error:  # ezdxf raises whatever malformed entities led it into
            raise FloorPlanError(f"{path}: cannot be read ({_line(error)})") from None
        self.layers = sorted({layer for layer, _ in self._entities})

    def curves(self, layers: Iterable[str], *, lenient: bool = False) -> list[Curve]:
        """All curves on some layers, in the order of the file; arcs as chords.

        Args:
            layers: names.
            lenient: whether edges of hatches count, and other entities are left out.

        Raises:
            FloorPlanError: something else is drawn there, or coordinates are out of range.
        """
        wanted, found, count = set(layers), [], 0
        for layer, entity in self._entities:
            if layer not in wanted:
                continue
            if lenient and entity.dxftype() == "HATCH":
                found += self._hatch(layer, entity)
                continue
            if entity.dxftype() in _NOTES or (lenient and entity.dxftype() not in _CURVES):
                continue
            handle = entity.dxf.handle or getattr(entity.source_of_copy, "dxf", entity.dxf).handle
            what = f"{entity.dxftype()} #{handle} on layer {layer}"
            points = self._points(entity, f"{self._path}: {what}")
            count += len(points)
            if count > MOST_POINTS:
                raise FloorPlanError(
                    f"{self._path}: more than {MOST_POINTS:,} points, expected fewer"
                )
            if len(points) > 1:
                found.append(Curve(layer, what, points))
        return found

    def _hatch(self, layer: str, entity: Any) -> list[Curve]:
        """The edges of a hatch, each closed."""
        from ezdxf.path import from_hatch

        what, scale = f"HATCH #{entity.dxf.handle} on layer {layer}", METRES[self.unit]
        found = []
        try:
            for path in from_hatch(entity):
                points = np.array([(v.x, v.y) for v in path.flattening(SAGITTA / scale)]) * scale
                check_coordinates(points, "it")
                if len(points) > 3:
                    found.append(Curve(layer, what, np.concatenate([points, points[:1]])))
        except FloorPlanError as error:
            raise FloorPlanError(f"{self._path}: {what}: {error}") from None
        except Exception as error:  # ezdxf raises whatever malformed entities led it into
            raise FloorPlanError(f"{self._path}: {what}: cannot be read ({_line(error)})") from None
        return found

    def _points(self, entity: Any, at: str) -> NDArray[np.float64]:
        from ezdxf.path import make_path

        if entity.dxftype() not in _CURVES:
            raise FloorPlanError(f"{at}: expected lines, polylines, arcs, circles or splines")
        scale = METRES[self.unit]
        try:
            path = make_path(entity)
            ends = np.array([(v.x, v.y) for v in path.control_vertices()]) * scale
            check_coordinates(ends, "it")
            points = np.array([(v.x, v.y) for v in path.flattening(SAGITTA / scale)]) * scale
        except FloorPlanError as error:
            raise FloorPlanError(f"{at}: {error}") from None
        except Exception as error:  # ezdxf raises whatever malformed entities led it into
            raise FloorPlanError(f"{at}: cannot be read ({_line(error)})") from None
        points = points.reshape(-1, 2)
        again = np.zeros(len(points), dtype=np.bool_)
        again[1:] = (points[1:] == points[:-1]).all(axis=1)
        return points[~again]

    def _unit_of(self, document: Any) -> str:
        code = document.header.get("$INSUNITS", 0)
        if code not in UNITS:
            what = "does not say its unit" if code == 0 else f"has unit {code}"
            raise FloorPlanError(
                f"{self._path}: {what} ($INSUNITS), expected one of {', '.join(METRES)}; set it in "
                "the drawing, or name it as `unit`"
            )
        return UNITS[code]

    def _all(self, entities: Iterable[Any], inherited: str, depth: int) -> Iterator[Any]:
        """Layer and entity of everything drawn, blocks resolved."""
        for entity in entities:
            self._count += 1
            if self._count > MOST_ENTITIES or depth > DEEPEST:
                raise FloorPlanError(
                    f"{self._path}: more than {MOST_ENTITIES:,} entities, or blocks nested deeper "
                    f"than {DEEPEST}: expected a floor plan"
                )
            # What a block has on layer 0 is drawn on the layer on which the block stands.
            own = str(entity.dxf.get("layer", "0"))
            layer = inherited if inherited and own == "0" else own
            if entity.dxftype() == "INSERT":
                for each in entity.multi_insert() if entity.mcount > 1 else (entity,):
                    yield from self._all(each.virtual_entities(), layer, depth + 1)
            else:
                yield layer, entity


def _read(path: "str | os.PathLike[str]") -> Any:
    import ezdxf

    try:
        with open(path, "rb") as file:
            begin = file.read(6)
            size = os.fstat(file.fileno()).st_size
    except OSError as error:
        raise FloorPlanError(f"{path}: cannot be read ({error.strerror})") from None
    if size > LARGEST_FILE:
        raise FloorPlanError(
            f"{path}: {size / 1e6:.0f} MB, expected at most {LARGEST_FILE / 1e6:.0f} MB: save the "
            "layers of the floor plan alone"
        )
    if begin.startswith(b"AC10"):
        raise FloorPlanError(f"{path}: is a DWG, expected a DXF: save it as DXF")
    try:
        return ezdxf.readfile(path)
    except Exception as error:  # ezdxf raises whatever malformed files led it into
        raise FloorPlanError(f"{path}: is not a DXF that can be read ({_line(error)})") from None


def _line(error: Exception) -> str:
    """The text of an error, on one short line."""
    return " ".join(str(error).split())[:100] or type(error).__name__
