"""Starting without looking for garbage."""

import gc
from contextlib import suppress

import pytest

from mesa_mobility._startup import nothing_collected


@pytest.mark.parametrize("collects", [True, False])
def test_garbage_is_looked_for_afterwards_as_before(collects):
    before = gc.isenabled()
    try:
        (gc.enable if collects else gc.disable)()
        with suppress(ValueError), nothing_collected():
            assert not gc.isenabled()
            raise ValueError("bad input")
        assert gc.isenabled() is collects
    finally:
        (gc.enable if before else gc.disable)()
        gc.unfreeze()


def test_what_was_made_within_is_not_gone_through_again():
    try:
        with nothing_collected():
            made = [[] for _ in range(1000)]
        assert gc.get_freeze_count() >= len(made)
    finally:
        gc.unfreeze()
