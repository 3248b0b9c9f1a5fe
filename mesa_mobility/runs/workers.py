"""Workers: this process, processes of their own, or those behind futures of an executor."""

from __future__ import annotations

import queue
from collections import deque
from collections.abc import Callable
from concurrent.futures import CancelledError, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
from typing import Any, Protocol, TypeAlias

from mesa_mobility.interrupts import deaf_children
from mesa_mobility.runs.processes import one_thread_each, spawned_pool

Function: TypeAlias = Callable[[Any], Any]
Ended: TypeAlias = tuple[Any, Any]
"""A job, and its result or the error with which it has ended."""


class WorkerDied(Exception):
    """The process that had a job has ended without an answer."""


class Workers(Protocol):
    """What does jobs.

    Attributes:
        count: workers, as far as known.
        own_processes: whether a worker may be ended without harm to anything else.
        address: of a page that shows what the workers do, or nothing.
    """

    count: int
    own_processes: bool
    address: str

    def submit(self, function: Function, job: Any) -> None:
        """Have a job done by a function of it."""

    def ended(self, seconds: float) -> list[Ended]:
        """Jobs that have ended, each with its result or error; none after so many seconds."""

    def close(self) -> None:
        """End the work; jobs that have not ended are dropped."""


class Serial:
    """Jobs one after the other in this process."""

    count, own_processes, address = 1, False, ""

    def __init__(self) -> None:
        self._waiting: deque[tuple[Function, Any]] = deque()

    def submit(self, function: Function, job: Any) -> None:
        """Have a job done."""
        self._waiting.append((function, job))

    def ended(self, seconds: float) -> list[Ended]:
        """The next job, done now."""
        if not self._waiting:
            return []
        function, job = self._waiting.popleft()
        try:
            return [(job, function(job))]
        except Exception as error:
            return [(job, error)]

    def close(self) -> None:
        """Drop what has not been done."""
        self._waiting.clear()


class Futures:
    """Jobs as futures, whose ends are put in a queue.

    Args:
        start: submits a job.
        count: workers.
        own_processes: whether a worker may be ended without harm to anything else.
        address: of a page that shows what the workers do.
    """

    def __init__(
        self,
        start: Callable[[Function, Any], Any],
        count: int,
        *,
        own_processes: bool,
        address: str = "",
    ) -> None:
        self.count, self.own_processes, self.address = count, own_processes, address
        self._start = start
        self._ends: queue.Queue[Any] = queue.Queue()
        self._jobs: dict[Any, Any] = {}

    def submit(self, function: Function, job: Any) -> None:
        """Have a job done."""
        future = self._start(function, job)
        self._jobs[future] = job
        future.add_done_callback(self._ends.put)

    def ended(self, seconds: float) -> list[Ended]:
        """Jobs that have ended."""
        found: list[Ended] = []
        try:
            found.append(self._answer(self._ends.get(timeout=seconds)))
            while True:
                found.append(self._answer(self._ends.get_nowait()))
        except queue.Empty:
            return found

    def close(self) -> None:
        """Drop what has not been begun."""
        for future in self._jobs:
            future.cancel()

    def error_of(self, error: BaseException) -> BaseException:
        """An error as callers take it."""
        return error

    def _answer(self, future: Any) -> Ended:
        job = self._jobs.pop(future)
        try:
            return job, future.result()
        except (Exception, CancelledError) as error:
            return job, self.error_of(error)


class Processes(Futures):
    """Spawned processes, each an executor of its own: one that dies takes no other along.

    Args:
        count: processes.
    """

    def __init__(self, count: int) -> None:
        super().__init__(self._to_the_idlest, count, own_processes=True)
        self._around = ExitStack()
        self._around.enter_context(one_thread_each())
        self._pools = [spawned_pool(1) for _ in range(count)]
        self._held: list[set[Future[Any]]] = [set() for _ in range(count)]

    def close(self) -> None:
        """End the processes."""
        super().close()
        for pool in self._pools:
            _kill(pool)
        self._around.close()

    def error_of(self, error: BaseException) -> BaseException:
        """An error as callers take it."""
        return WorkerDied() if isinstance(error, BrokenProcessPool) else error

    def _to_the_idlest(self, function: Function, job: Any) -> Future[Any]:
        for held in self._held:
            held.difference_update([future for future in held if future.done()])
        at = min(range(self.count), key=lambda k: len(self._held[k]))
        # Processes are started when a job is submitted.
        with deaf_children():
            try:
                future = self._pools[at].submit(function, job)
            except BrokenProcessPool:
                self._pools[at].shutdown(wait=False)
                self._pools[at] = spawned_pool(1)
                future = self._pools[at].submit(function, job)
        self._held[at].add(future)
        return future


def _kill(pool: ProcessPoolExecutor) -> None:
    """End a pool's process at once."""
    processes = list((getattr(pool, "_processes", None) or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for process in processes:
        process.kill()
    for process in processes:
        process.join()
