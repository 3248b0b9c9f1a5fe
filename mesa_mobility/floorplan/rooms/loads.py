"""Occupant loads: how many people rooms hold, by number, density or use."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cache
from importlib.resources import files
from types import MappingProxyType

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.room import Room

MOST_PEOPLE = 1_000_000
"""People in one room at most."""

DIGITS = 20
"""Digits of a number of people that are read; a number with more is too large anyway."""

DENSEST = 10.0
"""People on a square metre at most."""

SQUARE_FOOT = 0.3048**2
"""Square metres."""

DEFAULT = "ibc"
"""The table that is used where none is named."""

Load = int | str | None
"""People in all; a text such as "0.5/m2", "10 m2", "office" or "nfpa101:office"; None, or the name
of a table, for the rooms' own uses."""

_NUMBER = r"(\d+\.?\d*|\.\d+)"
_DENSITY = re.compile(rf"{_NUMBER}\s*/\s*(?:m2|m\u00b2)")
_SPACE = re.compile(rf"{_NUMBER}\s*(?:m2|m\u00b2)")
_EXPECTED = "expected a number of people, a density such as 0.5/m2, a space such as 10 m2, or a use"


@dataclass(frozen=True)
class UseOfTable:
    """The line of a table for one use.

    Attributes:
        density: people on a square metre.
        gross: whether it is for the gross floor area, walls included, of which ``Room.gross_area``
            is that of a room.
        words: of the table, in short.
        by_heart: whether the figure was written down from memory.
    """

    density: float
    gross: bool
    words: str
    by_heart: bool

    def people(self, room: Room) -> float:
        """How many people a room of this use holds, not yet rounded."""
        return self.density * (room.gross_area if self.gross else room.area)


@dataclass(frozen=True)
class LoadTable:
    """A published table of occupant loads.

    Attributes:
        title: of the code, with its edition and number.
        page: where its figures were read.
        uses: by name.
    """

    title: str
    page: str
    uses: Mapping[str, UseOfTable]


@cache
def load_tables() -> Mapping[str, LoadTable]:
    """The published tables by name: ``ibc``, ``nfpa101``, ``adb`` and ``mvstaettvo``."""
    text = files("mesa_mobility").joinpath("data/occupant_loads.toml").read_text("utf-8")
    found = {}
    for name, table in tomllib.loads(text).items():
        uses = {
            use: UseOfTable(
                _density(each), each.get("gross", False), each["words"], each.get("by_heart", False)
            )
            for use, each in table["uses"].items()
        }
        found[name] = LoadTable(
            table["title"], " ".join(table["page"].split()), MappingProxyType(uses)
        )
    return MappingProxyType(found)


def _density(given: Mapping[str, float]) -> float:
    if "per_m2" in given:
        return given["per_m2"]
    return 1.0 / (given["ft2"] * SQUARE_FOOT if "ft2" in given else given["m2"])


def occupant_numbers(
    rooms: Sequence[Room], loads: Load | Mapping[str, Load] = None
) -> list[tuple[Room, int]]:
    """How many people each room holds.

    Numbers are whole and add up: together rooms of one load hold what they hold together, rounded,
    and each of them its own share, rounded up or down (method of largest remainders).

    Args:
        rooms: the rooms.
        loads: a load for all rooms, or loads by name of a room or by pattern such as "office*"; a
            room gets the first load whose pattern fits it, and nobody if none does. A load is the
            number of people in all these rooms, shared by area; a density, "0.5/m2"; the space of
            each person, "10 m2"; or a use of a table, "office" or "nfpa101:office", for which some
            tables count the gross area of rooms (``Room.gross_area``). None, or the
            name of a table, stands for the rooms' own uses. Rooms without a use are then left
            empty.

    Returns:
        Each room with its number of people, in the order given.

    Raises:
        FloorPlanError: no such room or use, rooms that have no use at all, or a load out of range.
    """
    by_pattern = loads if isinstance(loads, Mapping) else {"*": loads}
    numbers = [0] * len(rooms)
    left = list(range(len(rooms)))
    for pattern, load in by_pattern.items():
        fitting = {rooms[k].name for k in range(len(rooms)) if fits(rooms[k], pattern)}
        if not fitting:
            raise FloorPlanError(f"there is no room {pattern!r}; there are {_names(rooms)}")
        own = [k for k in left if rooms[k].name in fitting]
        left = [k for k in left if rooms[k].name not in fitting]
        for k, number in zip(own, _numbers([rooms[k] for k in own], load), strict=True):
            numbers[k] = number
    return list(zip(rooms, numbers, strict=True))


