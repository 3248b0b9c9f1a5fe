"""Run jobs on workers, and yield each result as its job ends.

`batch_run`, `verify`, `validate` and experiments do their runs in this way. The result of a job
depends neither on the workers nor on the order in which jobs end.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from mesa_mobility.runs.workers import Ended, WorkerDied, Workers

Job = TypeVar("Job")
Result = TypeVar("Result")

POLL_S = 1.0
"""Seconds after which a caller is told that nothing has ended."""


@dataclass(frozen=True)
class Failed:
    """What a job gives that has not been done.

    Attributes:
        error: its type and message, on one line.
    """

    error: str


def one_line(error: BaseException) -> str:
    """An error's type and message on one line."""
    return " ".join(f"{type(error).__name__}: {error}".split())


def run_jobs(
    function: Callable[[Job], Result], jobs: Iterable[Job], workers: Workers
) -> Iterator[tuple[Job, Result | Failed]]:
    """Do jobs, and yield each with its result as soon as it is there.

    A job that fails, or whose process dies, does not lose the others. Whoever stops taking results
    ends the workers.

    Args:
        function: does a job; importable where workers are other processes.
        jobs: are begun in their order; each is taken when a worker is free for it.
        workers: are closed at the end.
    """
    ahead = iter(jobs)
    try:
        for ended in in_flight(_Attempt(function), lambda: next(ahead, None), workers):
            for job, answer in ended:
                yield job, Failed(_why(answer)) if isinstance(answer, BaseException) else answer
    finally:
        workers.close()


def in_flight(
    function: Callable[[Any], Any],
    following: Callable[[], Any | None],
    workers: Workers,
    each: int = 1,
) -> Iterator[list[Ended]]:
    """Keep workers busy, and yield what has ended, at least once a second.

    Args:
        function: does a job.
        following: gives the next job, or None while there is none; more may come where jobs end.
        workers: are not closed.
        each: jobs that a worker has at a time, the one that it is doing included.
    """
    under_way = 0
    while True:
        while under_way < each * workers.count:
            job = following()
            if job is None:
                break
            workers.submit(function, job)
            under_way += 1
        if not under_way:
            return
        ended = workers.ended(POLL_S)
        under_way -= len(ended)
        yield ended


@dataclass(frozen=True)
class _Attempt(Generic[Job, Result]):
    """Does a job; an error travels as text, since its class may be unknown elsewhere."""

    function: Callable[[Job], Result]

    def __call__(self, job: Job) -> Result | Failed:
        try:
            return self.function(job)
        except Exception as error:
            return Failed(one_line(error))


def _why(error: BaseException) -> str:
    return "its process died" if isinstance(error, WorkerDied) else one_line(error)
