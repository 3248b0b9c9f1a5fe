"""Why a pedestrian moves as they do: one decision, option by option.

Costs come from the terms themselves and verdicts from the engine's own tests, so an explanation
shows what the decision sees.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.collision.exact import exit_distance, near_walls, wall_reach
from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.repertoire import Repertoire, within_maps
from mesa_mobility.crowd.options.table import SAMPLE_FRAMES, SAMPLES, OptionTable
from mesa_mobility.crowd.planning.evaluation.candidate_batch import Outlook, make_candidates
from mesa_mobility.crowd.planning.feasibility import Obstacles, Trial, path_gone_or_blocked
from mesa_mobility.crowd.state.paths import to_world
from mesa_mobility.crowd.state.records import Crowd, CrowdState
from mesa_mobility.crowd.state.twins import rows_seen
from mesa_mobility.crowd.state.wishes import NOBODY

FREE, WALL, PERSON = 0, 1, 2
"""Verdicts on an option: what it hits, nothing, a wall, or a person."""


@dataclass(frozen=True, eq=False)
class Explanation:
    """One decision of one pedestrian; its n options are those of ``candidates``.

    Attributes:
        pedestrian: row in the crowd.
        frame: when the decision was or would be taken.
        taken: whether the decision was taken; if not, it is the one that would be taken.
        capability: what the pedestrian can do on the ground where they are.
        cluster: cluster of the pose from which the pedestrian decides, in that capability's map.
        candidates: the pedestrian's options; a batch of one pedestrian.
        terms: names of the terms that people of this type have.
        weights: (terms,) factors of the terms in the sum.
        costs: (terms, n) cost of each option, without the weights.
        verdicts: (n,) ``FREE``, ``WALL`` or ``PERSON``.
        blockers: (n,) row of the person in the way, or -1.
        paths: (n, 3, 16) x, y, heading in the world every 3 frames, from the start on.
        knots: (n,) number of valid samples of each path; beyond them the end is repeated.
        neighbour_ends: (q, 2) ends of the neighbours' committed movements, metres.
        chosen: index of the option taken, or -1 for the fallback.
        blocked_by: row of the person whom the pedestrian would hit first with the movement that
            they would take if nobody else were there, or -1.
    """

    pedestrian: int
    frame: int
    taken: bool
    capability: Capability
    cluster: int
    candidates: Candidates
    terms: tuple[str, ...]
    weights: NDArray[np.float64]
    costs: NDArray[np.float64]
    verdicts: NDArray[np.int8]
    blockers: NDArray[np.int64]
    paths: NDArray[np.float64]
    knots: NDArray[np.int64]
    neighbour_ends: NDArray[np.float64]
    chosen: int
    blocked_by: int = NOBODY

    @property
    def totals(self) -> NDArray[np.float64]:
        """(n,) cost of each option: the weighted sum of the terms."""
        totals: NDArray[np.float64] = self.weights @ self.costs
        return totals


@dataclass
class Watch:
    """Keeps the last decision of one pedestrian, as it was taken.

    Attributes:
        pedestrian: row in the crowd.
        decision: the pedestrian's last decision since this watch began, if any.
    """

    pedestrian: int
    decision: Explanation | None = field(default=None, init=False)

    def commits(self, crowd: Crowd, first_option: NDArray[np.int64]) -> None:
        """Note which option the engine has committed the pedestrian to."""
        if self.decision is not None:
            _, option = within_maps(crowd.option[[self.pedestrian]], first_option)
            at = np.flatnonzero(self.decision.candidates.options == option)
            self.decision = replace(self.decision, taken=True, chosen=int(at[0]) if len(at) else -1)


def weigh(
    row: int,
    outlook: Outlook,
    known: Repertoire,
    terms: Sequence[CostTerm],
    types: Sequence[str],
) -> Explanation:
    """The costs of the options of the pedestrian in ``row``, without verdicts (see ``judge``)."""
    crowd = outlook.crowd
    candidates = make_candidates(np.array([row], dtype=np.int64), outlook)
    n, kind = len(candidates), crowd.type_index[row]
    capability, cluster = known.capability_of(int(crowd.cluster[row]))
    terms = [term for term in terms if term.is_for(types[kind])]
    costs = [np.asarray(term.cost(candidates), dtype=np.float64) for term in terms]
    return Explanation(
        pedestrian=row,
        frame=outlook.moment.frame,
        taken=False,
        capability=capability,
        cluster=cluster,
        candidates=candidates,
        terms=tuple(term.name for term in terms),
        weights=np.array([term.weights(types)[kind] for term in terms]),
        costs=np.array(costs).reshape(len(costs), n),
        verdicts=np.zeros(n, dtype=np.int8),
        blockers=np.full(n, -1, dtype=np.int64),
        paths=np.empty((n, 3, SAMPLES)),
        knots=np.empty(n, dtype=np.int64),
        neighbour_ends=candidates.neighbour_positions,
        chosen=-1,
    )


def judge(weighed: Explanation, outlook: Outlook) -> Explanation:
    """The explanation with verdicts on the options, against walls and everybody's movements."""
    table, crowd, _, around, rules, _ = outlook
    row = weighed.pedestrian
    options = weighed.candidates.options + table.offsets[crowd.cluster[row]]
    options -= weighed.capability.table.offsets[weighed.cluster]
    near = rows_seen(crowd, weighed.candidates.neighbours, weighed.candidates.neighbour_positions)
    verdicts, blockers = weighed.verdicts.copy(), weighed.blockers.copy()
    walls = np.empty((around.most_walls, 5))
    given = Obstacles(walls, around, near, False, rules.hard_bodies)
    found = _Found(weighed.paths, weighed.knots, verdicts, blockers)
    _judge(row, options, weighed.frame, table, crowd.records, given, found)
    if len(crowd.person_of):
        blockers[blockers >= 0] = crowd.person_of[blockers[blockers >= 0]]
    totals = np.where(verdicts == FREE, weighed.totals, np.inf)
    # The cheapest; of several the one that turns least.
    order = np.lexsort((np.abs(table.heading[options]), totals))
    return replace(
        weighed,
        verdicts=verdicts,
        blockers=blockers,
        neighbour_ends=np.column_stack([crowd.to_x[near], crowd.to_y[near]]),
        chosen=int(order[0]) if (verdicts == FREE).any() else -1,
    )


