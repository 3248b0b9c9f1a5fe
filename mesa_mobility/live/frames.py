"""Frames of a running model as messages, binary or JSON."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import LiveError

MAGIC = b"MMLF"
VERSION = 1
HEADER = struct.Struct("<4sHHIIQd")
"""Magic, version, flags, frame, people, number, sent; 32 bytes, little-endian."""

PAUSED = 1
"""Flag of a frame of a model for which no time goes by."""

BUILDING = 2
"""Flag of a frame of a building, which has ``z`` and ``level``, too."""

COLUMNS = ("x", "y", "heading", "vx", "vy")
"""What a frame says of each person, besides the person's number."""

BYTES_A_PERSON = 8 * len(COLUMNS) + 4

BYTES_IN_A_BUILDING = 8 + 2
"""More bytes of each person in a building: ``z`` and ``level``."""


@dataclass(frozen=True, eq=False)
class Frame:
    """Where everybody inside is in one frame.

    Attributes:
        number: of the message; grows by one with each frame that is published, so a gap tells how
            many have been left out.
        frame: of the model, 1/30 s.
        sent: when it was published, seconds since 1970.
        paused: whether time stands still.
        person: (n,) int32, rising; the person's number, the same in all frames.
        x: (n,) metres.
        y: (n,) metres.
        heading: (n,) radians, counter-clockwise from +x.
        vx: (n,) mean velocity of the movement under way, m/s.
        vy: (n,) the same along y.
        z: (n,) metres, of the floor below each person in a building; None on a floor plan.
        level: (n,) int16, the number of the level on which each is in a building, or ``ON_STAIRS``
            (``mesa_mobility.buildings``); None on a floor plan.
    """

    number: int
    frame: int
    sent: float
    paused: bool
    person: NDArray[np.int32]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    heading: NDArray[np.float64]
    vx: NDArray[np.float64]
    vy: NDArray[np.float64]
    z: NDArray[np.float64] | None = None
    level: NDArray[np.int16] | None = None

    def __len__(self) -> int:
        return len(self.person)

    def to_bytes(self) -> bytes:
        """The binary form."""
        flags = (PAUSED if self.paused else 0) | (0 if self.z is None else BUILDING)
        head = HEADER.pack(MAGIC, VERSION, flags, self.frame, len(self), self.number, self.sent)
        columns = [np.asarray(getattr(self, name), dtype="<f8").tobytes() for name in COLUMNS]
        more = []
        if self.z is not None and self.level is not None:
            more = [self.z.astype("<f8").tobytes(), self.level.astype("<i2").tobytes()]
        return b"".join([head, *columns, self.person.astype("<i4").tobytes(), *more])

    def to_json(self) -> str:
        """The JSON form; its numbers are the same to the last bit."""
        values: dict[str, Any] = {
            "type": "frame",
            "number": self.number,
            "frame": self.frame,
            "sent": self.sent,
            "paused": self.paused,
            "person": self.person.tolist(),
        }
        values |= {name: getattr(self, name).tolist() for name in COLUMNS}
        if self.z is not None and self.level is not None:
            values |= {"z": self.z.tolist(), "level": self.level.tolist()}
        return json.dumps(values, separators=(",", ":"), allow_nan=False)


def read_frame(message: bytes | str) -> Frame:
    """The frame of a message in either form.

    Raises:
        LiveError: the message is no frame.
    """
    return _of_json(message) if isinstance(message, str) else _of_bytes(message)


def _of_bytes(message: bytes) -> Frame:
    if len(message) < HEADER.size:
        raise LiveError(f"frame: {len(message)} bytes, expected {HEADER.size} or more")
    magic, version, flags, frame, n, number, sent = HEADER.unpack_from(message)
    if magic != MAGIC or version != VERSION:
        raise LiveError(
            f"frame: begins with {magic!r}, version {version}, expected {MAGIC!r}, {VERSION}"
        )
    building = bool(flags & BUILDING)
    expected = HEADER.size + n * (BYTES_A_PERSON + BYTES_IN_A_BUILDING * building)
    if len(message) != expected:
        raise LiveError(f"frame: {len(message)} bytes for {n} people, expected {expected}")
    columns = np.frombuffer(message, "<f8", len(COLUMNS) * n, HEADER.size)
    columns = columns.reshape(len(COLUMNS), n)
    person = np.frombuffer(message, "<i4", n, HEADER.size + columns.nbytes)
    z = level = None
    if building:
        at = HEADER.size + n * BYTES_A_PERSON
        z = np.frombuffer(message, "<f8", n, at)
        level = np.frombuffer(message, "<i2", n, at + z.nbytes)
    paused = bool(flags & PAUSED)
    x, y, heading, vx, vy = columns
    return Frame(number, frame, sent, paused, person, x, y, heading, vx, vy, z, level)


def _of_json(message: str) -> Frame:
    try:
        values = json.loads(message)
        if values["type"] != "frame":
            raise LiveError(f"frame: a message of type {values['type']!r}, expected 'frame'")
        person = np.array(values["person"], dtype=np.int32)
        columns = [np.array(values[name], dtype=np.float64) for name in COLUMNS]
        x, y, heading, vx, vy = columns
        z = level = None
        if "z" in values:
            z = np.array(values["z"], dtype=np.float64)
            level = np.array(values["level"], dtype=np.int16)
        given = [each for each in (*columns, z, level) if each is not None]
        shapes = {person.shape, *(each.shape for each in given)}
        if shapes != {(len(person),)}:
            raise LiveError("frame: lists of unequal length, expected one value for each person")
        return Frame(
            int(values["number"]),
            int(values["frame"]),
            float(values["sent"]),
            bool(values["paused"]),
            person,
            x,
            y,
            heading,
            vx,
            vy,
            z,
            level,
        )
    except (ValueError, KeyError, TypeError, OverflowError, RecursionError) as error:
        reason = " ".join(str(error).split())
        raise LiveError(f"frame: not readable: {type(error).__name__} {reason}") from error
