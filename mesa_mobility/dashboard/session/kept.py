"""Runs that outlive their page, so that a page opened again continues the same one."""

from __future__ import annotations

import secrets
import threading
import time
from typing import Protocol

from solara.server import kernel_context

from mesa_mobility.dashboard.session.run import Run

KEPT_SECONDS = 900.0
"""Seconds for which a run is kept after its page has gone."""

KEPT_AT_MOST = 8
"""Most runs that are kept; the oldest are dropped."""

LEAVING_SECONDS = 1.0
"""Longest time in seconds for which a page that is being reloaded may still count as open."""


class Holder(Protocol):
    """The owner of a run while its page is open."""

    def watched(self) -> bool:
        """Whether a browser shows its page."""

    def close(self) -> None:
        """End, and keep the run."""

    def join(self) -> None:
        """Wait until this holder has ended."""


_lock = threading.Lock()
_holders: dict[str, Holder] = {}
_kept: dict[str, tuple[float, Run]] = {}
_sweeper: threading.Timer | None = None


def enter(key: str, holder: Holder) -> tuple[str, Run | None]:
    """Give a page the run with a key.

    Args:
        key: from the page's address, or "".
        holder: the page's owner of the run.

    Returns:
        The key of the page's run from now on, and the run, or None for a new one. A run that
        another page shows is not given away.
    """
    with _lock:
        other = _holders.get(key)
    if other is not None:
        end = time.monotonic() + LEAVING_SECONDS
        while other.watched() and time.monotonic() < end:
            time.sleep(0.02)
        if other.watched():
            key = ""
        else:
            other.close()
            other.join()
    with _lock:
        _forget_old()
        _, run = _kept.pop(key, (0.0, None))
        # Keys are drawn here, not chosen by clients: the key of another page cannot be guessed.
        if run is None:
            key = secrets.token_urlsafe(12)
        _holders[key] = holder
    return key, run


def leave(key: str, run: Run | None) -> None:
    """Keep the run of a page that has gone, for when it is opened again."""
    with _lock:
        _holders.pop(key, None)
        if run is not None:
            _kept[key] = (time.monotonic() + KEPT_SECONDS, run)
        _forget_old()


def _forget_old() -> None:
    """Drop expired runs, and schedule the next check."""
    global _sweeper
    now = time.monotonic()
    for key in [key for key, (until, _) in _kept.items() if until <= now]:
        del _kept[key]
    while len(_kept) > KEPT_AT_MOST:
        del _kept[next(iter(_kept))]
    if _sweeper is not None:
        _sweeper.cancel()
        _sweeper = None
    if _kept:
        first = min(until for until, _ in _kept.values())
        # Solara gives a new thread the context of the page that starts it, and the start hangs if
        # that page is just closing; all pages would then wait for the lock held here.
        with kernel_context.without_context():
            _sweeper = threading.Timer(first - now, _sweep)
            _sweeper.daemon = True
            _sweeper.start()


def _sweep() -> None:
    with _lock:
        _forget_old()
