"""The state of the crowd: one array with a record for each pedestrian.

A pedestrian keeps its row for ever; rows of people who have left are inactive.  ``Pedestrian``
objects are views of a row.

With one array of records, not an array for each field, a compiled function has seven arguments
instead of two hundred, and what it reads of a person lies side by side.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError

PERSON = np.dtype(
    [
        # First what neighbours read.
        ("x", "f8"),
        ("y", "f8"),
        ("vx", "f8"),
        ("vy", "f8"),
        ("core", "f8"),
        ("box", "f8", (4,)),
        ("stride", "f8"),
        ("start", "i4"),
        ("gone", "i4"),
        ("spacing", "i4"),
        ("option", "i4"),
        ("from_x", "f8"),
        ("from_y", "f8"),
        ("from_c", "f8"),
        ("from_s", "f8"),
        ("from_heading", "f8"),
        ("to_x", "f8"),
        ("to_y", "f8"),
        ("to_heading", "f8"),
        ("heading", "f8"),
        ("target_x", "f8"),
        ("target_y", "f8"),
        ("route", "f8"),
        ("preferred", "f8"),
        ("end", "i4"),
        ("cluster", "i4"),
        ("destination", "i4"),
        ("type_index", "i2"),
        ("knots", "i1"),
        ("active", "?"),
        ("decisions", "i4"),
        ("fallbacks", "i4"),
        ("fallback_frames", "i4"),
        ("active_frames", "i4"),
    ],
    align=True,
)
"""Record of a pedestrian.

