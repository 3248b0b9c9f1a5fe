"""Candidates of a batch of pedestrians, laid out from the crowd's arrays."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal, kept
from mesa_mobility.crowd.collision.exact import near_walls, wall_reach
from mesa_mobility.crowd.costs.candidates import Candidates, Moment
from mesa_mobility.crowd.options.repertoire import within_maps
from mesa_mobility.crowd.options.table import FRAME_SECONDS, OptionTable
from mesa_mobility.crowd.planning.grid import farthest_range, interact, people_within, place_in
from mesa_mobility.crowd.planning.workspace import Rules
from mesa_mobility.crowd.state.people_grid import Grid
from mesa_mobility.crowd.state.records import Crowd, CrowdState
from mesa_mobility.crowd.state.surroundings import Surroundings


class Outlook(NamedTuple):
    """Everything that a decision looks at: options, people, walls, rules and the moment.

    Attributes:
        table: options of all maps.
        crowd: the crowd; targets must be set.
        grid: people by place.
        around: walls and exits.
        rules: the model's constants.
        moment: now.
    """

    table: OptionTable
    crowd: Crowd
    grid: Grid
    around: Surroundings
    rules: Rules
    moment: Moment

    def aside(self) -> Outlook:
        """The same, for questions that leave the model's generator as it is."""
        return self._replace(moment=self.moment.aside())


def pairs_of(rows: NDArray[np.int64], outlook: Outlook) -> NDArray[np.int64]:
    """(n,) number of options times number of neighbours of each pedestrian in ``rows`` (n,)."""
    table, crowd, grid, _, rules, _ = outlook
    clusters = crowd.cluster[rows]
    counts = table.offsets[clusters + 1] - table.offsets[clusters]
    _, offsets, _ = _all_neighbours(rows, grid, crowd.records, rules.interaction_ranges)
    return counts * np.maximum(np.diff(offsets), 1)


def make_candidates(rows: NDArray[np.int64], outlook: Outlook) -> Candidates:
    """The options, neighbours and walls of the pedestrians in ``rows``."""
    table, clusters = outlook.table, outlook.crowd.cluster[rows]
    counts = table.offsets[clusters + 1] - table.offsets[clusters]
    offsets = np.concatenate([[0], np.cumsum(counts)])
    # Options of a cluster follow one another in the table.
    options = np.arange(offsets[-1], dtype=np.int64)
    options += np.repeat(table.offsets[clusters] - offsets[:-1], counts)
    return candidates_of(rows, options, offsets, outlook)


def candidates_of(
    rows: NDArray[np.int64],
    options: NDArray[np.int64],
    offsets: NDArray[np.int64],
    outlook: Outlook,
) -> Candidates:
    """Some options of the pedestrians in ``rows``, with their neighbours and walls.

    Args:
        options: (n,) rows of the table.
        offsets: (len(rows) + 1,) options of pedestrian i are
            ``options[offsets[i]:offsets[i + 1]]``.
    """
    table, crowd, grid, around, rules, moment = outlook
    owner = np.repeat(np.arange(len(rows), dtype=np.int64), np.diff(offsets))
    x, y, heading = _lay_ends(rows, owner, options, table, crowd.records)
    places, neighbour_offsets, neighbour_places = _all_neighbours(
        rows, grid, crowd.records, rules.interaction_ranges
    )
    neighbours = grid.people[neighbour_places]
    if len(crowd.person_of):
        # Terms know people by their own rows, wherever they see them.
        grid = grid._replace(people=crowd.person_of[grid.people])
    maps, _ = within_maps(table.offsets[crowd.cluster[rows]], rules.first_option)
    wall_offsets, walls = _all_walls(rows, table, around, crowd.records)
    durations = table.options.frames[options] * FRAME_SECONDS
    speeds = table.options.speed[options].astype(np.float64)
    return Candidates(
        points=np.column_stack([x, y]),
        headings=heading,
        displacements=speeds * durations,
        durations=durations,
        speeds=speeds,
        options=options - rules.first_option[maps][owner],
        owner=owner,
        offsets=offsets,
        grid=grid,
        places=places,
        facings=crowd.heading[rows],
        targets=np.column_stack([crowd.target_x[rows], crowd.target_y[rows]]),
        preferred_speeds=np.where(np.isfinite(crowd.route[rows]), crowd.preferred[rows], 0.0),
        cores=crowd.core[rows],
        types=crowd.type_index[rows].astype(np.int64),
        neighbour_offsets=neighbour_offsets,
        neighbour_places=neighbour_places,
        wall_offsets=wall_offsets,
        walls=walls,
        groups=crowd.agenda["group"][rows].astype(np.int64),
        neighbour_facings=crowd.heading[neighbours],
        neighbour_cores=crowd.core[neighbours],
        neighbour_types=crowd.type_index[neighbours].astype(np.int64),
        neighbour_groups=crowd.agenda["group"][neighbours].astype(np.int64),
        fields={name: values[rows] for name, values in crowd.kernel_fields.items()},
        neighbour_fields={name: values[neighbours] for name, values in crowd.kernel_fields.items()},
        time=moment.frame * FRAME_SECONDS,
        rng=moment.rng,
    )


