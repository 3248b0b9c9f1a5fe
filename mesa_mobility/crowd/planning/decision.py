"""The decision: a pedestrian takes the cheapest option that hits nothing."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point, inlined
from mesa_mobility.compiled.simd import AT_ONCE, place_of_least
from mesa_mobility.crowd.collision.broad_phase import cull_groups
from mesa_mobility.crowd.collision.exact import exit_distance, near_walls, wall_reach
from mesa_mobility.crowd.collision.sampled import Decider
from mesa_mobility.crowd.collision.walls import Barriers, walls_to_ego
from mesa_mobility.crowd.options.table import SAMPLE_FRAMES
from mesa_mobility.crowd.planning.branch_and_bound import CROWD, FEW, NONE, cheapest_free
from mesa_mobility.crowd.planning.evaluation.lanes import least
from mesa_mobility.crowd.planning.evaluation.opened_groups import NOT_A_NUMBER
from mesa_mobility.crowd.planning.evaluation.option_costs import group_bounds
from mesa_mobility.crowd.planning.evaluation.relevant_neighbours import (
    mark_relevant,
    select_relevant,
)
from mesa_mobility.crowd.planning.fallback import FALLBACK_SECONDS, fall_back
from mesa_mobility.crowd.planning.feasibility import Obstacles
from mesa_mobility.crowd.planning.following import follow
from mesa_mobility.crowd.planning.grid import place_in
from mesa_mobility.crowd.planning.neighbours import gather_neighbours
from mesa_mobility.crowd.planning.thread_queue import NOBODY_LEFT, Queue, give_back, take
from mesa_mobility.crowd.planning.workspace import DecisionContext, FrameContext, Workspace
from mesa_mobility.crowd.state.clearances import MARGIN
from mesa_mobility.crowd.state.paths import commit, to_world
from mesa_mobility.crowd.state.people_grid import cover_in


@entry_point()
def decide(
    rows: NDArray[np.int64],
    queue: Queue,
    scene: FrameContext,
    extra: NDArray[np.float64],
    extra_offsets: NDArray[np.int64],
    work: Workspace,
) -> int:
    """Decide for the pedestrians in ``rows``, one after the other, and commit them.

    Costs see the crowd as it was when the frame began. Collision tests see the paths to which
    pedestrians before have been committed. Several threads may share the work (see `take`).

    Args:
        rows: pedestrians, in the order in which they decide.
        queue: shared by all threads, new.
        scene: the frame.
        extra: weighted costs of the NumPy terms, options of each pedestrian in turn, or
            empty.
        extra_offsets: (len(rows) + 1,) where each pedestrian's part of ``extra`` starts.
        work: workspace of this thread.

    Returns:
        Index in ``rows`` of a pedestrian for whom a cost was not a number, or ``len(rows)``.  The
        least over all threads is the first such pedestrian.
    """
    terms = scene.terms
    has_negative_pairs = False
    for kind in range(len(terms.pair.weight)):
        lowest = min(least(terms.pair.weight[kind]), least(terms.wall.weight[kind]))
        has_negative_pairs = has_negative_pairs or lowest < 0.0
    bounded = len(extra) == 0 and not has_negative_pairs
    for address in terms.bound.address:
        bounded = bounded and address != 0
    failed = len(rows)
    d, first = take(0, rows, queue, scene)
    while d != NOBODY_LEFT:
        own_extra = extra
        if len(extra) > 0:
            own_extra = extra[extra_offsets[d] : extra_offsets[d + 1]]
        fine = _decide_one(rows[d], scene, own_extra, has_negative_pairs, bounded, work)
        if not fine:
            failed = min(failed, d)
        give_back(d, fine, queue)
        d, first = take(first, rows, queue, scene)
    return failed


class Situation(NamedTuple):
    """The surroundings of a pedestrian who decides.

    Attributes:
        me: the pedestrian.
        place: their place in the grid.
        neighbours: number of columns of ``Neighbours.others``.
        walls: walls within reach, with squared distances.
        barriers: those that do not touch the body, in the pedestrian's coordinates.
        exits_from: metres to the nearest open exit.
        farthest: metres that the longest option covers.
    """

    me: Decider
    place: int
    neighbours: int
    walls: NDArray[np.float64]
    barriers: Barriers
    exits_from: float
    farthest: float


@inlined()
def _decide_one(
    i: int,
    scene: FrameContext,
    extra: NDArray[np.float64],
    has_negative_pairs: bool,
    bounded: bool,
    work: Workspace,
) -> bool:
    """Decide for pedestrian i and commit them to a path; False if a cost is not a number.

    Four stages: gather what is around, bound the costs of groups of options, search for the
    cheapest option that hits nothing, and commit the pedestrian to it.
    """
    around = _gather(i, scene, work)
    left = _drop_blocked(around, scene, work)
    option, gone = NONE, -1
    if left > 0:
        fine, now = _bound(around, left, scene, extra, has_negative_pairs, bounded, work)
        if not fine:
            return False
        approximate = bounded and mark_relevant(now, scene.groups, scene.terms.pair, work)
        option, gone = cheapest_free(now, approximate, scene, work)
        if option == NOT_A_NUMBER:
            return False
    _commit(around, option, gone, scene, work)
    return True


@inlined()
def _gather(i: int, scene: FrameContext, work: Workspace) -> Situation:
    """The people, walls and exits around pedestrian i; writes neighbours and walls to ``work``."""
    state = scene.state
    x, y, core = state.x[i], state.y[i], state.core[i]
    # The box that the options and the fallback can reach.
    aside = state.preferred[i] * FALLBACK_SECONDS
    whole = scene.groups.clusters[state.cluster[i]].whole
    x0, y0 = min(whole[0], -aside), min(whole[1], -aside)
    box = x0, y0, max(whole[2], aside), max(whole[3], aside)
    place = place_in(scene.grid, x, y, i)
    me, count = gather_neighbours(i, place, box, scene, work.neighbours)
    destination, farthest = state.destination[i], scene.table.farthest[state.cluster[i]]
    reach = wall_reach(farthest, core)
    walls = work.walls[: near_walls(scene.around, x, y, destination, reach, work.walls)]
    n_clear = walls_to_ego(me, walls, farthest, core + MARGIN, work.barriers)
    barriers = Barriers(work.barriers, n_clear)
    exits_from = exit_distance(scene.around, x, y, destination)
    return Situation(me, place, count, walls, barriers, exits_from, farthest)


@inlined()
def _drop_blocked(around: Situation, scene: FrameContext, work: Workspace) -> int:
    """Mark the groups of options that certainly hit something; returns how many are left."""
    return cull_groups(
        around.me,
        work.neighbours.close,
        around.barriers,
        around.exits_from,
        scene.groups,
        scene.state,
        work.blocks,
    )


@inlined()
def _bound(
    around: Situation,
    left: int,
    scene: FrameContext,
    extra: NDArray[np.float64],
    has_negative_pairs: bool,
    bounded: bool,
    work: Workspace,
) -> tuple[bool, DecisionContext]:
    """Lower bounds of the costs in groups of options; whether all are numbers, and the search."""
    me, count, terms = around.me, around.neighbours, scene.terms
    spanned = scene.groups.clusters[scene.state.cluster[me.row]]
    bounds, dropped = work.bounds[: spanned.last - spanned.first], work.blocks.dropped
    bounds[:] = 0.0
    if bounded:
        group_bounds(me, spanned.first, scene.groups, terms.bound, work.opened.ends, bounds)
    foremost = 0
    if not has_negative_pairs and len(terms.pair.address) > 0:
        foremost = select_relevant(me, count, work.neighbours)
    bad = 0
    for a in range(len(bounds)):
        bad |= int(dropped[a] == 0) & int(not abs(bounds[a]) < np.inf)
        bounds[a] = np.inf if dropped[a] != 0 else bounds[a]
    # Padding: bounds are read this many at a time.
    work.bounds[len(bounds) : len(bounds) + AT_ONCE] = np.inf
    now = DecisionContext(
        me,
        spanned.first,
        bounds,
        bounds[place_of_least(work.bounds, len(bounds))],
        around.walls,
        extra,
        around.barriers,
        # In a jam most people stay where they are, or nearly so.
        spanned.stay if foremost >= CROWD else -1,
        count,
        foremost,
        around.exits_from,
        has_negative_pairs,
        bounded and left > FEW,
    )
    return bad == 0, now


@inlined()
def _commit(
    around: Situation, option: int, gone: int, scene: FrameContext, work: Workspace
) -> None:
    """Commit an option, or the fallback where there is none."""
    i, state = around.me.row, scene.state
    state.decisions[i] += 1
    if option >= 0:
        pieces = to_world(i, option, around.me.c, around.me.s, scene.table, state, work.path)
        commit(
            i,
            option,
            scene.frame,
            pieces,
            np.int64(SAMPLE_FRAMES),
            gone,
            np.int32(scene.table.options[option].cluster),
            work.path,
            state,
        )
    else:
        standing = scene.rules.standing[state.type_index[i]]
        close, near, count = work.neighbours.close, work.unsure, work.neighbours.close.known[0]
        for a in range(count):
            near[a] = close.who[a]
        for a in range(close.known[1], len(close.who)):
            near[count] = close.who[a]
            count += 1
        leaves = around.exits_from <= around.farthest
        obstacles = Obstacles(
            around.walls, scene.around, near[:count], leaves, scene.rules.hard_bodies
        )
        fall_back(i, scene.frame, scene.table, state, obstacles, standing, work.path)
    cover_in(scene.grid, around.place, i, state)
    if len(scene.twins.follow) > 0:
        follow(i, scene)
