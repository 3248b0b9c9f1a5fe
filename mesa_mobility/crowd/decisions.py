"""The decisions of a frame: for everybody whose movement has ended, in the right order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.choice import decide
from mesa_mobility.crowd.neighbours import build_grid, velocities
from mesa_mobility.crowd.queue import new_queue
from mesa_mobility.crowd.repertoire import Repertoire
from mesa_mobility.crowd.rules import Rules
from mesa_mobility.crowd.state import Crowd
from mesa_mobility.crowd.surroundings import Surroundings
from mesa_mobility.crowd.terms import CostTerm
from mesa_mobility.crowd.terms_table import NO_EXTRA, CompiledTerms, extra_costs
from mesa_mobility.crowd.work import Work, make_work
from mesa_mobility.errors import ModelError
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
        self._least_core = least_core
        self._compiled = CompiledTerms()
        self._works: list[Work] = []

    def take(
        self,
        order: NDArray[np.int64],
        frame: int,
        rows: NDArray[np.int64],
        crowd: Crowd,
        around: Surroundings,
        terms: Sequence[CostTerm],
    ) -> None:
        """Decide for the pedestrians in ``order``, one after the other, and commit them.

        Args:
            order: who decides, those first who go first.
            frame: now.
            rows: everybody inside.
            crowd: the crowd; targets must be set.
            around: walls and exits.
            terms: cost terms.

        Raises:
            ModelError: a cost is not a number, or a term does not give one for each option.
        """
        table, groups = self._repertoire.table, self._repertoire.groups
        compiled, others = self._compiled(terms)
        extra, extra_offsets = NO_EXTRA
        grid = build_grid(rows, crowd.x, crowd.y)
        if others:
            extra, extra_offsets = extra_costs(others, order, table, crowd, grid, self._rules)
        queue = new_queue(len(order))
        moving = velocities(grid, crowd.records)

        def work_off(work: Work) -> int:
            return decide(
                order, queue, frame, table, groups, crowd.records, grid, around, compiled, extra,
                extra_offsets, self._rules, moving, work,
            )  # fmt: skip

        works = self._works_for(threads_for(len(order)), len(rows), around)
        failed = min(together(work_off, works))
        if failed < len(order):
            names = ", ".join(term.name for term in terms)
            raise ModelError(
                f"cost of an option of pedestrian {order[failed]}: not a number, expected finite "
                f"numbers from each of the behaviours {names}"
            )

    def _works_for(self, threads: int, people: int, around: Surroundings) -> list[Work]:
        """Space for decisions among so many people, for each thread."""
        walls = len(around.segments) + len(around.exits)
        if self._rules.cores:
            # No more bodies than have room within the search radius.
            room = (self._rules.search_radius / self._least_core + 1.0) ** 2
            people = min(people, int(room) + 1)
        works = self._works
        if works and (people > len(works[0].near) or walls > len(works[0].walls)):
            works.clear()
        while len(works) < threads:
            if works:
                people, walls = len(works[0].near), len(works[0].walls)
            options = int(np.diff(self._repertoire.table.offsets).max())
            works.append(make_work(people, walls, options))
        return works[:threads]
