"""The state of the crowd: one array with a record for each pedestrian.

A pedestrian keeps their row for ever; rows of people who have left are inactive.  ``Pedestrian``
objects are views of a row.

With one array of records, not an array for each field, a compiled function has seven arguments
instead of two hundred, and the values that it reads of a person lie side by side.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.schema import Array, Kind, Members, Records

FARTHEST = 1e9
"""Most metres of any place, such as a target, from the origin; its square is still exact enough."""

LAST_FRAME = 2**30
"""A year of frames: beyond, sums of frames would not fit their 31 bits."""


def _record(fields: Mapping[str, Array]) -> np.dtype[Any]:
    """The type of records with these fields."""
    return np.dtype(
        [(name, kind.dtype, kind.shape or ()) for name, kind in fields.items()], align=True
    )


_FRAME = Array("i4", (), 0, LAST_FRAME)
_METRES = Array("f8", (), -FARTHEST, FARTHEST)
_RADIANS = Array("f8", (), -1e6, 1e6)
_SPEED = Array("f8", (), -100.0, 100.0)
_COUNT = Array("i4", (), 0, LAST_FRAME)

PERSON_FIELDS: dict[str, Array] = {
    # First what neighbours read.
    "x": _METRES,
    "y": _METRES,
    "vx": _SPEED,
    "vy": _SPEED,
    "core": Array("f8", (), 1e-6, 1.0),
    "box": Array("f8", (4,), -FARTHEST, FARTHEST),
    "stride": Array("f8", (), 0.0, 100.0),
    "start": _FRAME,
    "gone": Array("i4", (), -1, LAST_FRAME),
    "spacing": Array("i4", (), 1, LAST_FRAME),
    "option": Array("i4", (), -3, below="options"),
    "from_x": _METRES,
    "from_y": _METRES,
    "from_c": Array("f8", (), -1.0, 1.0),
    "from_s": Array("f8", (), -1.0, 1.0),
    "from_heading": _RADIANS,
    "to_x": _METRES,
    "to_y": _METRES,
    "to_heading": _RADIANS,
    "heading": _RADIANS,
    "target_x": _METRES,
    "target_y": _METRES,
    "route": Array("f8", (), -FARTHEST, FARTHEST, infinite=True),
    "preferred": Array("f8", (), 0.0, 100.0),
    # As wide as what is beside it, so that there are no bytes between.
    "presses": Array("i8", (), 0, 1),
    "end": _FRAME,
    "cluster": Array("i4", (), 0, below="clusters"),
    "destination": Array("i4", (), 0, below="destinations"),
    "type_index": Array("i2", (), 0, below="types"),
    "knots": Array("i1", (), 1, 16),
    "active": Array("?", ()),
    "decisions": _COUNT,
    "fallbacks": _COUNT,
    "fallback_frames": _COUNT,
    "active_frames": _COUNT,
}

PERSON = _record(PERSON_FIELDS)
"""Record of a pedestrian.

