"""A cache that computes each value once."""

import threading
import time

import pytest

from mesa_mobility._once import cached_once


def test_threads_that_ask_together_get_one_value():
    made = []

    @cached_once(maxsize=4)
    def make(name):
        made.append(name)
        time.sleep(0.05)  # long enough for the others to ask, too
        return object()

    start, found = threading.Barrier(8), []

    def ask():
        start.wait()
        found.append(make("a"))

    threads = [threading.Thread(target=ask) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert made == ["a"]
    assert len(found) == 8
    assert len(set(map(id, found))) == 1


def test_the_value_asked_for_longest_ago_is_made_anew():
    made = []

    @cached_once(maxsize=2)
    def make(number, *, twice=False):
        """Double it or not."""
        made.append(number)
        return 2 * number if twice else number

    assert [make(1), make(2), make(1), make(3), make(1), make(2)] == [1, 2, 1, 3, 1, 2]
    assert made == [1, 2, 3, 2]
    assert make(2, twice=True) == 4
    assert make.__doc__ == "Double it or not."


def test_an_error_is_not_kept_and_locks_nobody_out():
    tries = []

    @cached_once(maxsize=1)
    def make():
        tries.append(None)
        if len(tries) == 1:
            raise ValueError("not yet")
        return "made"

    with pytest.raises(ValueError, match="not yet"):
        make()
    # From another thread: a lock that was left taken would hold it for ever.
    found = []
    thread = threading.Thread(target=lambda: found.append(make()), daemon=True)
    thread.start()
    thread.join(10.0)
    assert found == ["made"]
