"""`mesa-mobility estimate`: weights of behaviours from measured tracks."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mesa_mobility.commands.console import (
    AsJson,
    NoProgress,
    answer_json,
    answer_rows,
    progress_bar,
    say,
    some_path,
)
from mesa_mobility.commands.exits import ExitOptions
from mesa_mobility.commands.grouping import grouped
from mesa_mobility.commands.reading import TracksOptions

if TYPE_CHECKING:
    from mesa_mobility.crowd.costs.terms import CostTerm
    from mesa_mobility.estimation import Estimate, LeftOut


@dataclass(frozen=True)
class Terms:
    """Cost terms whose weights are estimated."""

    preset: Annotated[
        str, typer.Option(metavar="NAME|FILE", help="Preset whose terms are estimated.")
    ] = "default"
    term: Annotated[
        list[str] | None,
        typer.Option(help="A cost term to try beside those of the preset; repeatable."),
    ] = None
    without: Annotated[
        list[str] | None, typer.Option(help="A term of the preset to leave out; repeatable.")
    ] = None
    fixed: Annotated[
        list[str] | None, typer.Option(help="A term that keeps its weight; repeatable.")
    ] = None

    def made(self) -> list[CostTerm]:
        """The terms.

        Raises:
            ModelError: an unknown preset or term.
        """
        from mesa_mobility.crowd.presets.shipped import preset_of
        from mesa_mobility.errors import ModelError
        from mesa_mobility.estimation.problem import as_terms

        without = self.without or []
        terms = preset_of(self.preset).make_terms()
        names = [each.name for each in terms]
        for name in without:
            if name not in names:
                raise ModelError(f"--without {name}: preset {self.preset!r} has {', '.join(names)}")
        kept = [each for each in terms if each.name not in without]
        more = [name for name in self.term or [] if name not in [each.name for each in kept]]
        return as_terms([*kept, *more])


@grouped
def estimate(
    tracks: Annotated[
        list[Path], typer.Argument(metavar="TRACKS...", help="Files of measured tracks.")
    ],
    plan: Annotated[
        Path,
        typer.Option(help="The floor plan, with exits.", parser=some_path, metavar="FILE"),
    ],
    tried: Terms,
    reading: TracksOptions,
    doors: ExitOptions,
    *,
    choices: Annotated[
        int, typer.Option(min=1, help="Use at most this many choices of each file.")
    ] = 2500,
    seed: Annotated[int, typer.Option(min=0, help="Seed of all random draws.")] = 1,
    as_json: AsJson = False,
    no_progress: NoProgress = False,
) -> None:
    """Estimate how much each behaviour counts in the choices of measured people.

    With several files, each is also tested with the weights estimated from the others.
    """
    from mesa_mobility.estimation import Sampling, estimate, leave_out, observe

    terms, fixed = tried.made(), tried.fixed or []
    floor, sampling = doors.floor_plan(plan), Sampling(most=choices, seed=seed)
    found = None
    with progress_bar(shown=not no_progress) as report:
        for done, file in enumerate(tracks):
            report(f"observing {file.name}", done, len(tracks) + 1)
            own = observe(
                floor, reading.read(file), name=str(file), sampling=sampling, preset=tried.preset
            )
            say(f"{file}: {own.coverage}")
            found = own if found is None else found + own
        report("estimating", len(tracks), len(tracks) + 1)
        assert found is not None
        answer = estimate(terms, found, fixed=fixed)
        others = leave_out(terms, found, fixed=fixed) if len(tracks) > 1 else []
    _print(answer, others)
    if as_json:
        answer_json(_as_json(answer, others))


def _print(answer: Estimate, others: list[LeftOut]) -> None:
    print(answer)  # as wide as it is: a narrow terminal would break names
    if others:
        rows = [
            (
                each.fold,
                f"{each.measures.nats:.3f}",
                f"{each.given.nats:.3f}",
                f"{each.measures.energy:.3f}",
            )
            for each in others
        ]
        answer_rows(("left out", "nats", "of given weights", "energy score m"), rows)


def _as_json(answer: Estimate, others: list[LeftOut]) -> dict[str, Any]:
    def number(value: float) -> float | None:
        return None if value != value else float(value)

    return {
        "terms": {
            name: {
                "weight": number(answer.weights[k]),
                "error": number(answer.errors[k]),
                "interval": [number(each) for each in answer.intervals[k]],
                "likelihood_ratio": number(answer.likelihood_ratios[k]),
                "p": number(answer.p_values[k]),
                "assumed": number(answer.assumed[k]),
                "fixed": not bool(answer.free[k]),
            }
            for k, name in enumerate(answer.terms)
        },
        "measures": vars(answer.measures),
        "left_out": {
            each.fold: {
                "weights": dict(zip(each.terms, each.weights.tolist(), strict=True)),
                "measures": vars(each.measures),
                "given": {**vars(each.given), "scale": each.scale},
            }
            for each in others
        },
    }
