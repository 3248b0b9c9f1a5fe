"""Variables of the environment that commands cannot do with, said before anything is imported."""

from __future__ import annotations

import os

from mesa_mobility.errors import MobilityError


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
