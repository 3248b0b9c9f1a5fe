"""Ctrl-C in a command: it ends the process, at once or where no result is half-written.

The signal handler raises no exception. One could come anywhere, also while compiled code is loaded
or hands its results over, and would end the process with a segmentation fault.
"""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

INTERRUPTED = 130
"""Exit status of a command that Ctrl-C has ended, as shells have it."""

_GRACE = 0.3
"""Seconds that the main thread has to answer Ctrl-C before another thread does."""


class Stopped(Exception):
    """Ctrl-C was pressed, and the computation has come to a point where it can stop."""


class _Interrupts:
    """The present effect of Ctrl-C.

    Attributes:
        asked: number of times that Ctrl-C was pressed.
        gentle: whether the first Ctrl-C is only noted.
        held: number of blocks that put off the end.
        written: whether results are in place.
        cleanups: functions called before the process ends.
        wakeup: file descriptor that Python writes a byte to for each signal, or -1.
    """

    def __init__(self) -> None:
        self.asked = 0
        self.gentle = False
        self.held = 0
        self.written = False
        self.cleanups: list[Callable[[], object]] = []
        self.wakeup = -1
        # Reentrant: the handler may interrupt the main thread while that holds the lock.
        self.lock = threading.RLock()
        self._arrived = self._answered = self._owed = 0

    def handle(self, number: int, frame: object) -> None:
        """The signal handler."""
        with self.lock:
            if self._owed:  # the watching thread has answered it
                self._owed = 0
                return
            self._answered += 1
            self._answer()

    def watch(self, signals: int) -> None:
        """Answer Ctrl-C where the main thread is in compiled code, or in the compiler, for long.

        Args:
            signals: file descriptor from which a byte comes for each signal.
        """
        while numbers := os.read(signals, 64):
            self._arrived += numbers.count(signal.SIGINT)
            time.sleep(_GRACE)
            with self.lock:
                while self._answered < self._arrived:
                    self._answered, self._owed = self._answered + 1, 1
                    self._answer()
        os.close(signals)

    def _answer(self) -> None:
        self.asked += 1
        if self.held:
            return
        if self.gentle and self.asked == 1:
            tell("\nstopping as soon as it can; Ctrl-C again stops at once and writes nothing")
            return
        self.end()

    def end(self) -> None:
        """End the process."""
        for cleanup in reversed(self.cleanups):
            with suppress(Exception):
                cleanup()
        tell("interrupted" if self.written else "interrupted: nothing written")
        # Not through Python's own exit, which waits for threads and frees compiled code that they
        # may be running.
        os._exit(INTERRUPTED)


_now = _Interrupts()


def tell(line: str) -> None:
    """Write a line to standard error, bypassing Python's buffer, which may be in use."""
    with suppress(OSError):
        os.write(2, f"{line}\n".encode())


def end_on_interrupt() -> None:
    """From here on Ctrl-C ends the process with status 130, and says so on one line.

    For the main thread of a command. If that does not answer in time, as in the compiler, another
    thread does.
    """
    global _now
    _now = _Interrupts()
    signal.signal(signal.SIGINT, _now.handle)
    if os.name == "posix":
        signals, wakeup = os.pipe()
        os.set_blocking(wakeup, False)
        signal.set_wakeup_fd(wakeup, warn_on_full_buffer=False)
        _now.wakeup = wakeup
        threading.Thread(
            target=_now.watch, args=(signals,), name="mesa-mobility interrupts", daemon=True
        ).start()


def ignore_interrupts() -> None:
    """From here on Ctrl-C does nothing: only the end of the process is left."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if _now.wakeup >= 0:
        signal.set_wakeup_fd(-1)
        os.close(_now.wakeup)  # which ends the watching thread
        _now.wakeup = -1


@contextmanager
def gentle_interrupt() -> Iterator[Callable[[], None]]:
    """In this block the first Ctrl-C is only noted; a second one ends the process.

    Yields a function to call between steps: it raises `Stopped` once Ctrl-C has been pressed.
    """
    now = _now

    def stop_here() -> None:
        if now.asked:
            raise Stopped

    now.gentle = True
    try:
        yield stop_here
    finally:
        now.gentle = False


@contextmanager
def putting_in_place() -> Iterator[None]:
    """In this block results are moved into place: Ctrl-C ends the process only after it."""
    now = _now
    asked = now.asked
    with now.lock:
        now.held += 1
    try:
        yield
        now.written = True
    finally:
        with now.lock:
            now.held -= 1
            if now.held == 0 and now.asked > max(asked, int(now.gentle)):
                now.end()


@contextmanager
def cleaning_up(cleanup: Callable[[], object]) -> Iterator[None]:
    """In this block ``cleanup`` is called if Ctrl-C ends the process; it must not raise or wait."""
    now = _now
    with now.lock:
        now.cleanups.append(cleanup)
    try:
        yield
    finally:
        with now.lock:
            now.cleanups.remove(cleanup)


@contextmanager
def deaf_children() -> Iterator[None]:
    """Processes started in this block ignore Ctrl-C, which terminals send to all of a command.

    They must be ended by the process that starts them, or end with it.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
