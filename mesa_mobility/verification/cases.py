"""Cases: scenarios with their numbers, run for a seed each, in processes side by side."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, TypeAlias

from mesa_mobility.crowd.presets.given import Given
from mesa_mobility.runs.jobs import Failed, run_jobs
from mesa_mobility.runs.workers import Processes
from mesa_mobility.verification.drawings import first_run_drawn
from mesa_mobility.verification.wording import number_words

Figures: TypeAlias = dict[str, Any]
Scenario: TypeAlias = Callable[..., Figures]


@dataclass(frozen=True)
class Case:
    """A scenario with its numbers; equal cases are run once.

    Attributes:
        scenario: an importable function of a seed and keywords; gives figures.
        numbers: its keywords, in alphabetical order.
        effort: processor seconds it takes, roughly: the longest are begun first.
    """

    scenario: Scenario
    numbers: tuple[tuple[str, Any], ...]
    effort: float = field(default=1.0, compare=False)

    def __call__(self, seed: int) -> Figures:
        """Run it."""
        return self.scenario(seed, **dict(self.numbers))

    @property
    def words(self) -> str:
        """Its numbers for a reader, such as "20 people, speed 1.2 m/s"."""
        return ", ".join(number_words(name, value) for name, value in self.numbers)

    def __str__(self) -> str:
        numbers = ", ".join(f"{name} {value}" for name, value in self.numbers)
        return f"{self.scenario.__name__}({numbers})"


def case(scenario: Scenario, *, effort: float = 1.0, **numbers: Any) -> Case:
    """A case of a scenario; see `Case`."""
    return Case(scenario, tuple(sorted(numbers.items())), effort)


def run_cases(
    cases: Sequence[Case],
    seeds: Sequence[int],
    jobs: int,
    progress: Callable[[str, float, float], None] | None = None,
    *,
    drawn: bool = False,
    rules: Given | None = None,
) -> Mapping[tuple[Case, int], Figures]:
    """Run every case for every seed.

    A case that fails gives ``{"error": message}``. Results do not depend on `jobs`.

    Args:
        cases: the cases; duplicates are run once.
        seeds: one run each.
        jobs: processes.
        progress: called with the run just done, the effort so far, and the total effort; at first
            before any run.
        drawn: whether figures have a ``drawing`` of the first run that they are from.
        rules: what models follow instead of the default preset.
    """
    todo = [(each, seed) for each in dict.fromkeys(cases) for seed in seeds]
    todo.sort(key=lambda unit: -unit[0].effort)
    total = sum(each.effort for each, _ in todo)
    results: dict[tuple[Case, int], Figures] = {}
    done = 0.0
    if progress is not None:
        progress(f"the first of {len(todo)} runs", done, total)
    for each, seed, figures in run_units(todo, jobs, drawn=drawn, rules=rules):
        results[each, seed] = figures
        done += each.effort
        if progress is not None:
            progress(f"{each} seed {seed}", done, total)
    return results


def run_units(
    units: Iterable[tuple[Case, int]],
    jobs: int,
    *,
    drawn: bool = False,
    rules: Given | None = None,
) -> Iterator[tuple[Case, int, Figures]]:
    """Run cases, each with its seed, and yield each result as soon as it is there.

    Units are begun in their order; one is taken when a process is free for it.
    """
    for (each, seed), found in run_jobs(
        partial(_run, drawn, rules or Given()), units, Processes(jobs)
    ):
        # A scenario that raises fails its own test, not the whole suite.
        yield each, seed, {"error": found.error} if isinstance(found, Failed) else found


def _run(drawn: bool, rules: Given, unit: tuple[Case, int]) -> Figures:
    each, seed = unit
    with rules.followed():
        if not drawn:
            return each(seed)
        with first_run_drawn() as drawings:
            figures = each(seed)
    return {**figures, "drawing": drawings[0]} if drawings else figures
