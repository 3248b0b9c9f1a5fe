"""Who is in whose way: chains and rings of people who block each other."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.conflicts.hindrance import GETTING_NEARER, SLOW_PATIENCE
from mesa_mobility.crowd.hooks import World
from mesa_mobility.crowd.journeys.waiting import waiting
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.running.last_minute import LastMinute, ways_left
from mesa_mobility.crowd.state.wishes import NOBODY

PATIENCE = 5
"""Seconds without progress after which somebody counts as blocked."""

SLOWEST = 1.0 / 60.0
"""Preferred speed, m/s, up to which somebody does not want to move."""


def want_to_move(rows: NDArray[np.int64], model: World) -> NDArray[np.bool_]:
    """(n,) whether people want to move and have a way: none of them waits on purpose."""
    crowd = model.crowd
    wants: NDArray[np.bool_] = np.isfinite(crowd.route[rows]) & ~waiting(rows, model.frame, crowd)
    wants &= crowd.agenda["speed"][rows] > SLOWEST
    return wants


def without_progress(
    rows: NDArray[np.int64], model: World, minute: LastMinute
) -> NDArray[np.bool_]:
    """(n,) whether people want to move, and have come no nearer to where they want to go for some
    seconds.

    Tactics note the last progress of people. Without such a tactic, what counts is how much nearer
    they have come in the last 5 s.
    """
    crowd, agenda = model.crowd, model.crowd.agenda
    wanted = np.maximum(agenda["speed"][rows], SLOWEST)
    patience = np.maximum(PATIENCE, SLOW_PATIENCE * GETTING_NEARER / wanted)
    free = agenda["waits_until"][rows] * FRAME_SECONDS
    since = np.maximum(agenda["since"][rows], free)
    stuck = model.elapsed - since > patience
    noted = np.isfinite(agenda["nearest"][rows])
    if not noted.all():
        before = minute.at(int(model.elapsed) - PATIENCE)
        gained = np.full(len(rows), np.inf)
        if before is not None:
            least = np.minimum(GETTING_NEARER, wanted * PATIENCE / SLOW_PATIENCE)
            with np.errstate(invalid="ignore"):  # nobody comes nearer without a way
                gained = (before.of(rows)[2] - ways_left(rows, crowd)) / least
        stuck = np.where(noted, stuck, gained < 1.0)
    found: NDArray[np.bool_] = stuck & want_to_move(rows, model)
    return found


class Blockers:
    """Who is in the way of whom at one moment; each is asked for once.

    Args:
        model: the model.
        minute: where people have been.
    """

    def __init__(self, model: World, minute: LastMinute) -> None:
        self._model, self._minute = model, minute
        self._known: dict[int, int] = {}

    def of(self, rows: Iterable[int]) -> Mapping[int, int]:
        """Who is in the way of people, and of those in turn, by row; ``NOBODY`` is in the way of
        those who get on."""
        asked = [row for row in rows if row not in self._known]
        while asked:
            them = np.array(sorted(set(asked)), dtype=np.int64)
            stuck = without_progress(them, self._model, self._minute)
            self._known |= dict.fromkeys(them.tolist(), NOBODY)
            if stuck.any():
                blockers = self._model.wishes(them[stuck]).blockers.tolist()
                self._known |= zip(them[stuck].tolist(), blockers, strict=True)
            inside = self._model.crowd.active
            found = {self._known[row] for row in them.tolist()} - self._known.keys() - {NOBODY}
            # Nobody is in the way of those who have just gone.
            self._known |= {row: NOBODY for row in found if not inside[row]}
            asked = [row for row in found if inside[row]]
        return self._known

    def chain(self, row: int) -> list[int]:
        """The person in the way of somebody, the one in the way of that person, and so on; see
        ``PedestrianModel.blocked_by``."""
        known, chain, met = self.of([row]), list[int](), {row}
        while (row := known[row]) != NOBODY:
            chain.append(row)
            if row in met:
                break
            met.add(row)
        return chain

    def rings(self, rows: Sequence[int]) -> list[list[int]]:
        """The rings of people to which those in ``rows`` belong or whose chains end in them, each
        from its first row on."""
        found: dict[int, list[int]] = {}
        for row in rows:
            ring = ring_of(row, self.chain(row))
            if ring:
                at = ring.index(min(ring))
                found[ring[at]] = ring[at:] + ring[:at]
        return [found[row] for row in sorted(found)]


def ring_of(row: int, chain: Sequence[int]) -> list[int]:
    """The people of a chain who block each other in a ring; none where it ends in somebody who is
    in nobody's way or gets on."""
    whole = [row, *chain]
    first = whole.index(whole[-1])
    return whole[first:-1]


def in_words(rows: Sequence[int]) -> str:
    """A list of people."""
    texts = [str(row) for row in rows]
    return texts[0] if len(texts) == 1 else f"{', '.join(texts[:-1])} and {texts[-1]}"
