"""What is noted of people in conflict, and the order in which they make way."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point, internal
from mesa_mobility.crowd.conflicts.hindrance import PATIENCE
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.state.records import FARTHEST, CrowdState
from mesa_mobility.crowd.state.wishes import NOBODY
from mesa_mobility.schema import Array

AGREED = 3.0
"""Seconds for which somebody makes way at least, since those they make way for have to set off."""

GIVES_UP = 8.0
"""Seconds without progress after which those for whom others make way come last: so there is no
room for the others to make."""

LONGEST = 40.0
"""Seconds without progress after which they come last even while others still make room, since
people may make room in turns without end. In this time they walk out of a way of 30 m."""

LATER = 30.0
"""Seconds for which whoever has made way lets others pass who follow closely: the longest that
people wait patiently (Transportation Research Board, Highway Capacity Manual, 2000, chapter 18).
A person who has found no room to make, or is held by a wall, comes first for as long."""

CLOSELY = 100.0
"""Metres by which the routes of those who follow closely are longer, at most: everybody near enough
to be blocked follows closely."""

_SECONDS = Array("f8", (), -1.0, 1e9)

NOTE_FIELDS: dict[str, Array] = {
    "blocker": Array("i8", (), NOBODY, below="people"),
    "first": Array("i8", (), NOBODY, below="people"),
    "asked_by": Array("i8", (), NOBODY, below="people"),
    "until": _SECONDS,
    "served": _SECONDS,
    "later": _SECONDS,
    "sooner": _SECONDS,
    "aside": Array("u1", (), 0, 1),
    "x": Array("f8", (), -FARTHEST, FARTHEST),
    "y": Array("f8", (), -FARTHEST, FARTHEST),
}

NOTE = np.dtype([(name, kind.dtype) for name, kind in NOTE_FIELDS.items()], align=True)
"""What is noted of a person.

