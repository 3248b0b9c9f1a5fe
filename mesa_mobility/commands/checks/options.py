"""Options that the commands `verify`, `validate` and `validate tracks` share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from mesa_mobility.commands.console import AsJson, NoProgress
from mesa_mobility.commands.models.making import Numbers, split_settings
from mesa_mobility.commands.reports.options import ReportOptions
from mesa_mobility.errors import ModelError
from mesa_mobility.runs.processes import available_processors

if TYPE_CHECKING:
    from mesa_mobility.crowd.presets.given import Given

FAILED = 1


@dataclass(frozen=True)
class CheckOptions(ReportOptions):
    """How tests are run, and what is written of them."""

    seeds: Annotated[
        int,
        typer.Option(min=1, metavar="N", help="Run each test N times, with the seeds 1 to N."),
    ] = 1
    jobs: Annotated[
        int | None,
        typer.Option(min=1, help="Processes side by side. By default one for each processor."),
    ] = None
    preset: Annotated[
        str | None,
        typer.Option(
            metavar="NAME|FILE",
            help="Preset to use instead of the default one: paper or a TOML file.",
        ),
    ] = None
    numbers: Numbers = None
    as_json: AsJson = False
    no_progress: NoProgress = False

    @property
    def runs(self) -> range:
        """The seeds of the runs."""
        return range(1, self.seeds + 1)

    @property
    def processes(self) -> int:
        """How many there are side by side."""
        return self.jobs or available_processors()

    def rules(self) -> Given:
        """The rules for all models that are made.

        Raises:
            ModelError: an unknown preset, an unknown number, or a value out of range.
        """
        from mesa_mobility.crowd.presets.given import Given
        from mesa_mobility.crowd.presets.naming import COMMAND_LINE
        from mesa_mobility.crowd.presets.shipped import preset_of

        own, numbers = split_settings(self.numbers or [])
        if own:
            raise ModelError(
                f"--set {own[0]}: expected a number of a behaviour, such as headway.time=0.6"
            )
        preset = None if self.preset is None else preset_of(self.preset)
        given = Given(preset, numbers, COMMAND_LINE)
        given.check()
        return given
