"""The choice: whoever's movement has ended takes the cheapest option that hits nothing."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.barriers import lay_barriers
from mesa_mobility.crowd.clearing import free_groups
from mesa_mobility.crowd.close import Stance, find_close
from mesa_mobility.crowd.collision import MARGIN, Surroundings, exit_distance, near_walls
from mesa_mobility.crowd.costs import LEAD, Terms, group_bounds
from mesa_mobility.crowd.fallback import FALLBACK_SECONDS, fall_back
from mesa_mobility.crowd.groups import OptionGroups
from mesa_mobility.crowd.motion import commit, lay_path
from mesa_mobility.crowd.neighbours import Grid, cover_in, neighbours_within, place_in
from mesa_mobility.crowd.options import SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.pairs import fill_lane, least, mark_counting, pick_foremost
from mesa_mobility.crowd.queue import Queue, await_neighbours
from mesa_mobility.crowd.rules import Rules
from mesa_mobility.crowd.search import CROWD, FEW, NONE, NOT_A_NUMBER, cheapest_free
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.crowd.work import Setting, Work
from mesa_mobility.jit import called, woven
from mesa_mobility.lanes import AT_ONCE, place_of_least
from mesa_mobility.machine import take_number, tell


@called()
def decide(
    rows: NDArray[np.int64],
    queue: Queue,
    frame: int,
    table: OptionTable,
    groups: OptionGroups,
    state: CrowdState,
    grid: Grid,
    around: Surroundings,
    terms: Terms,
    extra: NDArray[np.float64],
    extra_offsets: NDArray[np.int64],
    rules: Rules,
    moving: NDArray[np.float64],
    work: Work,
) -> int:
    """Decide for the pedestrians in ``rows``, one after the other, and commit them.

    Costs see the crowd as it was when the frame began; collisions see what
    those before have committed to.  Several threads may share the work: each takes the next
    pedestrian in turn, and waits for those before whom that one could meet.

    Args:
        rows: pedestrians, in the order in which they decide.
        queue: the same of all threads, as new.
        frame: now.
        table: options of all capabilities.
        groups: what the groups of these options span.
        state: the crowd; targets must be set.
        grid: neighbours' grid of this frame.
        around: walls and exits.
        terms: compiled terms.
        extra: weighted cost of the terms that are not compiled, options of each
            pedestrian in turn, or empty.
        extra_offsets: (len(rows) + 1,) where each pedestrian's part of ``extra`` starts.
        rules: what holds for everybody.
        moving: (8, people) velocities, directions and ways at the beginning of the frame, in
            the order of the grid: terms see them as they were, also of those who have just
            decided; and what people cover, which is kept up to date.
        work: space to work in, of this thread alone.

    Returns:
        Place in ``rows`` of a pedestrian for whom a cost was not a number, or their number. The
        least that any thread returns is the first such pedestrian.
    """
    eager = least(terms.pair_weight) < 0.0
    bounded = len(extra) == 0 and not eager
    for address in terms.bound_address:
        bounded = bounded and address != 0
    n = len(rows)
    before = np.int64(0)
    while True:
        d = take_number(queue.next, 0)
        if d >= n:
            return n
        before = await_neighbours(d, before, rows, queue, state, rules.search_radius)
        own_extra = extra
        if len(extra) > 0:
            own_extra = extra[extra_offsets[d] : extra_offsets[d + 1]]
        fine = _decide_one(
            rows[d], frame, table, groups, state, grid, around, terms, own_extra, rules, moving,
            eager, bounded, work,
        )  # fmt: skip
        tell(queue.done, d, 1)
        if not fine:
            tell(queue.next, 0, n)
            return d


@woven()
def _decide_one(
    i: int,
    frame: int,
    table: OptionTable,
    groups: OptionGroups,
    state: CrowdState,
    grid: Grid,
    around: Surroundings,
    terms: Terms,
    extra: NDArray[np.float64],
    rules: Rules,
    moving: NDArray[np.float64],
    eager: bool,
    bounded: bool,
    work: Work,
) -> bool:
    """Decide for pedestrian i and commit it; False if a cost is not a number."""
    cluster, destination = state.cluster[i], state.destination[i]
    x, y, heading, core = state.x[i], state.y[i], state.heading[i], state.core[i]
    me = Stance(i, x, y, math.cos(heading), math.sin(heading), core)
    others, sweeps, place = work.others, work.sweeps, place_in(grid, x, y, i)
    count = neighbours_within(
        grid, moving, x, y, place, rules.search_radius, work.near, others, sweeps
    )
    near = work.near[:count]
    route, lead = state.route[i], others[LEAD]
    for a in range(count):
        lead[a] = route - lead[a]
    fill_lane(count, others)
    farthest = table.farthest[cluster]
    walls = work.walls[: near_walls(around, x, y, destination, farthest + core + 0.01, work.walls)]
    firm = lay_barriers(me, walls, farthest, core + MARGIN, work.barriers)
    exits_from = exit_distance(around, x, y, destination)
    # What the options cover, and what the fallback may.
    aside = state.preferred[i] * FALLBACK_SECONDS
    spanned = groups.clusters[cluster]
    whole = spanned.whole
    found, touching = find_close(
        me, near if rules.cores else near[:0], sweeps, min(whole[0], -aside),
        min(whole[1], -aside), max(whole[2], aside), max(whole[3], aside), state, work.unsure,
        work.dropped, work.close,
    )  # fmt: skip
    n = free_groups(
        me, frame, work.close, found, work.barriers, firm, exits_from, table, groups, state,
        work.bodies, work.fences, work.blocked,
    )  # fmt: skip
    option, gone = NONE, -1
    if n > 0:
        first, last = spanned.first, spanned.last
        bounds, dropped = work.bounds[: last - first], work.blocked
        bounds[:] = 0.0
        if bounded:
            group_bounds(me, first, last, groups, state, terms, work.ends, bounds)
        bad = 0
        for a in range(len(bounds)):
            bad |= int(dropped[a] == 0) & int(not abs(bounds[a]) < np.inf)
            bounds[a] = np.inf if dropped[a] != 0 else bounds[a]
        if bad != 0:
            return False
        # So many are looked at at once.
        work.bounds[len(bounds) : len(bounds) + AT_ONCE] = np.inf
        lowest = bounds[place_of_least(work.bounds, len(bounds))]
        foremost = 0
        if not eager and len(terms.pair_address) > 0:
            foremost = pick_foremost(
                me, others, count, state, work.unsure, work.dropped, work.foremost
            )
        rough = bounded and mark_counting(
            me, first, bounds, lowest, work.ends, groups, foremost, work.foremost, state, terms,
            work.picked, work.marks,
        )  # fmt: skip
        ranked = bounded and n > FEW
        # In a jam most stay where they are, or hardly go on.
        stay = spanned.stay if foremost >= CROWD else -1
        setting = Setting(
            frame, firm, stay, found, touching, count, foremost, rough, exits_from, eager, ranked
        )
        option, gone = cheapest_free(
            me, setting, first, bounds, lowest, walls, extra, rules.cores, table, groups, state,
            around, terms, work,
        )  # fmt: skip
        if option == NOT_A_NUMBER:
            return False
    state.decisions[i] += 1
    if option >= 0:
        pieces = lay_path(i, option, me.c, me.s, table, state, work.path)
        commit(
            i,
            option,
            frame,
            pieces,
            np.int64(SAMPLE_FRAMES),
            gone,
            np.int32(table.options[option].cluster),
            work.path,
            state,
        )
    else:
        standing = rules.standing[state.kind[i]]
        people, near = work.close.people, work.unsure
        for a in range(found):
            near[a] = people[a].who
        for a in range(touching, len(people)):
            near[found] = people[a].who
            found += 1
        fall_back(
            i, frame, table, state, walls, around, near[:found], exits_from <= farthest,
            rules.cores, standing, work.path,
        )  # fmt: skip
    cover_in(moving, place, i, state)
    return True