def fits(room: Room, pattern: str) -> bool:
    """Whether a pattern, in which ``*`` and ``?`` stand for letters, fits a room's name."""
    return room.name == pattern or fnmatchcase(room.name, pattern)


def shared_out(shares: Sequence[float]) -> list[int]:
    """Whole numbers that add up to the sum of shares, rounded half up; each its share, rounded.

    The shares with the largest remainders are rounded up, the first of equal ones.
    """
    total = math.floor(math.fsum(shares) + 0.5)
    whole = [math.floor(each) for each in shares]
    by_remainder = sorted(range(len(shares)), key=lambda k: (whole[k] - shares[k], k))
    for k in by_remainder[: total - sum(whole)]:
        whole[k] += 1
    return whole


def _numbers(rooms: Sequence[Room], load: Load) -> list[int]:
    if not rooms:
        return []
    if isinstance(load, str) and load.strip().isdecimal():
        load = int(load.strip()[:DIGITS])
    if isinstance(load, int) and not isinstance(load, bool):
        if not 0 <= load <= MOST_PEOPLE:
            raise FloorPlanError(f"{load} people, expected 0 to {MOST_PEOPLE:,}")
        whole = math.fsum(each.area for each in rooms)
        return shared_out([load * each.area / whole for each in rooms])
    if not isinstance(load, str | None):
        raise FloorPlanError(f"load {load!r:.60}: {_EXPECTED}")
    people_in = _read((load or DEFAULT).strip(), rooms)
    shares = [people_in(each) for each in rooms]
    if max(shares) > MOST_PEOPLE:
        raise FloorPlanError(f"load {load!r:.60}: more than {MOST_PEOPLE:,} people in a room")
    return shared_out(shares)


def _read(text: str, rooms: Sequence[Room]) -> Callable[[Room], float]:
    """How many people a room holds by a text, not yet rounded."""
    density, space = _DENSITY.fullmatch(text), _SPACE.fullmatch(text)
    if density or space:
        found = density or space
        assert found is not None
        value = float(found[1])
        per_m2 = value if density else 1.0 / value if value else math.inf
        if not per_m2 <= DENSEST:
            raise FloorPlanError(
                f"load {text!r:.60}: expected at most {DENSEST:g} people on a square metre"
            )
        return lambda room: per_m2 * room.area
    if text in load_tables():
        if not any(each.use for each in rooms):
            raise FloorPlanError(
                f"{_names(rooms)}: no use is known, expected one, or a number or density of people"
            )
        return lambda room: (
            _of_use(room.use, text, f"room {room.name!r}: ").people(room) if room.use else 0.0
        )
    table, _, use = text.rpartition(":")
    if table and table not in load_tables():
        raise FloorPlanError(
            f"load {text!r:.60}: there is no table {table!r:.60}; there are "
            f"{', '.join(load_tables())}"
        )
    return _of_use(use, table or DEFAULT, "").people


def _of_use(use: str, table: str, where: str) -> UseOfTable:
    uses = load_tables()[table].uses
    if use not in uses:
        raise FloorPlanError(
            f"{where}there is no use {use!r:.60} in table {table}: {_EXPECTED} such as "
            f"{', '.join(uses)}"
        )
    return uses[use]


def _names(rooms: Iterable[Room]) -> str:
    names = [each.name for each in rooms]
    return ", ".join(names[:20]) + (", ..." if len(names) > 20 else "") if names else "none"
