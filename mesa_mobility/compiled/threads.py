"""The threads that share the work of large crowds; results never depend on their number."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from itertools import pairwise
from typing import TypeVar

from numba import config

Part = TypeVar("Part")
Result = TypeVar("Result")

THREADS: int = config.NUMBA_NUM_THREADS
"""As many as Numba uses: the processors, unless NUMBA_NUM_THREADS says less."""

MANY = 256
"""From this many people on, several threads are used: in smaller crowds they mostly wait for one
another."""

BLOCK = 8_192
"""People in a block of work that takes nanoseconds a person: handing out a part takes 50
microseconds. The size is fixed, not a share for each thread, because sums of floats must not depend
on the number of threads."""


def threads_for(people: int) -> int:
    """Number of threads to use for this many people."""
    return THREADS if people >= MANY else 1


def shares(people: int) -> list[slice]:
    """Equal parts of this many people, one for each thread."""
    threads = threads_for(people)
    if threads == 1:
        return [slice(0, people)]
    ends = [people * k // threads for k in range(threads + 1)]
    return [slice(first, last) for first, last in pairwise(ends)]


def in_threads(work: Callable[[Part], Result], parts: Sequence[Part]) -> list[Result]:
    """``work`` of each part, in several threads; it gains only if it releases Python's lock."""
    return [work(parts[0])] if len(parts) == 1 else list(_pool().map(work, parts))


def by_shares(work: Callable[[slice], Result], people: int) -> list[Result]:
    """``work`` of equal shares of so many people, in order, one by each thread.

    ``work`` gets the slice of a share. Its result for one person must not depend on the others in
    the share.
    """
    return in_threads(work, shares(people))


def by_blocks(work: Callable[[int, int], Result], people: int) -> list[Result]:
    """``work(first, last)`` of each block of people, in order, by all threads."""
    if people <= BLOCK:
        return [work(0, people)]

    def part(starts: range) -> list[Result]:
        return [work(first, min(first + BLOCK, people)) for first in starts]

    # One part for each thread: handing out a block takes longer than moving half of its people.
    starts = range(0, people, BLOCK)
    share = -(-len(starts) // THREADS)
    parts = [starts[k : k + share] for k in range(0, len(starts), share)]
    return [result for results in in_threads(part, parts) for result in results]


@lru_cache(maxsize=1)
def _pool() -> ThreadPoolExecutor:
    """The threads, shared by all models of the process."""
    return ThreadPoolExecutor(THREADS, thread_name_prefix="mesa-mobility")


if hasattr(os, "register_at_fork"):
    # Threads do not survive a fork: the new process would wait for them for ever.
    os.register_at_fork(after_in_child=_pool.cache_clear)
