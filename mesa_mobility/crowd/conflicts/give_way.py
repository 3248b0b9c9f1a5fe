"""Giving way: people who block each other make way in a fixed order.

People who take the cheapest free option block each other in a ring now and then: each is in the way
of another.  Waiting resolves no ring.  As in priority inheritance with backtracking (Okumura et
al., Artificial Intelligence 310, 2022), an order says who goes first.  Whoever is in their way
makes way, and so does, in turn, whoever is in the way of that.  Here people have bodies and
recorded movements instead of nodes of a graph.  So they leave a stretch of the way free, and
whoever has no room aside walks ahead along that way until there is some.  If nobody can make room,
the first comes last and makes way themselves.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.conflicts.hindrance import GETTING_NEARER, find_hindered, wait_behind
from mesa_mobility.crowd.conflicts.notes import (
    NOTE,
    NOTE_FIELDS,
    blank_notes,
    join,
    pass_on,
    resolve,
    served_by,
    stop_making_way,
)
from mesa_mobility.crowd.conflicts.places import (
    AHEAD,
    AROUND,
    CLEAR,
    Body,
    Way,
    distances_to_way,
    gets_straight,
    leaves_free,
    places_aside,
    places_to_set_out,
)
from mesa_mobility.crowd.hooks import World
from mesa_mobility.crowd.state.people_grid import build_grid
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.state.wishes import NOBODY, Wishes
from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.floorplan.floor.seams import to_own_sheets
from mesa_mobility.schema import Kind, Records

NEAR = 2.5
"""Metres from somebody who makes way within which others look whether they come towards them."""

SIDESTEP = 0.8
"""Highest speed of those who make way, m/s."""

ARRIVED = 0.1
"""Metres from the place at which somebody stands who makes way."""

FACES = 0.7
"""Cosine of the angle to their target from which on people face it."""

GAINED = 0.05
"""Metres by which a movement must lead nearer to somewhere for it to be a way there."""

BEYOND = 1.0
"""Metres by which those aim beyond a place who would rather stand than take so short a step, such
as people in wheelchairs. They stop once they are clear."""

LEGS = 3
"""Most straight pieces of the way that is left free."""

GOES_ON = 0.5
"""Seconds for which somebody goes on to make way whose own way still leads across the other's."""


