"""The decisions of a frame: for everybody whose movement has ended, in the right order."""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.choice import decide
from mesa_mobility.crowd.explain import Explanation, Watch, judge, weigh
from mesa_mobility.crowd.neighbours import Grid, build_grid, headways
from mesa_mobility.crowd.queue import new_queue
from mesa_mobility.crowd.repertoire import Repertoire
from mesa_mobility.crowd.rules import Rules
from mesa_mobility.crowd.state import Crowd
from mesa_mobility.crowd.surroundings import Surroundings
from mesa_mobility.crowd.terms import CostTerm
from mesa_mobility.crowd.terms_table import NO_EXTRA, CompiledTerms, extra_costs
from mesa_mobility.crowd.work import Work, make_work
from mesa_mobility.errors import ModelError
from mesa_mobility.jit import Entry
from mesa_mobility.threads import threads_for, together


class Decisions:
    """Has people decide, frame by frame.

    Args:
        repertoire: what their bodies can do.
        rules: what holds for everybody.
        least_core: smallest core radius in the crowd, metres.
    """

    def __init__(self, repertoire: Repertoire, rules: Rules, least_core: float) -> None:
        self._repertoire = repertoire
        self._rules = rules
        # No more bodies than have room within the search radius.
        room = (rules.search_radius / least_core + 1.0) ** 2
        self._most_near = int(room) + 1 if rules.cores else sys.maxsize
        self._compiled = CompiledTerms()
        self._works: list[Work] = []
        self._decide, self._build_grid = Entry(decide), Entry(build_grid)

    def take(
        self,
        order: NDArray[np.int64],
        frame: int,
        rows: NDArray[np.int64],
        crowd: Crowd,
        around: Surroundings,
        terms: Sequence[CostTerm],
        watch: Watch | None = None,
    ) -> None:
        """Decide for the pedestrians in ``order``, one after the other, and commit them.

        Args:
            order: who decides, those first who go first.
            frame: now.
            rows: everybody inside.
            crowd: the crowd; targets must be set.
            around: walls and exits.
            terms: cost terms.
            watch: gets the decision of the pedestrian that it watches.

        Raises:
            ModelError: a cost is not a number, or a term does not give one for each option.
        """
        table, groups = self._repertoire.table, self._repertoire.groups
        compiled, others = self._compiled(terms)
        extra, extra_offsets = NO_EXTRA
        grid = self._build_grid(rows, crowd.x, crowd.y)
        if others:
            extra, extra_offsets = extra_costs(others, order, table, crowd, grid, self._rules)
        moving = headways(grid, crowd.records)
        works = self._works_for(threads_for(len(order)), len(rows), around, len(terms))

        def part(first: int, last: int) -> None:
            people, offsets = order[first:last], extra_offsets[first : last + 1]
            queue = new_queue(len(people))

            def work_off(work: Work) -> int:
                place: int = self._decide(
                    people, queue, frame, table, groups, crowd.records, grid, around, compiled,
                    extra, offsets, self._rules, moving, work,
                )  # fmt: skip
                return place

            failed = min(together(work_off, works))
            if failed < len(people):
                names = ", ".join(term.name for term in terms)
                raise ModelError(
                    f"cost of an option of pedestrian {people[failed]}: not a number, expected "
                    f"finite numbers from each of the behaviours {names}"
                )

        if watch is None or watch.pedestrian not in order:
            part(0, len(order))
            return
        # Costs see the crowd as it is before anybody decides, collisions what those before have
        # committed to. To decide in two parts changes nothing.
        weighed = self.weigh(watch.pedestrian, frame, grid, crowd, terms)
        at = int(np.flatnonzero(order == watch.pedestrian)[0])
        if at > 0:
            part(0, at)
        watch.decision = self.judge(weighed, crowd, around)
        part(at, len(order))
        watch.commits(crowd, self._rules.first_option)

    def weigh(
        self, row: int, frame: int, grid: Grid, crowd: Crowd, terms: Sequence[CostTerm]
    ) -> Explanation:
        """What the options of the pedestrian in ``row`` cost; see ``explain.weigh``."""
        first_cluster = int(self._repertoire.first_cluster[crowd.kind[row]])
        table = self._repertoire.table
        return weigh(row, frame, table, crowd, grid, self._rules, first_cluster, terms)

    def judge(self, weighed: Explanation, crowd: Crowd, around: Surroundings) -> Explanation:
        """Which of these options hit something now; see ``explain.judge``."""
        return judge(weighed, self._repertoire.table, crowd, around, self._rules)

    def _works_for(self, threads: int, people: int, around: Surroundings, terms: int) -> list[Work]:
        """Space for decisions among so many people by so many terms, for each thread."""
        walls = len(around.segments) + len(around.exits)
        people = min(people, self._most_near)
        works = self._works
        if works and (
            people > len(works[0].marks)
            or walls > len(works[0].walls)
            or terms > len(works[0].sums)
        ):
            works.clear()
        while len(works) < threads:
            if works:
                people, walls = len(works[0].marks), len(works[0].walls)
                terms = len(works[0].sums)
            options = int(np.diff(self._repertoire.table.offsets).max())
            clusters = self._repertoire.groups.clusters
            most = int((clusters["last"] - clusters["first"]).max())
            works.append(make_work(people, walls, options, most, terms))
        return works[:threads]
