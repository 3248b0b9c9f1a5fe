"""The first module of the `mesa-mobility` command: Ctrl-C is answered while the others are loaded.

Before it Python loads itself, and answers Ctrl-C in its own way.
"""

from __future__ import annotations

import os
import signal


def _end(number: int, frame: object) -> None:
    os.write(2, b"interrupted: nothing written\n")
    os._exit(130)


signal.signal(signal.SIGINT, _end)

from mesa_mobility.cli import main  # noqa: E402

__all__ = ["main"]
