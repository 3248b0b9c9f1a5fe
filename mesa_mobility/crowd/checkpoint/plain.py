"""Values as JSON and arrays, and back.

Nothing of what is read is executed: the file names kinds of values from a fixed list.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility import distributions
from mesa_mobility.crowd.doors.door import Door
from mesa_mobility.crowd.insertion.source import Source
from mesa_mobility.crowd.journeys.visit import Visit
from mesa_mobility.crowd.presets.preset import Preset
from mesa_mobility.crowd.presets.provenance import Provenance
from mesa_mobility.crowd.state.fields import KINDS
from mesa_mobility.crowd.types.pedestrian_type import PedestrianType
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import Exit, FloorPlan, Gate, Room, SpeedZone
from mesa_mobility.schema import Members, Whole, check

TAG = "$"
"""Key of the one entry of an object that stands for something else than a dictionary."""

_DATACLASSES: dict[str, Any] = {
    kind.__name__: kind
    for kind in (
        Exit,
        Gate,
        SpeedZone,
        Room,
        Source,
        Door,
        Preset,
        Provenance,
        PedestrianType,
        Visit,
        *(
            each
            for each in vars(distributions).values()
            if isinstance(each, type) and is_dataclass(each)
        ),
    )
}

_GENERATORS = {
    kind.__name__: kind
    for kind in (
        np.random.PCG64,
        np.random.PCG64DXSM,
        np.random.MT19937,
        np.random.Philox,
        np.random.SFC64,
    )
}


class NotPlain(ModelError):
    """A value that a checkpoint cannot hold."""


def set_bits(generator: np.random.Generator, state: Any) -> None:
    """Give a generator its state.

    Raises:
        ContentError: with this state the generator would read beyond its own numbers.
        TypeError: not the state of such a generator; KeyError and ValueError likewise.
    """
    inner = state["state"]
    if "pos" in inner:
        check(inner["pos"], Whole(0, 624), "generator, pos")
    if "buffer_pos" in state:
        check(state["buffer_pos"], Whole(0, 4), "generator, buffer_pos")
    generator.bit_generator.state = state


class Packer:
    """Turns values into JSON and arrays.

    Args:
        references: objects that exist before anything is unpacked, each with a name. Values that
            contain such an object refer to it by that name.

    Attributes:
        arrays: the arrays, by the names that the JSON gives them.
    """

    def __init__(self, references: Sequence[tuple[object, Any]]) -> None:
        self._names = {id(thing): name for thing, name in references}
        self.arrays: dict[str, NDArray[Any]] = {}

    def pack(self, value: Any, where: str) -> Any:
        """The value for JSON.

        Args:
            value: anything.
            where: what the value is, for the error.

        Raises:
            NotPlain: the value cannot be saved.
        """
        if id(value) in self._names:
            return {TAG: ["object", self._names[id(value)]]}
        if value is None or isinstance(value, bool | str) or type(value) in (int, float):
            if type(value) is float and not math.isfinite(value):
                return {TAG: ["float", str(value)]}
            return value
        if isinstance(value, list):
            return [self.pack(each, where) for each in value]
        packed = self._packed(value, where)
        if packed is None:
            raise NotPlain(
                f"{where}: a {type(value).__name__} cannot be saved, expected numbers, texts, "
                "arrays, lists and dictionaries of them, or hooks state() and restore()"
            )
        return {TAG: packed}

    def _packed(self, value: Any, where: str) -> list[Any] | None:
        if isinstance(value, np.ndarray | np.generic):
            return self._array(value)
        if type(value) is tuple:
            return ["tuple", [self.pack(each, where) for each in value]]
        if isinstance(value, dict):
            pairs = [
                [self.pack(key, where), self.pack(each, f"{where}[{key!r}]")]
                for key, each in value.items()
            ]
            return ["dict", pairs]
        if isinstance(value, set | frozenset):
            return [type(value).__name__, [self.pack(each, where) for each in sorted(value)]]
        if isinstance(value, Path):
            return ["path", str(value)]
        if isinstance(value, type) and value in KINDS:
            return ["type", value.__name__]
        if isinstance(value, BaseGeometry):
            return ["geometry", shapely.to_wkb(value, hex=True)]
        if isinstance(value, FloorPlan):
            return ["plan", [value.to_geojson(), self.pack(value.state(), where)]]
        if isinstance(value, np.random.Generator):
            kind = type(value.bit_generator).__name__
            if kind not in _GENERATORS:
                return None
            return ["generator", [kind, self.pack(value.bit_generator.state, where)]]
        name = type(value).__name__
        if _DATACLASSES.get(name) is type(value):
            given = {
                each.name: self.pack(getattr(value, each.name), f"{where}, {each.name}")
                for each in fields(_DATACLASSES[name])
                if each.init
            }
            return ["made", [name, given]]
        return None

    def _array(self, value: NDArray[Any] | np.generic) -> list[Any] | None:
        array = np.asarray(value)
        if array.dtype.hasobject:
            return None
        name = f"a{len(self.arrays)}"
        self.arrays[name] = array
        return ["array" if isinstance(value, np.ndarray) else "scalar", name]


class Unpacker:
    """Restores the values that ``Packer`` has turned into JSON and arrays.

    Args:
        arrays: those of ``Packer.arrays``, by the same names.
        objects: what references refer to now, by the names that ``Packer`` was given in
            ``references``.
    """

    def __init__(self, arrays: Mapping[str, NDArray[Any]], objects: Mapping[Any, Any]) -> None:
        self._arrays = arrays
        self._used: set[str] = set()
        self.objects = objects

    @property
    def left(self) -> list[str]:
        """Names of the arrays that no unpacked value has used so far."""
        return sorted(self._arrays.keys() - self._used)

    def unpack(self, value: Any) -> Any:
        """The value that ``Packer.pack`` was given.

        Raises:
            ModelError: ``Packer.pack`` did not write this value, or one of its arrays was unpacked
                before.
            ContentError: the state of a generator or of a floor plan is not valid.
            FloorPlanError: a floor plan is not valid.
        """
        if isinstance(value, list):
            return [self.unpack(each) for each in value]
        if not isinstance(value, dict):
            return value
        try:
            kind, content = value[TAG]
            return self._unpacked(kind, content)
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise ModelError(f"a value is not one of a checkpoint ({error})") from error

    def _unpacked(self, kind: str, content: Any) -> Any:
        match kind:
            case "object":
                return self.objects[self._name(content)]
            case "float":
                return float(content)
            case "tuple" | "set" | "frozenset":
                made = {"tuple": tuple, "set": set, "frozenset": frozenset}[kind]
                return made(self.unpack(each) for each in content)
            case "dict":
                return {self.unpack(key): self.unpack(each) for key, each in content}
            case "array":
                return self._array(content)
            case "scalar":
                return self._array(content).reshape(())[()]
            case "type":
                return {kind.__name__: kind for kind in KINDS}[content]
            case "path":
                return Path(content)
            case "geometry":
                return shapely.from_wkb(content)
            case "plan":
                plan = FloorPlan.from_geojson(
                    {
                        **content[0],
                        "features": [
                            each
                            for each in content[0]["features"]
                            if each["properties"]["kind"] != "obstacle"
                        ],
                    }
                )
                state = self.unpack(content[1])
                openings = {"openings": [each.name for each in plan.openings()]}
                check(state, Members(plan.members()), "floor plan", openings)
                plan.restore(state)
                return plan
            case "generator":
                generator = np.random.Generator(_GENERATORS[content[0]]())
                set_bits(generator, self.unpack(content[1]))
                return generator
            case "made":
                name, given = content
                return _DATACLASSES[name](**{key: self.unpack(each) for key, each in given.items()})
        raise ValueError(f"kind {kind!r}")

    def _array(self, name: str) -> NDArray[Any]:
        # Not a copy: two values that refer to one array would change together.
        if name in self._used:
            raise ValueError(f"array {name} is there twice")
        self._used.add(name)
        return self._arrays[name]

    @staticmethod
    def _name(content: Any) -> Any:
        return tuple(content) if isinstance(content, list) else content
