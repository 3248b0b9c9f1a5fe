"""The command line, assembled from its commands.

Slow imports are made where they are used, so that help and errors come at once.
"""

from __future__ import annotations

import os
from typing import Any

import typer
from typer.core import TyperGroup

from mesa_mobility.commands import experiment
from mesa_mobility.commands.checks.tracks import validate_tracks
from mesa_mobility.commands.checks.validate import validate
from mesa_mobility.commands.checks.verify import verify
from mesa_mobility.commands.dashboard import dashboard
from mesa_mobility.commands.estimate import estimate
from mesa_mobility.commands.explain import explain
from mesa_mobility.commands.export import export
from mesa_mobility.commands.maps.app import app as maps
from mesa_mobility.commands.plan import plan
from mesa_mobility.commands.plugins import listing, new
from mesa_mobility.commands.preset import preset
from mesa_mobility.commands.replay import replay
from mesa_mobility.commands.reports.results import results
from mesa_mobility.commands.run import run
from mesa_mobility.commands.serve import serve
from mesa_mobility.errors import MobilityError

# Some versions of Typer contain a copy of Click, whose UsageError is a base class here.
UsageError: type[Exception] = typer.BadParameter.__bases__[0]
"""Raised for wrong usage of the command line."""


class _Commands(TyperGroup):
    """Commands of one word, and of two of which the first is a command of its own."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """The command that arguments name, and the other arguments."""
        two = " ".join(args[:2])
        return super().resolve_command(ctx, [two, *args[2:]] if two in self.commands else args)


app = typer.Typer(
    name="mesa-mobility",
    cls=_Commands,
    help="Pedestrian crowds driven by recorded human movement.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
app.command("run")(run)
app.command("verify")(verify)
app.command("validate")(validate)
app.command("estimate")(estimate)
app.command("validate tracks")(validate_tracks)
app.command("dashboard")(dashboard)
app.command("serve")(serve)
app.command("export")(export)
# Other names of the same.
app.command("animate", hidden=True)(export)
app.command("render", hidden=True)(export)
app.command("results")(results)
app.command("replay")(replay)
app.command("explain")(explain)
app.command("plan")(plan)
app.command("preset")(preset)
app.add_typer(maps, name="map")
app.add_typer(experiment.app, name="experiment")
app.add_typer(new.app, name="new")
app.command("models")(listing.models)
app.command("behaviors")(listing.behaviors)
app.command("formats")(listing.formats)


def check_environment() -> None:
    """Refuse settings that Numba cannot run with, and have pictures drawn without a window.

    Raises:
        MobilityError: NUMBA_DISABLE_JIT is set, or NUMBA_NUM_THREADS is not a number of threads.
    """
    if os.environ.get("NUMBA_DISABLE_JIT", "0").strip() not in ("", "0"):
        raise MobilityError(
            "NUMBA_DISABLE_JIT is set: expected it unset, crowds need compiled code"
        )
    threads = os.environ.get("NUMBA_NUM_THREADS", "1").strip()
    if not (threads.isdecimal() and int(threads) > 0):
        raise MobilityError(f"NUMBA_NUM_THREADS is {threads!r}: expected a number of 1 or more")
    # Matplotlib refuses to be imported where this names no backend of its own.
    os.environ["MPLBACKEND"] = "agg"
