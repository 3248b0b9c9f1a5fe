"""The decisions of a frame, for everybody whose movement has ended."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from copy import copy, deepcopy
from dataclasses import replace
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import Entry
from mesa_mobility.compiled.threads import in_threads, threads_for
from mesa_mobility.compiled.twins import PLAIN
from mesa_mobility.crowd.costs.candidates import Moment
from mesa_mobility.crowd.costs.layout import FIELDS, Terms
from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.crowd.options.repertoire import Repertoire
from mesa_mobility.crowd.planning.alone import wishes_of
from mesa_mobility.crowd.planning.decision import decide
from mesa_mobility.crowd.planning.evaluation.candidate_batch import Outlook, make_candidates
from mesa_mobility.crowd.planning.evaluation.sample_checks import SampleChecks, check_terms
from mesa_mobility.crowd.planning.evaluation.term_table import NO_EXTRA, CompiledTerms, extra_costs
from mesa_mobility.crowd.planning.explanation import Explanation, Watch, judge, weigh
from mesa_mobility.crowd.planning.following import show_all
from mesa_mobility.crowd.planning.thread_queue import new_queue
from mesa_mobility.crowd.planning.workspace import FrameContext, Rules, Workspace, make_workspace
from mesa_mobility.crowd.state.people_grid import build_grid, grid_of_frame
from mesa_mobility.crowd.state.records import Crowd, CrowdState
from mesa_mobility.crowd.state.surroundings import Surroundings
from mesa_mobility.crowd.state.twins import NO_TWINS, Twins
from mesa_mobility.crowd.state.wishes import NOBODY, Wishes
from mesa_mobility.errors import ModelError


class DecisionScheduler:
    """Takes the decisions of each frame.

    Args:
        repertoire: options of all pedestrian types.
        rules: the model's constants.
        least_core: smallest core radius in the crowd, metres.
        types: names of the pedestrian types.
    """

    def __init__(
        self, repertoire: Repertoire, rules: Rules, least_core: float, types: Sequence[str]
    ) -> None:
        self._types = tuple(types)
        self._checks = SampleChecks()
        self._repertoire = repertoire
        self._rules = rules
        # As many bodies as have room within the search radius.
        room = (rules.search_radius / least_core + 1.0) ** 2
        self._most_near = int(room) + 1 if rules.hard_bodies else sys.maxsize
        self._make_room()

    def _make_room(self) -> None:
        self._compiled = CompiledTerms(self._types)
        self._works: list[Workspace] = []
        self._decide = Entry(decide)

    def __deepcopy__(self, memo: dict[int, Any]) -> DecisionScheduler:
        """A copy with workspaces of its own."""
        other = copy(self)
        other._rules = deepcopy(self._rules, memo)
        other._make_room()
        return other

    def take(
        self,
        order: NDArray[np.int64],
        moment: Moment,
        rows: NDArray[np.int64],
        crowd: Crowd,
        around: Surroundings,
        terms: Sequence[CostTerm],
        watch: Watch | None = None,
        twins: Twins = NO_TWINS,
    ) -> None:
        """Decide for the pedestrians in ``order``, one after the other, and commit them.

        Args:
            order: who decides, those first who go first.
            moment: now.
            rows: everybody inside, and their twins.
            crowd: the crowd; targets must be set.
            around: walls and exits.
            terms: cost terms.
            watch: gets the decision of the pedestrian that it watches.
            twins: those on other sheets.

        Raises:
            ModelError: a cost is not a number, or a term does not give one for each option.
        """
        table, groups = self._repertoire.table, self._repertoire.groups
        compiled, others = self._compiled(terms, crowd)
        extra, extra_offsets = NO_EXTRA
        grid = seen = grid_of_frame(rows, crowd.records)
        if len(twins.follow):
            show_all(rows[twins.strip[rows] < 0], grid, twins, table, crowd.records)
            seen = grid_of_frame(rows[twins.here[rows]], crowd.records)
        outlook = Outlook(table, crowd, seen, around, self._rules, moment)
        if others:
            extra, extra_offsets = extra_costs(others, order, outlook, self._types)
        checked = self._checks.due(terms) if len(order) else []
        if checked:
            first = make_candidates(order[:1], outlook.aside())
            check_terms(checked, first, groups, int(crowd.cluster[order[0]]))
        state = crowd.records
        scene = FrameContext(
            moment.frame, table, groups, state, grid, around, compiled, self._rules, twins
        )
        threads = 1 if PLAIN else threads_for(len(order))
        # Each sheet has room for a body at the same place.
        most = min(len(rows), self._most_near * (1 + len(twins.strips)))
        works = self._works_for(threads, most, around, len(terms), compiled)

        def part(first: int, last: int) -> None:
            people, offsets = order[first:last], extra_offsets[first : last + 1]
            queue = new_queue(len(people))

            def work_off(work: Workspace) -> int:
                place: int = self._decide(people, queue, scene, extra, offsets, work)
                return place

            failed = min(in_threads(work_off, works))
            if failed < len(people):
                row = int(people[failed])
                weighed = weigh(row, outlook.aside(), self._repertoire, terms, self._types)
                raise ModelError(_not_a_number(weighed))

        if watch is None or watch.pedestrian not in order:
            part(0, len(order))
            return
        # Costs use the crowd before any decision, collision tests the paths committed so far. So
        # deciding in two parts gives the same result.
        weighed = weigh(watch.pedestrian, outlook.aside(), self._repertoire, terms, self._types)
        at = int(np.flatnonzero(order == watch.pedestrian)[0])
        if at > 0:
            part(0, at)
        row = order[at : at + 1]
        target = np.column_stack([crowd.target_x[row], crowd.target_y[row]])
        speed = crowd.preferred[row]
        people = rows[twins.strip[rows] < 0] if len(twins.follow) else rows
        wish = self.wishes(row, target, speed, moment, people, crowd, around, terms)
        judged = judge(weighed, outlook)
        watch.decision = replace(judged, blocked_by=int(wish.blockers[0]))
        part(at, len(order))
        watch.commits(crowd, self._rules.first_option)

    def wishes(
        self,
        rows: NDArray[np.int64],
        points: NDArray[np.float64],
        speeds: NDArray[np.float64],
        moment: Moment,
        inside: NDArray[np.int64],
        crowd: Crowd,
        around: Surroundings,
        terms: Sequence[CostTerm],
    ) -> Wishes:
        """What people would do if nobody else were there, and who is in the way of that.

        Cost terms written in NumPy do not count: they may look at the others.

        Args:
            rows: (n,) these people.
            points: (n, 2) where each wants to go, metres.
            speeds: (n,) how fast, m/s.
            moment: now.
            inside: rows of everybody inside.
            crowd: the crowd.
            around: walls and exits.
            terms: cost terms.
        """
        compiled, _ = self._compiled(terms, crowd)
        alone, fields = cast(CrowdState, crowd.records[rows]), compiled.fields
        alone["target_x"], alone["target_y"] = points.T
        alone["preferred"] = speeds
        order = np.arange(len(rows), dtype=np.int64)
        grid = grid_of_frame(order, alone)
        # Nothing is near to a place that is no number, not even somebody else at the same place.
        grid.x[:] = np.nan
        scene = FrameContext(
            moment.frame,
            self._repertoire.table,
            self._repertoire.groups,
            alone,
            grid,
            around,
            compiled._replace(fields=fields[rows] if fields.size else fields),
            self._rules._replace(hard_bodies=False),
            NO_TWINS,
        )
        extra, offsets = NO_EXTRA
        most = min(len(inside), self._most_near)
        [work] = self._works_for(1, most, around, len(terms), compiled)
        self._decide(order, new_queue(len(order)), scene, extra, offsets, work)
        seen = np.concatenate([inside, crowd.copies]) if len(crowd.copies) else inside
        everybody = build_grid(seen, crowd.x, crowd.y)
        reach = self._rules.search_radius
        found = wishes_of(
            alone, rows, moment.frame, self._repertoire.table, everybody, crowd.records, reach
        )
        if len(crowd.copies):
            hit = found.blockers != NOBODY
            found.blockers[hit] = crowd.person_of[found.blockers[hit]]
        return found

    def _works_for(
        self, threads: int, people: int, around: Surroundings, terms: int, compiled: Terms
    ) -> list[Workspace]:
        """A workspace for each thread."""
        walls = around.most_walls
        fields, of_others = compiled.fields.shape[1], compiled.of_others
        works = self._works
        if works and (
            people > len(works[0].neighbours.marks)
            or walls > len(works[0].walls)
            or terms > len(works[0].opened.known[0])
            or FIELDS + fields != len(works[0].neighbours.own)
            or FIELDS + of_others != len(works[0].neighbours.others)
        ):
            works.clear()
        while len(works) < threads:
            if works:
                people, walls = len(works[0].neighbours.marks), len(works[0].walls)
                terms = len(works[0].opened.known[0])
            options = int(np.diff(self._repertoire.table.offsets).max())
            clusters = self._repertoire.groups.clusters
            most = int((clusters["last"] - clusters["first"]).max())
            works.append(make_workspace(people, walls, options, most, terms, fields, of_others))
        return works[:threads]


def _not_a_number(weighed: Explanation) -> str:
    """The error for an option whose cost is not a number."""
    row = weighed.pedestrian
    for name, costs in zip(weighed.terms, weighed.costs, strict=True):
        wrong = np.flatnonzero(~np.isfinite(costs))
        if len(wrong):
            return (
                f"cost of option {wrong[0]} of {len(costs)} of pedestrian {row}: not a number but "
                f"{costs[wrong[0]]}, expected finite numbers from the behaviour {name!r}"
            )
    return (
        f"cost of an option of pedestrian {row}: not a number, expected finite numbers from each "
        f"of the behaviours {', '.join(weighed.terms)}"
    )