class GiveWay(Tactic):
    """People who block each other make way in a fixed order.

    A person is hindered if they have made no progress for some seconds. Whoever would be hit first
    by the option that they would take alone blocks them (``World.wishes``). If people block each
    other in a ring, the one with the shortest route goes first, and the person in their way makes
    way: to the nearest place that leaves the next 4 m of that route free, or ahead along the route
    if there is none. Whoever is in the way of that makes way, too. People go on when their own way
    no longer leads across that of the first.
    """

    name = "giving_way"

    saved: ClassVar[Mapping[str, Kind]] = {"_notes": Records(NOTE, NOTE_FIELDS, ("known",))}

    def __init__(self) -> None:
        self._notes = blank_notes(0)

    def bind(self, model: World) -> None:
        """Keep the model, which knows what people would do alone."""
        self._model = model

    @property
    def making_way(self) -> list[int]:
        """Rows of those who make way, as noted at their last decision."""
        making: list[int] = np.flatnonzero(self._notes["first"] != NOBODY).tolist()
        return making

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Send those aside who make way."""
        if desired.newcomers:
            return
        rows, now, crowd = deciding.pedestrians, deciding.elapsed, deciding.inside.crowd
        if len(crowd.core) > len(self._notes):
            known, self._notes = self._notes, blank_notes(len(crowd.core))
            self._notes[: len(known)] = known
        notes = self._notes
        crowd.presses[rows] = 0
        hindered = np.zeros(len(rows), np.bool_)
        speeds = _speeds(deciding, desired)
        find_hindered(rows, speeds, now, crowd.records, crowd.agenda, hindered)
        if hindered.any():
            wait_behind(rows, now, deciding.inside.grid, crowd.records, crowd.agenda, hindered)
        if not hindered.any() and not (notes["first"][deciding.inside.pedestrians] >= 0).any():
            notes["blocker"][rows] = NOBODY
            return
        goes = ~deciding.waiting
        self._go_on(deciding, desired, np.flatnonzero(goes & (notes["first"][rows] != NOBODY)))
        stop_making_way(rows, now, crowd.records, notes)
        served = np.isin(rows, served_by(notes, deciding.inside.pedestrians))
        stays = notes["first"][rows] == NOBODY
        near = self._near_others(deciding) & stays & goes & ~(hindered | served)
        who = np.flatnonzero(near)
        if len(who):
            blockers = self._wishes(deciding, desired, who).blockers
            seen = deciding.inside.seen_by(rows[who], blockers)
            join(rows[who], blockers, seen, now, crowd.records, crowd.agenda, notes)
        who = np.flatnonzero((hindered | served) & goes & stays)
        if len(who):
            wishes = self._wishes(deciding, desired, who)
            aims = desired.targets.points[who]
            walled = (_gains(wishes, aims) < GAINED) & hindered[who]
            # People who do not face their target turn first.
            to = aims - deciding.positions[who]
            ahead = np.cos(np.arctan2(to[:, 1], to[:, 0]) - crowd.heading[rows[who]])
            walled &= ahead > FACES
            crowd.presses[rows[who]] = hindered[who] & ~walled & (wishes.blockers == NOBODY)
            resolve(
                rows[who],
                wishes.blockers,
                walled,
                served[who],
                now,
                crowd.records,
                crowd.agenda,
                notes,
            )
        who = np.flatnonzero(notes["first"][rows] != NOBODY)
        if len(who):
            self._make_way(who, deciding, desired)
            crowd.agenda["since"][rows[who]] = now

    def compile_ahead(self) -> None:
        """Compile the order, with nobody in conflict."""
        nobody, notes, crowd = np.empty(0, dtype=np.int64), blank_notes(2), Crowd(2)
        none, state, agenda = np.empty(0, dtype=np.bool_), crowd.records, crowd.agenda
        find_hindered(nobody, np.empty(0), 0.0, state, agenda, none)
        people = build_grid(nobody, crowd.x, crowd.y)
        wait_behind(nobody, 0.0, people, state, agenda, none)
        stop_making_way(nobody, 0.0, state, notes)
        join(nobody, nobody, np.empty((0, 2)), 0.0, state, agenda, notes)
        resolve(nobody, nobody, none, none, 0.0, state, agenda, notes)
        pass_on(nobody, nobody, 0.0, state, agenda, notes)

    def _wishes(self, deciding: Deciding, desired: Desired, who: NDArray[np.intp]) -> Wishes:
        """The wishes of some of those who decide, on their own way."""
        rows, speeds = deciding.pedestrians[who], _speeds(deciding, desired)[who]
        return self._model.wishes(rows, desired.targets.points[who], speeds)

    def _near_others(self, deciding: Deciding) -> NDArray[np.bool_]:
        """(n,) whether each is near somebody who makes way."""
        inside, crowd = deciding.inside.pedestrians, deciding.inside.crowd
        others = inside[self._notes["first"][inside] != NOBODY]
        others = deciding.inside.with_copies(others)
        to = deciding.positions[:, None] - np.column_stack([crowd.x[others], crowd.y[others]])
        return np.asarray((np.hypot(to[..., 0], to[..., 1]) < NEAR).any(axis=1))

    def _go_on(self, deciding: Deciding, desired: Desired, who: NDArray[np.intp]) -> None:
        """Let those go on making way whose own way still leads across that of the others, and those
        set out again who have gone back from a wall."""
        if len(who) == 0:
            return
        wishes, crowd = self._wishes(deciding, desired, who), deciding.inside.crowd
        self._set_out(deciding, desired.targets.points[who], who, wishes)
        firsts = self._ways_of_firsts(deciding.pedestrians[who], deciding)
        for k, row in enumerate(deciding.pedestrians[who].tolist()):
            path = wishes.paths[k, :, : wishes.pieces[k] + 1].T
            for other in self._ways(row, firsts, deciding):
                off, along = distances_to_way(path, other.points)
                if ((off < other.body.core + crowd.core[row]) & (along > 0.0)).any():
                    until = deciding.elapsed + GOES_ON
                    self._notes["until"][row] = max(self._notes["until"][row], until)

    def _set_out(
        self,
        deciding: Deciding,
        aims: NDArray[np.float64],
        who: NDArray[np.intp],
        wishes: Wishes,
    ) -> None:
        """Let those set out again who have gone back from a wall far enough: they would get on, and
        no wall is near their way. ``aims`` (n, 2) are their targets, metres."""
        rows, plan = deciding.pedestrians[who], deciding.site.plan
        back = np.flatnonzero(
            (self._notes["first"][rows] == rows) & (_gains(wishes, aims) >= GETTING_NEARER)
        )
        for k in back.tolist():
            me = _body(int(rows[k]), deciding)
            if gets_straight(plan, me, me.place[None], aims[[k]], me.core + CLEAR)[0]:
                self._notes["first"][rows[k]] = NOBODY

    def _make_way(self, who: NDArray[np.intp], deciding: Deciding, desired: Desired) -> None:
        """Set points and speeds of those who make way, and ask those who are in the way of that."""
        rows, crowd, notes = deciding.pedestrians[who], deciding.inside.crowd, self._notes
        points, speeds = desired.points.copy(), desired.speeds.copy()
        firsts = self._ways_of_firsts(rows, deciding)
        places = [self._places(row, firsts, deciding) for row in rows.tolist()]
        best = np.array(
            [
                each[0] if len(each) else here
                for each, here in zip(places, deciding.positions[who], strict=True)
            ]
        )
        own = np.minimum(crowd.agenda["speed"][rows], SIDESTEP)
        wishes = self._model.wishes(rows, best, own)
        blockers, goals = wishes.blockers.copy(), best.copy()
        short = _gains(wishes, best) < GAINED
        arrived = np.hypot(*(best - deciding.positions[who]).T) < ARRIVED
        for k in np.flatnonzero(short & ~arrived).tolist():
            # People who do not set off for so short a step aim beyond, or try other places.
            step = best[k] - deciding.positions[who[k]]
            beyond = best[k] + BEYOND / np.hypot(*step) * step
            others = np.concatenate([[beyond], places[k][1:]])
            copies = np.full(len(others), who[k])
            tried = self._model.wishes(
                deciding.pedestrians[copies], others, own[k].repeat(len(others))
            )
            moves = np.flatnonzero(_gains(tried, others) >= GAINED)
            at, short[k] = (moves[0], False) if len(moves) else (0, True)
            best[k], blockers[k] = others[at], tried.blockers[at]
            goals[k] = places[k][at]
        notes["x"][rows], notes["y"][rows] = best.T
        for row, place in zip(rows.tolist(), goals, strict=True):
            free = leaves_free(place[None], crowd.core[row], self._ways(row, firsts, deciding))
            notes["aside"][row] = free[0]
        points[who] = np.where(arrived[:, None], deciding.positions[who], best)
        speeds[who] = np.where(arrived, 0.0, own)
        desired.points, desired.speeds = points, speeds
        back = arrived & (notes["first"][rows] == rows)
        moving = ~arrived
        # The first has not failed yet while somebody still gets on with making room.
        gets_on = rows[moving & ~short & (blockers == NOBODY)]
        crowd.presses[gets_on] = 1
        notes["served"][notes["first"][gets_on]] = deciding.elapsed
        now, state, agenda = deciding.elapsed, crowd.records, crowd.agenda
        pass_on(rows[moving], blockers[moving], now, state, agenda, notes)
        notes["first"][rows[back]] = NOBODY

    def _places(
        self, row: int, firsts: Mapping[int, Way], deciding: Deciding
    ) -> NDArray[np.float64]:
        """(k, 2) where somebody may make way to, metres, the best place first."""
        crowd, everybody = deciding.inside.crowd, deciding.inside.pedestrians
        inside = deciding.inside.with_copies(everybody)
        me, ways = _body(row, deciding), self._ways(row, firsts, deciding)
        concerned = [row, self._notes["first"][row], self._notes["asked_by"][row]]
        reach = AROUND + me.core + crowd.core[inside].max()
        near = inside[
            (np.hypot(crowd.x[inside] - me.place[0], crowd.y[inside] - me.place[1]) < reach)
            & ~np.isin(deciding.inside.person_of(inside), concerned)
        ]
        places = np.column_stack([crowd.x[near], crowd.y[near]])
        # Nobody makes way to where somebody else does.
        who = deciding.inside.person_of(near)
        makes_way = self._notes["first"][who] != NOBODY
        others, who = near[makes_way], who[makes_way]
        wanted = np.column_stack([self._notes["x"][who], self._notes["y"][who]])
        wanted[:, 0] += crowd.x[others] - crowd.x[who]
        wanted[:, 1] += crowd.y[others] - crowd.y[who]
        taken = np.concatenate([places, wanted])
        cores = np.concatenate([crowd.core[near], crowd.core[others]])
        if not ways:
            to = crowd.destination[[row]].astype(np.int64)

            def aims(places: NDArray[np.float64]) -> NDArray[np.float64]:
                return deciding.site.targets(places, to.repeat(len(places))).points

            return places_to_set_out(deciding.site.plan, me, aims, taken, cores)
        return places_aside(deciding.site.plan, me, ways, taken, cores)

    def _ways_of_firsts(self, rows: NDArray[np.int64], deciding: Deciding) -> dict[int, Way]:
        """The ways of the people for whom others make way, by row."""
        firsts = self._notes["first"][rows]
        others = np.unique(firsts[firsts != rows]).tolist()
        return {each: Way(_body(each, deciding), _way(each, deciding)) for each in others}

    def _ways(self, row: int, firsts: Mapping[int, Way], deciding: Deciding) -> list[Way]:
        """The ways that somebody leaves free: of the first, and of who has asked them."""
        first, by = int(self._notes["first"][row]), int(self._notes["asked_by"][row])
        if first == row:
            return []
        ways = [_seen_by(row, first, firsts[first], deciding)]
        if self._notes["first"][by] == first and deciding.inside.crowd.active[by]:
            body = _body(by, deciding)
            to = np.array([self._notes["x"][by], self._notes["y"][by]])
            ways.append(_seen_by(row, by, Way(body, np.array([body.place, to])), deciding))
        return ways


def _speeds(deciding: Deciding, desired: Desired) -> NDArray[np.float64]:
    """(n,) how fast people want to walk where they are, m/s, if nobody has them stand."""
    own = deciding.inside.crowd.agenda["speed"][deciding.pedestrians]
    return np.where(desired.speeds > 0.0, np.minimum(desired.speeds, own), own)


def _gains(wishes: Wishes, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) metres by which people would get nearer to points (n, 2) alone."""
    ends = wishes.paths[np.arange(len(points)), :, wishes.pieces]
    gains: NDArray[np.float64] = np.hypot(*(wishes.paths[:, :, 0] - points).T)
    gains -= np.hypot(*(ends - points).T)
    return gains


