"""Processes side by side: spawned, with one thread each, ended with the one that started them."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import AbstractContextManager, contextmanager
from multiprocessing import current_process, get_context, parent_process, resource_tracker

from mesa_mobility.errors import ModelError

THREADS = "NUMBA_NUM_THREADS"

_TRIAL, _CALLED_AGAIN = "mesa-mobility trial", 75


def available_processors() -> int:
    """Number of processors that this process may use; all of them where that is not known."""
    # Only Linux tells which ones these are.
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def spawned_pool(jobs: int) -> ProcessPoolExecutor:
    """Processes that are spawned when work is submitted, and end with this one."""
    # Python's own helper for such processes lets Ctrl-C through again when it is started. It tidies
    # up after a process that Ctrl-C has ended at once, which is nothing to warn of.
    with _environment("PYTHONWARNINGS", "ignore:resource_tracker"):
        resource_tracker.ensure_running()
    return ProcessPoolExecutor(
        max_workers=jobs, mp_context=get_context("spawn"), initializer=_end_with_parent
    )


def one_thread_each() -> AbstractContextManager[None]:
    """Processes started in this block use one thread each, since they share the processors."""
    return _environment(THREADS, "1")


@contextmanager
def _environment(name: str, value: str) -> Iterator[None]:
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before


def _end_with_parent() -> None:
    """End this process when the one that has started it ends, however it does."""
    parent = parent_process()
    assert parent is not None

    def follow() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=follow, name="mesa-mobility parent", daemon=True).start()


def check_importable(model_class: type, caller: str) -> None:
    """Raise ModelError where a spawned process would not find a class.

    Args:
        model_class: the class.
        caller: the function that would start processes, for the message.
    """
    if current_process().name == _TRIAL:  # this script, imported by the trial below
        sys.exit(_CALLED_AGAIN)
    module, name = model_class.__module__, model_class.__qualname__
    reason = ""
    main = sys.modules["__main__"]
    if "<locals>" in name:
        reason = "it is defined within a function"
    elif module == "__main__" and getattr(main, "__spec__", None) is None:
        file = getattr(main, "__file__", None)
        if file is None or not os.path.isfile(file):
            reason = "it is defined in a notebook or at a prompt"
    if not reason and module == "__main__":
        reason = _tried(model_class, caller)
    if reason:
        raise ModelError(
            f"{caller}: other processes cannot import {name}: {reason}; expected a class of a "
            "module, or one process"
        )


def check_main(caller: str) -> None:
    """Raise ModelError where a spawned process would run this program's script again.

    Args:
        caller: the function that would start processes, for the message.
    """
    if current_process().name == _TRIAL:
        sys.exit(_CALLED_AGAIN)
    main = sys.modules["__main__"]
    file = getattr(main, "__file__", None)
    if getattr(main, "__spec__", None) is not None or file is None or not os.path.isfile(file):
        return  # nothing is imported again, or a module
    if reason := _tried(int, caller):
        raise ModelError(f"{caller}: other processes cannot be started: {reason}")


def _tried(model_class: type, caller: str) -> str:
    """Why a process that is started like the others does not find the class, or nothing."""
    trial = get_context("spawn").Process(target=id, args=(model_class,), name=_TRIAL)
    trial.start()
    trial.join()
    if trial.exitcode == _CALLED_AGAIN:
        return f"its script calls {caller} when it is imported, not below `if __name__ == ...`"
    return "its script fails when it is imported" if trial.exitcode else ""
