"""Jobs on Dask: a client, a scheduler's address, a cluster, or a cluster on this machine."""

from __future__ import annotations

import os
import time
from contextlib import ExitStack, suppress
from typing import Any

from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.runs.processes import THREADS, available_processors
from mesa_mobility.runs.workers import Ended, Function, Futures, WorkerDied

_PATIENCE = 30.0
"""Seconds for which a scheduler may be out of reach."""

_COUNT_AGAIN = 10.0
"""Seconds after which workers are counted again: they come and go."""


class DaskWorkers(Futures):
    """Jobs as tasks of a Dask client.

    Args:
        client: of ``dask.distributed``.
    """

    def __init__(self, client: Any) -> None:
        self._client = client
        self._gone_since: float | None = None
        local = _in_this_process(client)
        super().__init__(
            self._task, 1, own_processes=not local, address=client.dashboard_link or ""
        )
        self._count()

    def _task(self, function: Function, job: Any) -> Any:
        # Keys are of the attempt: a key that has failed would not be run again.
        key = f"{getattr(job, 'name', 'job')}-{time.monotonic_ns()}"
        try:
            return self._client.submit(function, job, key=key, pure=False)
        except Exception as error:
            raise self._lost() from error

    def ended(self, seconds: float) -> list[Ended]:
        """Jobs that have ended.

        Raises:
            ResultsError: the scheduler is out of reach.
        """
        found = super().ended(seconds)
        if self._client.status == "running":
            self._gone_since = None
            if time.monotonic() - self._counted > _COUNT_AGAIN:
                self._count()
            return found
        now = time.monotonic()
        self._gone_since = self._gone_since or now
        if self._client.status == "closed" or now - self._gone_since > _PATIENCE:
            raise self._lost()
        return found

    def error_of(self, error: BaseException) -> BaseException:
        """An error as callers take it."""
        from concurrent.futures import CancelledError

        from distributed import KilledWorker
        from distributed.client import FutureCancelledError

        if isinstance(error, KilledWorker):
            return WorkerDied()
        if isinstance(error, FutureCancelledError | CancelledError):
            return self._lost()
        return error

    def _count(self) -> None:
        self._counted = time.monotonic()
        with suppress(OSError):  # a scheduler that has just died is found out elsewhere
            self.count = max(1, sum(self._client.nthreads().values()))

    def _lost(self) -> ResultsError:
        address = getattr(self._client.scheduler, "address", "") or "of this client"
        return ResultsError(f"the scheduler {address} is out of reach")


def dask_workers(executor: Any, count: int | None, closing: ExitStack) -> DaskWorkers:
    """Connect to the workers of a Dask cluster, or start such a cluster on this machine.

    Args:
        executor: a ``Client``, the address of a scheduler, a cluster, or "dask" for a new cluster
            on this machine.
        count: number of workers of a new cluster; by default one for each available processor.
        closing: stack that closes the clients and clusters opened here when it is closed itself.

    Raises:
        ModelError: Dask is not installed, no scheduler or worker answers at the address, or
            ``executor`` is of another kind.
    """
    try:
        from distributed import Client, LocalCluster
        from distributed.deploy import Cluster
    except ImportError as error:
        raise ModelError(
            "running on Dask needs dask.distributed: pip install 'mesa-mobility[cluster]'"
        ) from error
    if isinstance(executor, Client):
        return DaskWorkers(executor)
    if executor == "dask":
        executor = closing.enter_context(
            LocalCluster(
                n_workers=count or available_processors(),
                threads_per_worker=1,
                env={THREADS: "1"},
                dashboard_address="127.0.0.1:0",
            )
        )
    if not isinstance(executor, str | Cluster):
        raise ModelError(
            f"executor is {executor!r}, expected serial, processes, dask, the address of a "
            "scheduler, or a client, cluster or executor"
        )
    if isinstance(executor, str) and ":" not in executor:
        raise ModelError(
            f"executor is {executor!r}, expected serial, processes, dask or the address of a "
            "scheduler such as tcp://host:8786"
        )
    try:
        client = closing.enter_context(Client(executor, timeout="10s", set_as_default=False))
        client.wait_for_workers(1, timeout=60)
    except (OSError, ValueError, TimeoutError) as error:
        raise ModelError(
            f"scheduler {executor}: no answer, or no worker: "
            f"{' '.join(str(error).split()) or type(error).__name__}"
        ) from error
    return DaskWorkers(client)


def _in_this_process(client: Any) -> bool:
    """Whether a worker runs in this process, which must not be ended then."""
    return os.getpid() in client.run(os.getpid).values()