def _body(row: int, deciding: Deciding) -> Body:
    crowd = deciding.inside.crowd
    place = np.array([crowd.x[row], crowd.y[row]])
    climbs = deciding.site.climbs(int(crowd.destination[row]))
    return Body(place, float(crowd.core[row]), climbs)


def _seen_by(row: int, other: int, way: Way, deciding: Deciding) -> Way:
    """The way of somebody as a person sees it, who may be on another sheet."""
    [seen] = deciding.inside.seen_by(np.array([row]), np.array([other]))
    shift = seen - way.body.place
    return Way(way.body._replace(place=seen), way.points + shift) if shift.any() else way


def _way(row: int, deciding: Deciding) -> NDArray[np.float64]:
    """(k, 2) points of the next metres of somebody's route."""
    crowd, left = deciding.inside.crowd, AHEAD
    way = [np.array([crowd.x[row], crowd.y[row]])]
    destination = crowd.destination[[row]].astype(np.int64)
    for _ in range(LEGS):
        own = way[-1][None] + to_own_sheets(way[-1][None], deciding.site.plan.seams)
        [step] = deciding.site.targets(own, destination).points - own
        length = float(np.hypot(*step))
        if length < 1e-6 or left <= 0.0:
            break
        way.append(way[-1] + step * min(1.0, left / length))
        left -= length
    return np.array(way if len(way) > 1 else way * 2)