``blocker``: who is in the way of what they would do alone; ``first``: for whom they make way,
themselves where they first have to go back from a wall;
``asked_by``: who has asked them to, the first or somebody who makes way for the first; ``until``:
when they stop making way; ``served``: since when others make way for them; ``later``: until when
they come after those who follow closely, ``sooner``: until when they come before those, seconds;
``aside``: 1 if they have found a place to make way to that leaves the way free; ``x``, ``y``: where
they make way to, metres.
Rows are -1 for nobody.
"""


def blank_notes(count: int) -> NDArray[np.void]:
    """(count,) notes of people in no conflict."""
    notes = np.zeros(count, NOTE)
    for name in ("blocker", "first", "asked_by"):
        notes[name] = NOBODY
    return notes


@internal()
def goes_before(i: int, j: int, elapsed: float, state: CrowdState, notes: NDArray[np.void]) -> bool:
    """Whether person i comes before person j in the order of those who do not make way.

    The person with less far to go comes first, since that clears the way for those behind. A person
    who has just made way comes after those who follow closely, so that no two make way for each
    other in turns. A person who has found no room to make comes before them.
    """
    mine, theirs = _place(i, elapsed, state, notes), _place(j, elapsed, state, notes)
    return bool(mine < theirs or (mine == theirs and i < j))


@internal()
def _place(i: int, elapsed: float, state: CrowdState, notes: NDArray[np.void]) -> float:
    """Place of person i in the order, metres of a route."""
    later, sooner = notes[i]["later"] > elapsed, notes[i]["sooner"] > elapsed
    return float(state[i].route + CLOSELY * later - CLOSELY * sooner)


@internal()
def ask(
    who: int, first: int, by: int, elapsed: float, state: CrowdState, notes: NDArray[np.void]
) -> None:
    """Have somebody make way for ``first``, unless they come before them in the order."""
    now = notes[who]["first"]
    if who == first or not state[who].active or goes_before(who, first, elapsed, state, notes):
        return
    if now != first:
        if now != NOBODY and goes_before(now, first, elapsed, state, notes):
            return
        notes[who]["first"], notes[who]["later"] = first, elapsed + LATER
        notes[who]["x"], notes[who]["y"] = state[who].x, state[who].y
    notes[who]["asked_by"], notes[who]["until"] = by, elapsed + AGREED


@internal()
def _gets_on(i: int, elapsed: float, agenda: NDArray[np.void], notes: NDArray[np.void]) -> bool:
    """Whether person i has made progress, or way for others, within the last seconds.

    People who wait do not, nor do those who go back from a wall.
    """
    waits = agenda[i]["waits_until"] * FRAME_SECONDS > elapsed or notes[i]["first"] == i
    return bool(not waits and elapsed - agenda[i]["since"] <= PATIENCE)


@entry_point()
def pass_on(
    rows: NDArray[np.int64],
    blockers: NDArray[np.int64],
    elapsed: float,
    state: CrowdState,
    agenda: NDArray[np.void],
    notes: NDArray[np.void],
) -> None:
    """Have those make way who are in the way of people in ``rows``, who make way themselves."""
    for k in range(len(rows)):
        i, j = rows[k], blockers[k]
        notes[i]["blocker"] = j
        if j != NOBODY and notes[i]["first"] != j and not _gets_on(j, elapsed, agenda, notes):
            ask(j, notes[i]["first"], i, elapsed, state, notes)


@entry_point()
def join(
    rows: NDArray[np.int64],
    blockers: NDArray[np.int64],
    seen: NDArray[np.float64],
    elapsed: float,
    state: CrowdState,
    agenda: NDArray[np.void],
    notes: NDArray[np.void],
) -> None:
    """Have people in ``rows`` make way who would run into somebody who comes towards them to make
    way.

    Each sees that person at one of the (n, 2) places ``seen``, metres.
    """
    for k in range(len(rows)):
        i, j = rows[k], blockers[k]
        if j == NOBODY or notes[j]["first"] == NOBODY or notes[j]["first"] == i:
            continue
        if _gets_on(i, elapsed, agenda, notes):
            continue
        to_x, to_y = notes[j]["x"] - state[j].x, notes[j]["y"] - state[j].y
        if to_x * (state[i].x - seen[k, 0]) + to_y * (state[i].y - seen[k, 1]) > 0.0:
            ask(i, notes[j]["first"], j, elapsed, state, notes)


@entry_point()
def resolve(
    rows: NDArray[np.int64],
    blockers: NDArray[np.int64],
    walled: NDArray[np.bool_],
    served: NDArray[np.bool_],
    elapsed: float,
    state: CrowdState,
    agenda: NDArray[np.void],
    notes: NDArray[np.void],
) -> None:
    """Find the rings of people of whom each blocks the next, and have one of each make way.

    In a ring, whoever comes first in the order goes first; the person in their way makes way.

    Args:
        rows: (n,) hindered people who do not make way.
        blockers: (n,) who is in the way of each, or -1.
        walled: (n,) whether each would not even move alone.
        served: (n,) whether others make way for each already.
        elapsed: seconds.
        state: the crowd.
        agenda: the same, with progress.
        notes: what is noted of everybody.
    """
    for k in range(len(rows)):
        notes[rows[k]]["blocker"] = blockers[k]
    for k in range(len(rows)):
        i, j = rows[k], blockers[k]
        if notes[i]["first"] != NOBODY:
            continue
        if walled[k]:
            notes[i]["first"], notes[i]["asked_by"] = i, i
            notes[i]["until"], notes[i]["sooner"] = elapsed + GIVES_UP, elapsed + LATER
            continue
        if served[k]:
            waited = elapsed - agenda[i]["since"]
            if min(waited, elapsed - notes[i]["served"]) <= GIVES_UP and waited <= LONGEST:
                if j != NOBODY:
                    ask(j, i, i, elapsed, state, notes)
                continue
            _give_up(i, elapsed, notes)
        if j == NOBODY:
            continue
        # A ring has no more members than there are people; a chain may lead into one.
        slow, fast = i, j
        while fast != NOBODY and fast != slow:
            slow, fast = _next(slow, notes), _next(_next(fast, notes), notes)
        if fast == NOBODY:
            continue
        first, at = fast, _next(fast, notes)
        while at != fast:
            if goes_before(at, first, elapsed, state, notes):
                first = at
            at = _next(at, notes)
        notes[first]["served"] = elapsed
        ask(notes[first]["blocker"], first, first, elapsed, state, notes)


@internal()
def _give_up(i: int, elapsed: float, notes: NDArray[np.void]) -> None:
    """Have person i come last, and those first who have found no room to make for them."""
    for other in range(len(notes)):
        if notes[other]["first"] == i:
            notes[other]["first"], notes[other]["later"] = NOBODY, elapsed
            if notes[other]["aside"] == 0:
                notes[other]["sooner"] = elapsed + LATER
    notes[i]["later"], notes[i]["sooner"] = elapsed + LATER, elapsed


@internal()
def _next(i: int, notes: NDArray[np.void]) -> int:
    """Who is in the way of person i, unless they make way; -1 for nobody."""
    return NOBODY if i == NOBODY or notes[i]["first"] != NOBODY else notes[i]["blocker"]


@entry_point()
def stop_making_way(
    rows: NDArray[np.int64], elapsed: float, state: CrowdState, notes: NDArray[np.void]
) -> None:
    """Let people stop making way when they no longer need to.

    Each person in ``rows`` stops if they have made way for long enough, or if the person they make
    way for has left or makes way for somebody else. Who is in their way is forgotten as well.
    """
    for i in rows:
        notes[i]["blocker"] = NOBODY
        first = notes[i]["first"]
        if first != NOBODY and (
            notes[i]["until"] < elapsed
            or not state[first].active
            or (notes[first]["first"] != NOBODY and notes[first]["first"] != first)
        ):
            notes[i]["first"] = NOBODY


def served_by(notes: NDArray[np.void], inside: NDArray[np.int64]) -> NDArray[Any]:
    """Rows of those for whom somebody inside makes way."""
    firsts = notes["first"][inside]
    return np.unique(firsts[firsts != NOBODY])
