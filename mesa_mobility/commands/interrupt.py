"""Ctrl-C that lets a long computation come to a point where its state is whole."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

from mesa_mobility.commands.console import say


class Stopped(Exception):
    """The user asked to stop, and the computation has come to a point where it can."""


@contextmanager
def gentle_interrupt() -> Iterator[Callable[[], None]]:
    """Within, the first Ctrl-C is only noted; a second one interrupts at once.

    Gives a function to call between steps: it raises `Stopped` once Ctrl-C has been pressed.
    """
    # An exception out of a signal handler may come anywhere, also while compiled code that runs
    # on several threads hands its results over, which ends the process with a segmentation fault.
    asked = False

    def note(number: int, frame: FrameType | None) -> None:
        nonlocal asked
        if asked:
            raise KeyboardInterrupt
        asked = True
        say("\nstopping as soon as it can; Ctrl-C again stops at once and writes nothing")

    def stop_here() -> None:
        if asked:
            raise Stopped

    before = signal.signal(signal.SIGINT, note)
    try:
        yield stop_here
    finally:
        signal.signal(signal.SIGINT, before)