@kept()
def _lay_ends(
    rows: NDArray[np.int64],
    owner: NDArray[np.int64],
    options: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    n = len(options)
    x, y, heading = np.empty(n), np.empty(n), np.empty(n)
    for k in range(n):
        i, o = rows[owner[k]], options[k]
        option = table.options[o]
        c, s = math.cos(state.heading[i]), math.sin(state.heading[i])
        x[k] = state.x[i] + c * option.x - s * option.y
        y[k] = state.y[i] + s * option.x + c * option.y
        heading[k] = state.heading[i] + table.heading[o]
    return x, y, heading


@kept()
def _all_neighbours(
    rows: NDArray[np.int64], grid: Grid, state: CrowdState, ranges: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """(len(rows),) places in the grid, (len(rows) + 1,) offsets, and places of the neighbours."""
    found = np.empty(len(grid.people), np.int64)
    places, offsets = np.empty(len(rows), np.int64), np.zeros(len(rows) + 1, np.int64)
    for d in range(len(rows)):
        places[d] = place_in(grid, state.x[rows[d]], state.y[rows[d]], rows[d])
        offsets[d + 1] = offsets[d] + _neighbours(rows[d], grid, state, ranges, found)
    everyone = np.empty(offsets[-1], np.int64)
    for d in range(len(rows)):
        count = _neighbours(rows[d], grid, state, ranges, found)
        everyone[offsets[d] : offsets[d + 1]] = found[:count]
    return places, offsets, everyone


@internal()
def _neighbours(
    i: int,
    grid: Grid,
    state: CrowdState,
    ranges: NDArray[np.float64],
    found: NDArray[np.int64],
) -> int:
    """Write the places in the grid of the people who count for i.  Returns their number."""
    farthest = farthest_range(i, ranges, state)
    count, kept = people_within(grid, state.x[i], state.y[i], i, farthest, found), 0
    for a in range(count):
        found[kept] = found[a]
        kept += int(interact(i, grid.people[found[a]], ranges, state))
    return kept


@kept()
def _all_walls(
    rows: NDArray[np.int64],
    table: OptionTable,
    around: Surroundings,
    state: CrowdState,
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """(len(rows) + 1,) offsets, and (w, 4) walls within reach of each pedestrian."""
    found = np.empty((around.most_walls, 5))
    offsets = np.zeros(len(rows) + 1, np.int64)
    walls = np.empty((max(len(found), 1), 4))
    for k in range(len(rows)):
        i = rows[k]
        reach = wall_reach(table.farthest[state.cluster[i]], state.core[i])
        n = near_walls(around, state.x[i], state.y[i], state.destination[i], reach, found)
        offsets[k + 1] = offsets[k] + n
        while offsets[k + 1] > len(walls):
            walls = np.concatenate((walls, np.empty_like(walls)))
        walls[offsets[k] : offsets[k + 1]] = found[:n, :4]
    return offsets, walls[: offsets[-1]].copy()
