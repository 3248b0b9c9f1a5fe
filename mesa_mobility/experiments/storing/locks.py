"""One process at a time runs an experiment: the lock of the operating system on a file."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from mesa_mobility.errors import ResultsError
from mesa_mobility.experiments.storing.shards import Folder

_LOCK = "driver.lock"


def is_locked(folder: Folder) -> bool:
    """Whether a process holds the lock of the store in ``folder``.

    False if that cannot be known: the folder is not local, cannot be written, or has no locks.
    """
    path = Path(folder.path(_LOCK))
    if not folder.local or not path.exists():
        return False
    try:
        # Others who only look hold it for a moment.
        with FileLock(path, timeout=0.2):
            return False
    except Timeout:
        return True
    except (OSError, NotImplementedError):  # a folder that can only be read, or has no locks
        return False


@contextmanager
def locked(folder: Folder) -> Iterator[None]:
    """Hold the lock of a store, where its file system has locks.

    Raises:
        ResultsError: another process holds it, or the folder cannot be written.
    """
    folder.make("")
    if not folder.local:
        yield
        return
    lock = FileLock(folder.path(_LOCK), timeout=1.0)
    try:
        lock.acquire()
    except Timeout as error:
        raise ResultsError(f"{folder.url}: another process is running this experiment") from error
    except OSError as error:
        text = f"{folder.url}: cannot be written: {error.strerror or error}"
        raise ResultsError(text) from error
    except NotImplementedError:  # of the file system, says filelock
        pass
    try:
        yield
    finally:
        lock.release()
