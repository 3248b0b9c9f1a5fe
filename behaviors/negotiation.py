"""Who gives way where two parties meet in a corridor."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np
from mesa_mobility.behaviors.corridors import BEYOND, Corridor
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from mesa_mobility.schema import Array, Kind, Real, Whole

AHEAD = 1.0
"""Metres ahead at which people's ways tell which way they go through a corridor."""

TURNS = 0.05
"""Metres along the corridor by which that has to differ."""

ENTERS = 1.0
"""Metres from an end of a corridor within which the targets of those lie who are about to enter."""

PROGRESS = 0.25
"""Metres that all together must come nearer to where they go for it to count as progress."""

STUCK = 10.0
"""Seconds without progress after which the others give way."""

STOPS = 2.5
"""Metres in which a walker comes to a halt: the longest movement at walking speed."""

OFF = 0.45
"""Metres aside of the way from which on somebody leaves it to others."""

_NOBODY = np.empty(0, dtype=np.int64)


class Party(NamedTuple):
    """The n people who go through a corridor, or negotiate there.

    Fields: ``rows`` (n,) their rows; ``courses`` (n,) which way they go, 1, -1 or 0; ``along`` (n,)
    where they are along the way, and ``aside`` (n,) how far from it, metres, NaN for those who are
    neither in it nor before it; ``within`` (n,) whether they are in the corridor.
    """

    rows: NDArray[np.int64]
    courses: NDArray[np.int64]
    along: NDArray[np.float64]
    aside: NDArray[np.float64]
    within: NDArray[np.bool_]

    def of(self, rows: NDArray[np.int64]) -> Party:
        """Those of them with these rows."""
        return self.chosen(np.isin(self.rows, rows))

    def chosen(self, which: NDArray[np.bool_]) -> Party:
        """Some of them."""
        return Party(
            self.rows[which],
            self.courses[which],
            self.along[which],
            self.aside[which],
            self.within[which],
        )


@dataclass
class Negotiation:
    """What has been agreed upon in a corridor.

    Attributes:
        sense: 1 or -1, the way that those go who have precedence.
        going: rows of those.
        giving: rows of those who give way to them.
        places: index of the place to which each of these goes.
        least: metres that all together had left to go at their last progress.
        since: time of that, s.
    """

    sense: int
    going: NDArray[np.int64]
    giving: NDArray[np.int64]
    places: NDArray[np.int64]
    least: float
    since: float

    @staticmethod
    def members() -> dict[str, Kind]:
        """What the members of ``state`` are."""
        return {
            "sense": Whole(-1, 1),
            "going": Array("i8", low=0, below="people"),
            "giving": Array("i8", ("giving",), low=0, below="people"),
            "places": Array("i8", ("giving",), low=0),
            "least": Real(0.0, infinite=True),
            "since": Real(0.0),
        }

    def state(self) -> dict[str, Any]:
        """Its attributes."""
        return asdict(self)


def agree(
    before: Negotiation | None, corridor: Corridor, people: Party, elapsed: float, sight: float
) -> Negotiation | None:
    """Begin or continue a negotiation about who goes first through a corridor.

    Args:
        before: the negotiation so far; None if there is none.
        corridor: the corridor.
        people: the people who go through it.
        elapsed: simulated time, seconds.
        sight: metres along the way at which people see others come towards them.

    Returns:
        The negotiation now; None if nobody has to give way.
    """
    if before is None:
        return _meet(corridor, people, elapsed, sight)
    return _go_on(before, corridor, people, elapsed)


def _meet(corridor: Corridor, people: Party, elapsed: float, sight: float) -> Negotiation | None:
    """A new negotiation, if two people see each other come and either party can give way."""
    up = people.chosen(people.within & (people.courses > 0))
    down = people.chosen(people.within & (people.courses < 0))
    if len(up.rows) == 0 or len(down.rows) == 0:
        return None
    gaps = down.along[None, :] - up.along[:, None]
    gaps[gaps < 0.0] = np.inf
    if gaps.min() > sight:
        return None
    one, other = np.unravel_index(gaps.argmin(), gaps.shape)
    middle = float(up.along[one] + down.along[other]) / 2.0
    up, down = up.chosen(up.along <= middle), down.chosen(down.along >= middle)
    back_up, back_down = _places(corridor, up, 1, down), _places(corridor, down, -1, up)
    if back_up is None and back_down is None:
        return None
    up_gives = back_down is None or (
        back_up is not None and (back_up[1], len(up.rows)) <= (back_down[1], len(down.rows))
    )
    giving, going, back = (up, down, back_up) if up_gives else (down, up, back_down)
    assert back is not None
    return Negotiation(-1 if up_gives else 1, going.rows, giving.rows, back[0], np.inf, elapsed)


