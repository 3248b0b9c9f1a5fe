"""Observed choices: options, attributes and ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.crowd.hooks import World
from mesa_mobility.errors import ModelError
from mesa_mobility.estimation.choices.availability import FREE, PERSON, WALL
from mesa_mobility.estimation.choices.places import Places
from mesa_mobility.plugins.output import numbers_given


@dataclass
class Coverage:
    """How many choices have an option near enough, and why the others have none.

    Attributes:
        near: choices with an option near enough.
        too_fast: those whose person went farther than any of their options leads.
        walled: those whose near options hit a wall.
        blocked: those whose near options hit a wall or somebody ahead who walks on as before.
        between: those whose person was within reach, at a place where no option ends.
    """

    near: int = 0
    too_fast: int = 0
    walled: int = 0
    blocked: int = 0
    between: int = 0

    def count(self, hit: NDArray[np.int8], went: float, farthest: float) -> None:
        """Count a choice whose options near the end hit what ``hit`` (near,) says."""
        if (hit == FREE).any():
            self.near += 1
        elif (hit == PERSON).any():
            self.blocked += 1
        elif (hit == WALL).any():
            self.walled += 1
        elif went > farthest:
            self.too_fast += 1
        else:
            self.between += 1

    @property
    def choices(self) -> int:
        """All of them."""
        return sum(vars(self).values())

    @property
    def share(self) -> float:
        """Share of choices with an option near enough."""
        return self.near / max(self.choices, 1)

    def __add__(self, other: Coverage) -> Coverage:
        return Coverage(
            *(a + b for a, b in zip(vars(self).values(), vars(other).values(), strict=True))
        )

    def __str__(self) -> str:
        n = max(self.choices, 1)
        return (
            f"{self.choices} choices, {100 * self.share:.1f} % with an option near enough; of the "
            f"others {100 * self.too_fast / n:.1f} % went faster than any option, "
            f"{100 * self.walled / n:.1f} % where near options hit a wall, "
            f"{100 * self.blocked / n:.1f} % where they hit somebody ahead, "
            f"{100 * self.between / n:.1f} % between options"
        )


@dataclass(frozen=True, eq=False)
class Batch:
    """Choices of one moment.

    A choice has a segment of rows for each value that an unknown free speed may have, with the same
    options in each.

    Attributes:
        candidates: options, a pedestrian a segment.
        choice: (segments,) number of the choice in the batch.
        near: (rows,) whether an option ends near the observed end.
        off: (rows, 2) how far it ends from there, metres along and across the person's heading.
        stands_for: (rows,) how many available options each stands for.
        people: (c,) indices of the people.
        frame: of the tracks.
        duration: frames of the simulation.
        ends: (c, 2) where they were, metres.
        leaving: (c, 2) their velocity then, m/s.
    """

    candidates: Candidates
    choice: NDArray[np.int64]
    near: NDArray[np.bool_]
    off: NDArray[np.float64]
    stands_for: NDArray[np.float64]
    people: NDArray[np.int64]
    frame: float
    duration: int
    ends: NDArray[np.float64]
    leaving: NDArray[np.float64]

    @classmethod
    def of(
        cls,
        candidates: Candidates,
        wants: tuple[NDArray[np.float64], NDArray[np.float64]],
        *,
        choice: NDArray[np.int64],
        near: NDArray[np.int64],
        off: NDArray[np.float64],
        stands_for: NDArray[np.float64],
        **more: Any,
    ) -> Batch:
        """A batch; ``near`` (c,) is the number of options near the end, which come first."""
        sizes = np.diff(candidates.offsets)
        within = np.arange(len(candidates)) - np.repeat(candidates.offsets[:-1], sizes)
        own = choice[candidates.owner]
        is_near = within < near[own]
        targets, speeds = wants
        return cls(
            candidates=replace(candidates, targets=targets, preferred_speeds=speeds),
            choice=choice,
            near=is_near,
            off=off,
            stands_for=np.where(is_near, 1.0, stands_for[own]),
            **more,
        )


@dataclass(frozen=True, eq=False)
class Observations:
    """Observed choices of one run or of several.

    Attributes:
        worlds: the model of each run, by which terms are bound.
        batches: the choices of each moment.
        world: (batches,) number of each one's run.
        names: names of the runs.
        folds: by run, the group of runs that are left out together.
        run: (choices,) number of the run.
        person: (choices,) the person, whose numbers differ between runs.
        second: (choices,) when, seconds of the run's tracks.
        coverage: how many choices have an option near enough.
    """

    worlds: tuple[Any, ...]
    batches: tuple[Batch, ...]
    world: NDArray[np.int64]
    names: tuple[str, ...]
    folds: tuple[str, ...]
    run: NDArray[np.int64]
    person: NDArray[np.int64]
    second: NDArray[np.float64]
    coverage: Coverage

    @classmethod
    def of(
        cls,
        world: World,
        batches: Sequence[Batch],
        tracks: Places,
        *,
        name: str,
        fold: str,
        coverage: Coverage,
    ) -> Observations:
        """The choices of one run."""
        counts = [len(each.people) for each in batches]
        people = np.concatenate([each.people for each in batches])
        return cls(
            worlds=(world,),
            batches=tuple(batches),
            world=np.zeros(len(batches), dtype=np.int64),
            names=(name,),
            folds=(fold,),
            run=np.zeros(len(people), dtype=np.int64),
            person=people,
            second=np.repeat([each.frame / tracks.rate for each in batches], counts),
            coverage=coverage,
        )

    def __len__(self) -> int:
        return len(self.run)

    def __add__(self, other: Observations) -> Observations:
        """The choices of both."""
        runs = len(self.names)
        return Observations(
            worlds=self.worlds + other.worlds,
            batches=self.batches + other.batches,
            world=np.concatenate([self.world, other.world + runs]),
            names=self.names + other.names,
            folds=self.folds + other.folds,
            run=np.concatenate([self.run, other.run + runs]),
            person=np.concatenate([self.person, other.person + self.person.max() + 1]),
            second=np.concatenate([self.second, other.second]),
            coverage=self.coverage + other.coverage,
        )

    def costs(self, term: CostTerm) -> NDArray[np.float64]:
        """(rows,) what the term costs for each option, without its weight.

        Raises:
            ModelError: the wrong number of costs, or some that are not finite.
        """
        found, bound = [], -1
        for batch, world in zip(self.batches, self.world.tolist(), strict=True):
            if world != bound:
                term.bind(self.worlds[world])
                bound = world
            costs = numbers_given(
                f"behaviour {term.name!r}",
                "costs",
                term.cost(batch.candidates),
                (len(batch.candidates),),
            )
            found.append(costs)
        costs = np.concatenate(found)
        if not np.isfinite(costs).all():
            raise ModelError(
                f"behaviour {term.name!r}: gave a cost of {costs[~np.isfinite(costs)][0]}, "
                "expected finite numbers"
            )
        return costs
