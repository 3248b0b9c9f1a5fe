"""The command line: `mesa-mobility`.

Each command lives in `mesa_mobility.commands`; whatever is slow to import is imported where it is
used, so that help and errors come at once.
"""

from __future__ import annotations

import sys
from typing import Any

import typer
from typer.core import TyperGroup

from mesa_mobility.commands import mobility_map, plugins
from mesa_mobility.commands.dashboard import dashboard
from mesa_mobility.commands.run import run
from mesa_mobility.commands.validate import validate
from mesa_mobility.commands.verify import verify
from mesa_mobility.errors import MobilityError

BAD_INPUT, INTERRUPTED = 2, 130


class _Commands(TyperGroup):
    """The commands; Ctrl-C in any of them is said, with the shell's own status for it."""

    def invoke(self, ctx: Any) -> Any:
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            print("interrupted: nothing written", file=sys.stderr)
            raise typer.Exit(INTERRUPTED) from None


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
app.command("dashboard")(dashboard)
app.add_typer(mobility_map.app, name="map")
app.command("models")(plugins.models)
app.command("behaviors")(plugins.behaviors)


def main() -> None:
    """Run the command line; leave with status 0, 1 (a check failed), 2 (bad input) or 130.

    Bad input gives one line on standard error that says what is wrong and where.
    """
    try:
        app(prog_name="mesa-mobility")
    except MobilityError as error:
        _fail(str(error))
    # What nobody foresaw: still one line, with the place for whoever reports it.
    except Exception as error:
        _fail(f"unexpected {type(error).__name__}: {error} [{_place(error)}]")


def _fail(message: str) -> None:
    print(f"error: {' '.join(message.split())}", file=sys.stderr)
    sys.exit(BAD_INPUT)


def _place(error: BaseException) -> str:
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    if trace is None:
        return "unknown place"
    code = trace.tb_frame.f_code
    return f"{code.co_name}, {code.co_filename}:{trace.tb_lineno}"
