"""Context and scratch arrays of a decision."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.simd import AT_ONCE, LANES, WIDE
from mesa_mobility.crowd.collision.broad_phase import Blocks, Bodies, Fences
from mesa_mobility.crowd.collision.sampled import Close, Decider, make_close
from mesa_mobility.crowd.collision.walls import BARRIER_FIELDS, Barriers
from mesa_mobility.crowd.costs.layout import FIELDS, SPEED, Terms
from mesa_mobility.crowd.options.option_groups import OptionGroups
from mesa_mobility.crowd.options.table import LEVELS, SAMPLES, OptionTable
from mesa_mobility.crowd.state.people_grid import Grid
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.crowd.state.surroundings import Surroundings
from mesa_mobility.crowd.state.twins import Twins


class Rules(NamedTuple):
    """Constants of the model.

    Attributes:
        search_radius: metres within which people may get in each other's way.
        interaction_ranges: (types, types) metres within which others count in the cost terms of
            somebody who decides: the farthest from which a movement of each can bring them
            together. Rows are the type of who decides, columns that of the other.
        hard_bodies: whether bodies may not overlap.
        standing: (maps,) standing cluster of each map; first come the maps of the types.
        first_option: (maps,) first row of each map in the table.
    """

    search_radius: float
    interaction_ranges: NDArray[np.float64]
    hard_bodies: bool
    standing: NDArray[np.int32]
    first_option: NDArray[np.int64]


class FrameContext(NamedTuple):
    """What all decisions of a frame share.

    Attributes:
        frame: now.
        table: options of all capabilities.
        groups: these options in groups, with the extent of each.
        state: the crowd; targets must be set.
        grid: the people in this frame.
        around: walls and exits.
        terms: compiled terms.
        rules: the model's constants.
        twins: the twins in this frame.
    """

    frame: int
    table: OptionTable
    groups: OptionGroups
    state: CrowdState
    grid: Grid
    around: Surroundings
    terms: Terms
    rules: Rules
    twins: Twins


class DecisionContext(NamedTuple):
    """The inputs of the search for one decision.

    Attributes:
        me: the pedestrian.
        first: the first group of the pedestrian's cluster.
        bounds: lower bound of the costs in each group from there on; inf where all options are
            certainly blocked.
        lowest: the least of these bounds.
        walls: walls within reach, with squared distances.
        extra: weighted costs of the NumPy terms, or empty.
        barriers: walls that do not touch the body, in the pedestrian's coordinates.
        stay: the group to test first, or -1.
        neighbours: number of columns of ``Neighbours.others``.
        foremost: number of the first of these columns, people who are likely to cost most.
        exits_from: metres to the nearest open exit.
        has_negative_pairs: whether pair or wall terms may be negative, so that every option needs
            them.
        ranked: whether groups are opened in rising order of their bounds.
    """

    me: Decider
    first: int
    bounds: NDArray[np.float64]
    lowest: float
    walls: NDArray[np.float64]
    extra: NDArray[np.float64]
    barriers: Barriers
    stay: int
    neighbours: int
    foremost: int
    exits_from: float
    has_negative_pairs: bool
    ranked: bool


class Neighbours(NamedTuple):
    """Who decides, and the people around: all that a decision reads of them.

    Attributes:
        own: (9 + fields,) who decides, as cost terms read it; fields as in ``costs.layout``.
        near: places in the grid of those whose paths may lead to where the pedestrian may walk.
        close: their movements in the pedestrian's coordinates.
        rows: rows in the crowd of those who count in cost terms.
        others: (9 + fields of others, n) the same as cost terms read them, first those likely to
            cost most.
        moved: for each of these, the column with which it has changed places, one after the other.
        marks: for each of these, bits of the pair terms that it matters to.
        marked: their columns that matter to one pair term.
        first: (1,) the pair term to evaluate first.
    """

    own: NDArray[np.float64]
    near: NDArray[np.int64]
    close: Close
    rows: NDArray[np.int64]
    others: NDArray[np.float64]
    moved: NDArray[np.int64]
    marks: NDArray[np.int64]
    marked: NDArray[np.int64]
    first: NDArray[np.int64]


class Opened(NamedTuple):
    """Groups and options that the search has opened.

    Attributes:
        picked: groups just opened.
        free: bits of their options that hit nobody in the sampled test.
        lanes: ends of the 8 options of each group.
        lane_costs: their costs.
        rows: for each open option, its row in the table.
        ends: the option's end.
        costs: the option's cost without pair terms.
        least: lower bound of the option's whole cost.
        known: (options, terms) lower bounds of its costs by pair term.
        approximate: whether the bound can still be raised by more neighbours.
        unwalled: whether the wall terms are left out of the cost so far.
    """

    picked: NDArray[np.int64]
    free: NDArray[np.int64]
    lanes: NDArray[np.float64]
    lane_costs: NDArray[np.float64]
    rows: NDArray[np.int64]
    ends: NDArray[np.float64]
    costs: NDArray[np.float64]
    least: NDArray[np.float64]
    known: NDArray[np.float64]
    approximate: NDArray[np.bool_]
    unwalled: NDArray[np.bool_]


class Workspace(NamedTuple):
    """Scratch arrays of one thread, reused from decision to decision.

    Attributes:
        neighbours: who decides, and the people around.
        unsure: rows of people left to the exact test.
        blocks: people close and walls at each level of time; groups that certainly hit something.
        walls: walls in reach.
        barriers: walls in reach in the pedestrian's coordinates.
        bounds: lower bound of the cost of each group.
        opened: groups and options that the search has opened.
        path: one path.
    """

    neighbours: Neighbours
    unsure: NDArray[np.int64]
    blocks: Blocks
    walls: NDArray[np.float64]
    barriers: NDArray[np.float32]
    bounds: NDArray[np.float64]
    opened: Opened
    path: NDArray[np.float64]


def make_neighbours(people: int, fields: int, of_others: int) -> Neighbours:
    """Arrays of ``Neighbours`` for at most so many people near; see ``make_workspace``."""
    return Neighbours(
        own=np.empty(FIELDS + fields),
        near=np.empty(people + LANES, np.int64),
        close=make_close(people),
        rows=np.empty(people + LANES, np.int64),
        others=np.empty((FIELDS + of_others, people + LANES)),
        moved=np.empty(people + 1, np.int64),
        marks=np.empty(people, np.int64),
        marked=np.empty(people + 1, np.int64),
        first=np.zeros(1, np.int64),
    )


def make_workspace(
    people: int, walls: int, options: int, groups: int, terms: int, fields: int, of_others: int
) -> Workspace:
    """Scratch arrays for one thread, of the greatest sizes that a decision needs.

    A cluster is a set of similar poses; a group has up to 8 similar options of a cluster.

    Args:
        people: most people near somebody who decides.
        walls: most walls and exits near them.
        options: most options in a cluster.
        groups: most groups in a cluster.
        terms: number of cost terms.
        fields: number of people's fields that terms read.
        of_others: number of those that they read of neighbours.
    """
    lanes = LANES * groups
    return Workspace(
        neighbours=make_neighbours(people, fields, of_others),
        unsure=np.empty(people, np.int64),
        blocks=Blocks(
            Bodies(
                np.empty(len(LEVELS), np.int64),
                np.empty((len(LEVELS), people + 1), np.int64),
            ),
            Fences(
                np.empty(len(LEVELS), np.int64),
                np.empty((len(LEVELS), BARRIER_FIELDS, walls), np.float32),
            ),
            np.empty(groups + WIDE, np.int32),
        ),
        walls=np.empty((walls, 5)),
        barriers=np.empty((BARRIER_FIELDS, walls), np.float32),
        bounds=np.empty(groups + AT_ONCE),
        opened=Opened(
            picked=np.empty(groups + LANES, np.int64),
            free=np.empty(groups, np.int64),
            lanes=np.empty((SPEED + 1, lanes)),
            lane_costs=np.empty(lanes),
            rows=np.empty(options + LANES, np.int64),
            ends=np.empty((SPEED + 1, options + LANES)),
            costs=np.empty(options + LANES),
            least=np.empty(options + AT_ONCE),
            known=np.empty((options, terms)),
            approximate=np.empty(options, np.bool_),
            unwalled=np.empty(options, np.bool_),
        ),
        path=np.empty((3, SAMPLES)),
    )