def _places(
    corridor: Corridor, party: Party, course: int, others: Party
) -> tuple[NDArray[np.int64], float] | None:
    """Places for people who go one way before ``others``, and the metres they walk in all; None
    if there are too few.

    They are those with the least metres in all. Nobody has to pass another: people take
    them in the order in which they stand. If they are between the two parties, the others can stop
    before them.
    """
    front, nearest = (course * party.along).max(), (course * others.along).min()
    limit = nearest - min(STOPS, max(nearest - front, 0.0) / 2.0)
    candidates = np.flatnonzero(course * corridor.places_along <= limit)
    if len(candidates) < len(party.rows):
        return None
    metres = np.abs(corridor.places_along[candidates][None, :] - party.along[:, None])
    metres += np.abs(corridor.places_aside[candidates][None, :] - party.aside[:, None])
    people, chosen = linear_sum_assignment(metres)
    total = float(metres[people, chosen].sum())
    chosen = candidates[chosen]
    # Of places abreast, the one farthest from the way goes to the one who comes first.
    order = np.lexsort((-course * corridor.places_aside[chosen], corridor.places_along[chosen]))
    places = np.empty(len(party.rows), dtype=np.int64)
    places[np.argsort(party.along, kind="stable")] = chosen[order]
    return places, total


def _go_on(
    before: Negotiation, corridor: Corridor, people: Party, elapsed: float
) -> Negotiation | None:
    """What is agreed upon next: as before, unless those who had precedence are through."""
    sense = before.sense
    going = people.of(before.going)
    passed = np.where(going.courses == sense, sense * going.along, np.inf)
    far = corridor.length if sense > 0 else 0.0
    going = going.chosen(going.within | (passed < far))
    giving = people.of(before.giving)
    places = before.places[np.isin(before.giving, giving.rows)]
    known = np.isin(people.rows, before.going) | np.isin(people.rows, before.giving)
    late = people.within & ~known
    if len(going.rows) == 0:
        going, giving, places, sense = giving, going, _NOBODY, -sense
    if (late & (people.courses == sense)).any():
        going = people.of(np.append(going.rows, people.rows[late & (people.courses == sense)]))
    if len(going.rows) == 0:
        return None
    if (late & (people.courses == -sense)).any():
        giving = people.of(np.append(giving.rows, people.rows[late & (people.courses == -sense)]))
        found = _places(corridor, giving, -sense, going)
        if found is None:
            return None
        places = found[0]
    now = Negotiation(sense, going.rows, giving.rows, places, before.least, before.since)
    if len(known) != len(people.rows) or sense != before.sense or late.any():
        now.least, now.since = np.inf, elapsed
    if len(giving.rows) and (going.within & (going.aside >= OFF)).all():
        return _change_sides(now, corridor, going, giving, elapsed)
    left = _left_to_go(corridor, going, giving, sense, places)
    if left < now.least - PROGRESS:
        now.least, now.since = left, elapsed
    elif elapsed - now.since > STUCK:
        return _change_sides(now, corridor, going, giving, elapsed)
    return now


def _left_to_go(
    corridor: Corridor, going: Party, giving: Party, sense: int, places: NDArray[np.int64]
) -> float:
    """Metres that all together have left to go."""
    end = corridor.length if sense > 0 else 0.0
    back = np.abs(giving.along - corridor.places_along[places])
    return float(np.nansum(np.maximum(sense * (end - going.along), 0.0)) + np.nansum(back))


def _change_sides(
    now: Negotiation, corridor: Corridor, going: Party, giving: Party, elapsed: float
) -> Negotiation | None:
    """Those who have had precedence give way; None if they cannot."""
    if len(giving.rows) == 0:
        return None
    found = _places(corridor, going, now.sense, giving)
    if found is None:
        return None
    return Negotiation(-now.sense, giving.rows, going.rows, found[0], np.inf, elapsed)


def courses_of(
    corridor: Corridor,
    positions: NDArray[np.float64],
    targets: NDArray[np.float64],
    along: NDArray[np.float64],
    within: NDArray[np.bool_],
    before: NDArray[np.int8],
) -> NDArray[np.int64]:
    """(n,) which way people go through a corridor: 1, -1, or 0 for neither.

    Those within go on as ``before`` if their way does not tell.
    """
    way = targets - positions
    distance = np.maximum(np.hypot(*way.T), 1e-9)
    ahead, _, _ = corridor.locate(positions + way * np.minimum(AHEAD / distance, 1.0)[:, None])
    change = np.nan_to_num(ahead - along)
    through = np.where(np.abs(change) > TURNS, np.sign(change), before)
    inward = np.where(along < corridor.length / 2.0, 1, -1)
    return np.where(within, through, np.where(_enters(corridor, positions, targets), inward, 0))


def _enters(
    corridor: Corridor, positions: NDArray[np.float64], targets: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(n,) whether the straight ways to targets lead into a corridor, or right before it."""
    along, aside, _ = corridor.locate(targets)
    outside = np.maximum(-along, along - corridor.length)
    enters = (outside < ENTERS) & (aside < ENTERS)
    way = targets - positions
    distance = np.maximum(np.hypot(*way.T), 1e-9)
    for share in np.linspace(0.0, BEYOND, 40):
        _, _, within = corridor.locate(positions + way * np.minimum(share / distance, 1.0)[:, None])
        enters |= within
    return enters
