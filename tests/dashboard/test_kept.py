"""Runs that outlive their page."""

import subprocess
import sys

import pytest

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

LEFT_WHILE_CLOSING = """
import contextlib
import solara.server.app
from solara.server import kernel_context

from mesa_mobility.dashboard.session import kept
from mesa_mobility.dashboard.session.run_config import Making

class Closing(contextlib.nullcontext):
    "A page's context that closes between two looks at its kernel."

    id = "closing"
    looks = 0

    @property
    def kernel(self):
        self.looks += 1
        return object() if self.looks == 1 else None

class Recipe:
    def make(self):
        return "a model"

kernel_context.set_current_context(Closing())
kept.leave("key", object())
key, run = kept.enter("key", object())
assert key == "key" and run is not None
making = Making(Recipe())
assert making.done.wait(5.0) and making.model() == "a model"
"""


def test_a_page_that_closes_does_not_hold_up_the_others():
    # Solara starts no thread in the context of a closed page, and waits for it for ever.
    done = subprocess.run(
        [sys.executable, "-c", LEFT_WHILE_CLOSING], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
