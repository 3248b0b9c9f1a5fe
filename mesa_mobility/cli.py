"""The command line: `mesa-mobility`.

The commands are imported only when Ctrl-C is answered.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from typing import Any

from mesa_mobility.interrupts import end_on_interrupt, ignore_interrupts

BAD_INPUT = 2


def main() -> None:
    """Run the command line; leave with status 0, 1 (a check failed), 2 (bad input) or 130.

    Bad input gives one line on standard error that says what is wrong and where. To be called once,
    in the main thread of a process of its own: Ctrl-C ends that process.
    """
    end_on_interrupt()
    try:
        with warnings.catch_warnings():
            status = _run()
    finally:
        ignore_interrupts()
    sys.exit(status)


def _run() -> int:
    try:
        from mesa_mobility.commands.app import UsageError, app, check_environment
        from mesa_mobility.errors import MobilityError

        try:
            check_environment()
            warnings.showwarning = _warner()
            # Commands answer with nothing, and `typer.Exit` with its status.
            return app(prog_name="mesa-mobility", standalone_mode=False) or 0
        except UsageError as error:
            return _wrong_usage(error)
        except MobilityError as error:
            return _fail(str(error))
    except MemoryError as error:
        return _fail(f"not enough memory: {error}")
    # Unforeseen errors: still one line, with the place in the source for a report.
    except Exception as error:
        return _fail(f"unexpected {type(error).__name__}: {error} [{_place(error)}]")


def _warner() -> Callable[..., None]:
    """A function that prints warnings on one line, as errors are, and each of them once."""
    said: set[str] = set()

    def warn(message: Warning | str, *where: Any, **more: Any) -> None:
        text = " ".join(str(message).split())
        if text not in said:
            said.add(text)
            print(f"warning: {text}", file=sys.stderr)

    return warn


def _wrong_usage(error: Any) -> int:
    # A group without a command has its help for a message, which Rich has printed already.
    if type(error).__name__ == "NoArgsIsHelpError":
        print(error.format_message(), end="")
        return BAD_INPUT
    command = error.ctx.command_path if error.ctx else "mesa-mobility"
    return _fail(f"{error.format_message().rstrip('.')}; see {command} --help")


def _fail(message: str) -> int:
    print(f"error: {' '.join(message.split())}", file=sys.stderr)
    return BAD_INPUT


def _place(error: BaseException) -> str:
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    if trace is None:
        return "unknown place"
    code = trace.tb_frame.f_code
    return f"{code.co_name}, {code.co_filename}:{trace.tb_lineno}"
