"""Where batches run: in this process, in processes, in an executor of the caller's, or on Dask."""

from __future__ import annotations

import queue
from collections import deque
from collections.abc import Callable
from concurrent.futures import CancelledError, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
from typing import Any, Protocol, TypeAlias

from mesa_mobility.errors import ResultsError
from mesa_mobility.experiments.workers.batches import Batch, Finished, run_batch
from mesa_mobility.experiments.workers.one_run import Setup
from mesa_mobility.interrupts import deaf_children
from mesa_mobility.processes import one_thread_each, spawned_pool

Ended: TypeAlias = tuple[Batch, Finished | BaseException]


class WorkerDied(Exception):
    """The process that had a batch has ended without an answer."""


class Workers(Protocol):
    """What does batches.

    Attributes:
        count: workers, as far as known.
        own_processes: whether a worker may be ended without harm to anything else.
        address: of a page that shows what the workers do, or nothing.
    """

    count: int
    own_processes: bool
    address: str

    def submit(self, setup: Setup, batch: Batch) -> None:
        """Have a batch done."""

    def ended(self, seconds: float) -> list[Ended]:
        """Batches that have ended, each with its answer or error; none after so many seconds."""

    def close(self) -> None:
        """End the work; batches that have not ended are dropped."""


class Serial:
    """Batches one after the other in this process."""

    count, own_processes, address = 1, False, ""

    def __init__(self) -> None:
        self._waiting: deque[tuple[Setup, Batch]] = deque()

    def submit(self, setup: Setup, batch: Batch) -> None:
        """Have a batch done."""
        self._waiting.append((setup, batch))

    def ended(self, seconds: float) -> list[Ended]:
        """The next batch, done now."""
        if not self._waiting:
            return []
        setup, batch = self._waiting.popleft()
        try:
            return [(batch, run_batch(setup, batch))]
        except ResultsError as error:
            return [(batch, error)]

    def close(self) -> None:
        """Drop what has not been done."""
        self._waiting.clear()


class Futures:
    """Batches as futures, whose ends are put in a queue.

    Args:
        start: submits a batch.
        count: workers.
        own_processes: whether a worker may be ended without harm to anything else.
        address: of a page that shows what the workers do.
    """

    def __init__(
        self,
        start: Callable[[Setup, Batch], Any],
        count: int,
        *,
        own_processes: bool,
        address: str = "",
    ) -> None:
        self.count, self.own_processes, self.address = count, own_processes, address
        self._start = start
        self._ends: queue.Queue[Any] = queue.Queue()
        self._batches: dict[Any, Batch] = {}

    def submit(self, setup: Setup, batch: Batch) -> None:
        """Have a batch done."""
        future = self._start(setup, batch)
        self._batches[future] = batch
        future.add_done_callback(self._ends.put)

    def ended(self, seconds: float) -> list[Ended]:
        """Batches that have ended."""
        found: list[Ended] = []
        try:
            found.append(self._answer(self._ends.get(timeout=seconds)))
            while True:
                found.append(self._answer(self._ends.get_nowait()))
        except queue.Empty:
            return found

    def close(self) -> None:
        """Drop what has not been begun."""
        for future in self._batches:
            future.cancel()

    def error_of(self, error: BaseException) -> BaseException:
        """An error as the driver takes it."""
        return error

    def _answer(self, future: Any) -> Ended:
        batch = self._batches.pop(future)
        try:
            return batch, future.result()
        except (Exception, CancelledError) as error:
            return batch, self.error_of(error)


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
        self._held: list[set[Future[Finished]]] = [set() for _ in range(count)]

    def close(self) -> None:
        """End the processes."""
        super().close()
        for pool in self._pools:
            _kill(pool)
        self._around.close()

    def error_of(self, error: BaseException) -> BaseException:
        """An error as the driver takes it."""
        return WorkerDied() if isinstance(error, BrokenProcessPool) else error

    def _to_the_idlest(self, setup: Setup, batch: Batch) -> Future[Finished]:
        for held in self._held:
            held.difference_update([future for future in held if future.done()])
        at = min(range(self.count), key=lambda k: len(self._held[k]))
        # Processes are started when a batch is submitted.
        with deaf_children():
            try:
                future = self._pools[at].submit(run_batch, setup, batch)
            except BrokenProcessPool:
                self._pools[at].shutdown(wait=False)
                self._pools[at] = spawned_pool(1)
                future = self._pools[at].submit(run_batch, setup, batch)
        self._held[at].add(future)
        return future


def _kill(pool: ProcessPoolExecutor) -> None:
    """End a pool's process at once: what it has finished is in its journal."""
    processes = list((getattr(pool, "_processes", None) or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for process in processes:
        process.kill()
    for process in processes:
        process.join()