Now: ``x``, ``y``, ``heading`` (metres, radians), ``vx``, ``vy`` (mean velocity of the movement
under way, m/s), ``active`` (in the model).  Person: ``preferred`` speed (m/s), ``core`` radius
(m), ``type_index`` (index of the pedestrian type), ``destination`` (the router's number).  Movement
under way: ``option`` (row of the option table; -1 none yet, -2
fallback, -3 carried), ``cluster`` (at its
end), ``start`` and ``end`` frames, ``gone`` (frame at which the person has crossed an exit,
or -1), ``spacing`` (frames between knots), ``knots`` (their number), ``from_x``, ``from_y``,
``from_heading`` where it starts, with cosine and sine ``from_c`` and ``from_s`` of an option's,
``to_x``, ``to_y``, ``to_heading`` where it ends, ``box`` (4,) what the path covers: least x, least
y, greatest x, greatest y, ``stride`` most metres on the way in the time between two samples.
Where to: ``target_x``, ``target_y``, ``route`` (metres left); ``presses`` (whether others count in
the decision by their bodies alone, not in cost terms).
Counters: ``decisions``, ``fallbacks``, ``fallback_frames``, ``active_frames``.

Frames have 31 bits, which last for two years.
"""

CrowdState: TypeAlias = "np.recarray[Any, Any]"
"""(n,) records of ``PERSON``, as compiled functions take them."""

NO_OPTION = -1
NO_CORNER = -1
FALLBACK = -2
CARRIED = -3


_SECONDS = Array("f8", (), -1e9, 1e9)

PACE, TREAD = GROUND_FIELDS = "pace", "tread"

AGENDA_FIELDS: dict[str, Array] = {
    "speed": Array("f8", (), 0.0, 100.0),
    "sets_off": _FRAME,
    "waits_until": Array("i4", (), 0),
    "journey": Array("i4", (), 0, below="journeys+1"),
    "crossed": _COUNT,
    "group": Array("i4", (), 0, below="groups+1"),
    "corner": Array("i4", (), -1),
    "checked": Array("f8", (), -1.0, LAST_FRAME),
    "nearest": Array("f8", (), -FARTHEST, FARTHEST, infinite=True),
    "since": _SECONDS,
    "desired_speed": Array("f8", (), 0.0, 100.0),
    "behind": Array("f8", (), -1e3, 1e3),
    "strayed": _RADIANS,
    PACE: Array("f8", (), 0.0, 1.0),
    TREAD: Array("f8", (), 0.0, 100.0),
}

AGENDA = _record(AGENDA_FIELDS)
"""Record of what is needed only when a pedestrian gets a target, apart to keep ``PERSON`` small.

Fields: ``speed``, the unhindered preferred speed, m/s (``preferred`` in ``PERSON`` is that of the
last decision); ``sets_off``, frame of the first decision; ``waits_until``, frame before which the
person does not walk; ``journey``, number of their journey, 0 for none; ``crossed``, how many stops
of the journey they have passed up to frame ``checked``; ``group``, number of their group, 0 for
none; ``corner``, number of the next corner of their route; ``nearest``, shortest route so far,
metres; ``since``, time of their last progress, s; ``desired_speed``, the preferred speed of the
last decision, m/s; ``behind``, metres by which free walking has fallen short of that speed, below 0
if they are ahead; ``strayed``, angle by which the movement under way ends off the course;
``pace``, share of their speed at which the ground lets them walk; ``tread``, depth of the treads
beneath them, metres, 0 off stairs.
"""


class Crowd:
    """Everybody's records, with a view of each field: ``crowd.x`` is everybody's x.

    Args:
        capacity: number of records; none of them is active.

    Attributes:
        records: (capacity,) records of ``PERSON``; each of its fields is an attribute as well.
        agenda: (capacity,) records of ``AGENDA``.
        fields: (capacity,) values of each field that the model declares for its people.
        person_of: (rows,) for each row that of the person whose copy it is, while there are copies
            for people on other sheets of the floor plan; otherwise empty.
        copies: (k,) rows of the copies of those who are where two sheets are one, in order.
    """

    agenda: NDArray[np.void]
    fields: dict[str, NDArray[Any]]
    person_of: NDArray[np.int64] = np.empty(0, np.int64)
    copies: NDArray[np.int64] = np.empty(0, np.int64)

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
    presses: NDArray[np.int64]
    decisions: NDArray[np.int32]
    fallbacks: NDArray[np.int32]
    fallback_frames: NDArray[np.int32]
    active_frames: NDArray[np.int32]

    def __init__(self, capacity: int, fields: Mapping[str, np.dtype[Any]] | None = None) -> None:
        self._take(np.zeros(capacity, dtype=PERSON))
        self.agenda = np.zeros(capacity, dtype=AGENDA)
        self.fields = {name: np.zeros(capacity, kind) for name, kind in (fields or {}).items()}

    @property
    def kernel_fields(self) -> dict[str, NDArray[Any]]:
        """(capacity,) values that a kernel may ask for by ``fields``: those of the fields that the
        model declares, and ``pace``."""
        return {**{name: self.agenda[name] for name in GROUND_FIELDS}, **self.fields}

    def first(self, count: int) -> dict[str, Any]:
        """The records of the first people."""
        return {
            "records": np.array(self.records[:count]),
            "agenda": self.agenda[:count],
            "fields": {name: values[:count] for name, values in self.fields.items()},
        }

    def members(self) -> dict[str, Kind]:
        """What ``first`` gives."""
        fields = {
            name: Array(values.dtype.str, ("people",), infinite=True, missing=True)
            for name, values in self.fields.items()
        }
        return {
            "records": Records(PERSON, PERSON_FIELDS, ("people",)),
            "agenda": Records(AGENDA, AGENDA_FIELDS, ("people",)),
            "fields": Members(fields),
        }

    def replace(self, people: Mapping[str, Any]) -> None:
        """Hold the people of ``first`` alone."""
        records, agenda, fields = people["records"], people["agenda"], people["fields"]
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