class _Found(NamedTuple):
    """Paths, their numbers of samples, verdicts and blockers of options, as of ``Explanation``."""

    paths: NDArray[np.float64]
    knots: NDArray[np.int64]
    verdicts: NDArray[np.int8]
    blockers: NDArray[np.int64]


@entry_point()
def _judge(
    i: int,
    options: NDArray[np.int64],
    frame: int,
    table: OptionTable,
    state: CrowdState,
    given: Obstacles,
    found: _Found,
) -> None:
    """Write the verdicts; the walls of ``given`` are workspace."""
    x, y, destination, around = state.x[i], state.y[i], state.destination[i], given.around
    reach = wall_reach(table.farthest[state.cluster[i]], state.core[i])
    walls = given.walls[: near_walls(around, x, y, destination, reach, given.walls)]
    exits_from = exit_distance(around, x, y, destination)
    c, s = math.cos(state.heading[i]), math.sin(state.heading[i])
    near, hard = given.near, given.hard_bodies
    for k in range(len(options)):
        o = options[k]
        pieces = to_world(i, o, c, s, table, state, found.paths[k])
        found.knots[k] = pieces + 1
        reach = np.float64(table.options[o].reach)
        trial = Trial(found.paths[k], pieces, np.int64(SAMPLE_FRAMES), reach)
        exits_near = reach >= exits_from
        everybody = Obstacles(walls, around, near, exits_near, hard)
        gone = path_gone_or_blocked(i, trial, frame, table, state, everybody)
        if gone >= -1:
            continue
        found.verdicts[k] = WALL if gone == -3 else PERSON
        if gone == -2:
            for a in range(len(near)):
                one = Obstacles(walls, around, near[a : a + 1], exits_near, hard)
                if path_gone_or_blocked(i, trial, frame, table, state, one) == -2:
                    found.blockers[k] = near[a]
                    break
