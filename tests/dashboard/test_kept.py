"""Runs that outlive their page."""

import subprocess
import sys

import pytest

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

from mesa_mobility.models import Doorway

from mesa_mobility.dashboard.session import kept
from mesa_mobility.dashboard.session.run_config import Recipe
from mesa_mobility.dashboard.session.session import Session
from tests.fixtures.waiting import until

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


@pytest.mark.thorough
def test_a_page_that_closes_does_not_hold_up_the_others():
    # Solara starts no thread in the context of a closed page, and waits for it for ever.
    done = subprocess.run(
        [sys.executable, "-c", LEFT_WHILE_CLOSING], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr


def opened(key="", recipe=None, behaviours=None):
    session, said = Session(behaviours), []
    session.start()
    session.enter(key)
    session.build(recipe or Recipe(Doorway, {"pedestrians": 6, "rng": 2}), said.append)
    until(lambda: said)
    assert said == [""]
    until(lambda: session.status.value.state == "ready")
    return session


def left(session):
    session.close()
    session.join()
    return session.key.value


def test_a_run_outlives_its_page_and_the_next_page_goes_on_with_it():
    first = opened()
    first.step()
    first.set_behaviour("headway", True, 2.5)
    first.select(3)
    until(lambda: first.selected.value == 3)
    model = first._current.model
    second = opened(left(first))
    assert second._current.model is model
    assert second.key.value == first.key.value
    assert second.frame.value["elapsed"] == pytest.approx(0.1)
    assert second.selected.value == 3
    assert second.set_behaviours.value == {"headway": (True, 2.5)}
    # With another recipe, or a key that nobody has, there is another run.
    third = opened(left(second), Recipe(Doorway, {"pedestrians": 7, "rng": 2}))
    assert third._current.model is not model
    fourth = opened("no such key")
    assert fourth.key.value not in ("no such key", third.key.value)
    left(third), left(fourth)


def test_a_run_that_a_page_shows_is_not_given_away(monkeypatch):
    monkeypatch.setattr("mesa_mobility.dashboard.session.kept.LEAVING_SECONDS", 0.1)
    first = opened()
    first.watched = lambda: True
    second = opened(first.key.value)
    assert second.key.value != first.key.value
    assert second._current.model is not first._current.model
    left(first), left(second)


def test_a_page_that_was_lost_without_a_word_gives_its_run_away():
    first = opened()
    model = first._current.model
    second = opened(first.key.value)
    assert second._current.model is model
    left(second)


def test_runs_are_forgotten_after_a_while(monkeypatch):
    monkeypatch.setattr("mesa_mobility.dashboard.session.kept.KEPT_SECONDS", 0.1)
    first = opened()
    key, model = left(first), first._current.model
    until(lambda: key not in kept._kept)
    second = opened(key)
    assert second._current.model is not model
    left(second)


def test_only_so_many_runs_are_kept(monkeypatch):
    monkeypatch.setattr("mesa_mobility.dashboard.session.kept.KEPT_AT_MOST", 2)
    keys = [left(opened()) for _ in range(3)]
    assert [key in kept._kept for key in keys] == [False, True, True]


def test_weights_of_an_address_are_set_before_the_first_step():
    session = opened(behaviours={"headway": (False, 3.0), "no such term": (True, 1.0)})
    states = {state.name: state for state in session.behaviours.value}
    assert (states["headway"].on, states["headway"].weight) == (False, 3.0)
    assert "headway" not in [term.name for term in session._current.model.terms]
    left(session)