Now: ``x``, ``y``, ``heading`` (metres, radians), ``vx``, ``vy`` (mean velocity of the movement
under way, m/s), ``active`` (in the model).  Person: ``preferred`` speed (m/s), ``core`` radius
(m), ``type_index`` (index of the pedestrian type), ``destination`` (the router's number).  Movement
under way: ``option`` (row of the option table; -1 none yet, -2 fallback), ``cluster`` (at its
end), ``start`` and ``end`` frames, ``gone`` (frame at which the person has crossed an exit,
or -1), ``spacing`` (frames between knots), ``knots`` (their number), ``from_x``, ``from_y``,
``from_heading`` where it starts, with cosine and sine ``from_c`` and ``from_s`` of an option's,
``to_x``, ``to_y``, ``to_heading`` where it ends, ``box`` (4,) what the path covers: least x, least
y, greatest x, greatest y, ``stride`` most metres on the way in the time between two samples.
Where to: ``target_x``, ``target_y``, ``route`` (metres left).
Counters: ``decisions``, ``fallbacks``, ``fallback_frames``, ``active_frames``.

Frames have 31 bits, which last for two years.
"""

CrowdState: TypeAlias = "np.recarray[Any, Any]"
"""(n,) records of ``PERSON``, as compiled functions take them."""

NO_OPTION = -1
NO_CORNER = -1
FALLBACK = -2


AGENDA = np.dtype(
    [
        ("speed", "f8"),
        ("sets_off", "i4"),
        ("waits_until", "i4"),
        ("journey", "i4"),
        ("crossed", "i4"),
        ("group", "i4"),
        ("corner", "i4"),
        ("mouth", "i4"),
        ("checked", "f8"),
        ("nearest", "f8"),
        ("since", "f8"),
        ("desired_speed", "f8"),
        ("behind", "f8"),
    ],
    align=True,
)
"""Fields that are needed only when a pedestrian gets a target, apart to keep records small.

Fields: ``speed``, its unhindered preferred speed, m/s (``preferred`` in the record is that of
its last decision); ``sets_off``, frame of its first decision; ``waits_until``,
frame before which it does not walk; ``journey``, the number of its journey, 0 for none;
``crossed``, gates of it that it has crossed up to frame ``checked``; ``group``, the
number of its group, 0 for none; ``corner``, number of the next corner of its route;
``mouth``, number from 1 on of the mouth by which it is about to enter a narrow passage, minus that
number if it leaves by the mouth, else 0; ``nearest``, shortest route so far, metres, and ``since``,
time of its last progress, s; ``desired_speed``, the preferred speed of its last decision, m/s, and
``behind``, its accumulated distance error, metres.
"""


class Crowd:
    """Everybody's records, with a view of each field: ``crowd.x`` is everybody's x.

    Args:
        capacity: number of records; none of them is active.

    Attributes:
        records: (capacity,) records of ``PERSON``; each of its fields is an attribute as well.
        agenda: (capacity,) records of ``AGENDA``.
        fields: (capacity,) values of each field that the model declares for its people.
    """

    agenda: NDArray[np.void]
    fields: dict[str, NDArray[Any]]

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    vx: NDArray[np.float64]
    vy: NDArray[np.float64]
    core: NDArray[np.float64]
    box: NDArray[np.float64]
    stride: NDArray[np.float64]
    start: NDArray[np.int32]
    gone: NDArray[np.int32]
    spacing: NDArray[np.int32]
    option: NDArray[np.int32]
    from_x: NDArray[np.float64]
    from_y: NDArray[np.float64]
    from_c: NDArray[np.float64]
    from_s: NDArray[np.float64]
    from_heading: NDArray[np.float64]
    to_x: NDArray[np.float64]
    to_y: NDArray[np.float64]
    to_heading: NDArray[np.float64]
    heading: NDArray[np.float64]
    target_x: NDArray[np.float64]
    target_y: NDArray[np.float64]
    route: NDArray[np.float64]
    preferred: NDArray[np.float64]
    end: NDArray[np.int32]
    cluster: NDArray[np.int32]
    destination: NDArray[np.int32]
    type_index: NDArray[np.int16]
    knots: NDArray[np.int8]
    active: NDArray[np.bool_]
    decisions: NDArray[np.int32]
    fallbacks: NDArray[np.int32]
    fallback_frames: NDArray[np.int32]
    active_frames: NDArray[np.int32]

    def __init__(self, capacity: int, fields: Mapping[str, np.dtype[Any]] | None = None) -> None:
        self._take(np.zeros(capacity, dtype=PERSON))
        self.agenda = np.zeros(capacity, dtype=AGENDA)
        self.fields = {name: np.zeros(capacity, kind) for name, kind in (fields or {}).items()}

    def first(self, count: int) -> dict[str, Any]:
        """The records of the first people."""
        return {
            "records": np.array(self.records[:count]),
            "agenda": self.agenda[:count],
            "fields": {name: values[:count] for name, values in self.fields.items()},
        }

    def replace(self, people: Mapping[str, Any]) -> None:
        """Hold the people of ``first`` alone.

        Raises:
            ModelError: records with other fields.
        """
        records, agenda, fields = people["records"], people["agenda"], people["fields"]
        kinds = {name: values.dtype for name, values in fields.items()}
        if (records.dtype, agenda.dtype, kinds) != (
            PERSON, AGENDA, {name: values.dtype for name, values in self.fields.items()}
        ):  # fmt: skip
            raise ModelError("its people have other fields than those of this model")
        capacity = max(len(records), 64)
        self._take(_larger(records, capacity))
        self.agenda = _larger(agenda, capacity)
        self.fields = {name: _larger(values, capacity) for name, values in fields.items()}

    def grow(self, capacity: int) -> None:
        """Make room for more people."""
        self._take(_larger(self.records, capacity))
        self.agenda = _larger(self.agenda, capacity)
        self.fields = {name: _larger(values, capacity) for name, values in self.fields.items()}

    def __getstate__(self) -> tuple[Any, ...]:
        # In a copy, too, the columns are views of the records.
        return self.records, self.agenda, self.fields

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        records, self.agenda, self.fields = state
        self._take(records)

    def _take(self, records: NDArray[np.void]) -> None:
        self.records = cast(CrowdState, records)
        for name in PERSON.names or ():
            setattr(self, name, records[name])


def _larger(records: NDArray[Any], capacity: int) -> NDArray[Any]:
    larger = np.zeros(capacity, dtype=records.dtype)
    larger[: len(records)] = records
    return larger
