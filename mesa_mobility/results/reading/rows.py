"""What a reader of a format finds in a file, and what is said about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

KNOWN = ("file", "argument")
"""How a unit or frame rate is known that was not guessed."""
BAD_ROW, DUPLICATE, GAP, JUMP, ALONE = "bad row", "duplicate row", "gap", "jump", "alone"


@dataclass(frozen=True)
class Fault:
    """Something wrong with a file of tracks.

    Attributes:
        kind: ``"bad row"``, ``"duplicate row"``, ``"gap"``, ``"jump"`` or ``"alone"``.
        what: one line that names the person, the frame or the line.
        person: number of the person, as in the tracks; None in a row that cannot be read.
        frame: the frame, or the last one before a gap or a jump; None as before.
    """

    kind: str
    what: str
    person: int | None = None
    frame: int | None = None


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows of tracks as a file has them, before their unit is known.

    Attributes:
        person: (n,) whole numbers.
        frame: (n,) whole numbers.
        x: (n,) in the file's unit.
        y: (n,) in the file's unit.
        heading: (n,) radians, where the file has it.
        unit: ``"m"``, ``"cm"`` or ``"mm"``, if the file says so.
        frame_rate: frames a second, if the file says so.
        faults: rows that were left out because they could not be read.
        z: (n,) elevation of the floor in the file's unit, if the file has it.
    """

    person: NDArray[Any]
    frame: NDArray[Any]
    x: NDArray[Any]
    y: NDArray[Any]
    heading: NDArray[Any] | None = None
    unit: str | None = None
    frame_rate: float | None = None
    faults: tuple[Fault, ...] = ()
    z: NDArray[Any] | None = None


@dataclass(frozen=True)
class Reading:
    """How a file of tracks was read.

    Attributes:
        file: its path, as it was given.
        unit: unit of the file's coordinates: ``"m"``, ``"cm"`` or ``"mm"``.
        unit_from: how the unit is known: ``"file"``, ``"argument"``, or the spacing and the speeds
            by which it was guessed.
        frame_rate: frames a second.
        frame_rate_from: how the frame rate is known: ``"file"``, ``"argument"``, or the steps by
            which it was guessed.
        headings_from: ``"file"``, or ``"way"`` if they are the direction of travel.
        faults: what is wrong with the file, in its order. Rows that cannot be read and rows that
            repeat a person and frame are left out; gaps and jumps stay as they are.
    """

    file: str
    unit: str
    unit_from: str
    frame_rate: float
    frame_rate_from: str
    headings_from: str = "file"
    faults: tuple[Fault, ...] = ()

    def of_kind(self, kind: str) -> list[Fault]:
        """The faults of a kind."""
        return [each for each in self.faults if each.kind == kind]

    def warnings(self) -> list[str]:
        """One line each for a guessed unit, a guessed frame rate, and each kind of fault, with its
        first instance."""
        said = []
        if self.unit_from not in KNOWN:
            said.append(f"{self.file}: taken to be in {self.unit}: {self.unit_from}")
        if self.frame_rate_from not in KNOWN:
            said.append(
                f"{self.file}: taken to have {self.frame_rate:g} frames a second: "
                f"{self.frame_rate_from}; give frame_rate if it is another"
            )
        for kind in dict.fromkeys(each.kind for each in self.faults):
            first, *others = self.of_kind(kind)
            more = f" (and {len(others)} more)" if others else ""
            said.append(f"{self.file}: {first.what}{more}")
        return said
