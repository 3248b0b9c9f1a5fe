"""Models in the making: given up, replaced, or impossible."""

import threading
import time
import warnings

import pytest

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

from mesa_mobility.models import Doorway, FloorPlanEgress

from mesa_mobility.dashboard.session.notices import hand_out_warnings
from mesa_mobility.dashboard.session.run_config import Recipe
from mesa_mobility.dashboard.session.session import Session
from tests.fixtures.buildings import two_storeys
from tests.fixtures.waiting import until


def test_what_cannot_be_made_leaves_the_run_alone(session):
    session.step()
    until(lambda: session.frame.value["elapsed"] > 0.0)
    run, said = session.frame.value["run"], []
    session.build(Recipe(Doorway, {"pedestrians": -1}), said.append)
    until(lambda: said)
    assert said == ["pedestrians: got -1, expected 1 or more"]
    until(lambda: session.status.value.state == "ready")
    assert session.frame.value["run"] == run
    assert session.recipe.value.keywords["pedestrians"] == 12


def test_a_building_is_shown_as_its_plane(session, tmp_path):
    office, failed = two_storeys(), []
    office.write_geojson(tmp_path / "office.geojson")
    numbers = {"plan": tmp_path / "office.geojson", "pedestrians": 3, "rng": 1}
    session.build(Recipe(FloorPlanEgress, numbers), failed.append)
    until(lambda: session.recipe.value.kind is FloorPlanEgress)
    until(lambda: session.status.value.state == "ready")
    assert not any(failed)
    # Two levels and a landing.
    assert len(session.floor.value["outline"]) == 3
    assert session.status.value.inside == 3


class Endless(Doorway):
    """Takes for ever to make."""

    started = threading.Event()
    ended = threading.Event()

    def __init__(self, rng=None):
        Endless.started.set()
        try:
            while True:
                time.sleep(0.01)
        finally:
            Endless.ended.set()


class InAFinalizer(Endless):
    """Takes for ever, and is in a finalizer when it is given up."""

    def __init__(self, rng=None):
        class Finalized:
            def __del__(self):
                Endless.started.set()
                while True:
                    time.sleep(0.01)

        Finalized()
        super().__init__(rng)


def test_giving_up_is_not_lost_in_a_finalizer(session, capsys):
    Endless.started.clear()
    Endless.ended.clear()
    session.build(Recipe(InAFinalizer))
    assert Endless.started.wait(10.0)
    session.give_up()
    # The first exception ends the finalizer, the second one the constructor.
    assert Endless.ended.wait(10.0)
    until(lambda: session.status.value.state == "ready")
    assert "GivenUp" not in capsys.readouterr().err


def test_a_model_in_the_making_is_given_up_and_the_run_goes_on(session):
    Endless.started.clear()
    Endless.ended.clear()
    session.build(Recipe(Endless))
    assert Endless.started.wait(10.0)
    until(lambda: session.making.value >= 1.0)
    assert session.status.value.state == "building"
    # Another page's model is made meanwhile.
    other = Session()
    other.start()
    other.build(Recipe(Doorway, {"pedestrians": 3, "rng": 1}))
    until(lambda: other.status.value.state == "ready")
    other.close()
    session.give_up()
    until(lambda: session.status.value.state == "ready")
    assert Endless.ended.wait(10.0)
    session.step()
    until(lambda: session.frame.value["elapsed"] > 0.0)


def test_a_later_wish_for_a_model_gives_up_the_one_before(session):
    Endless.ended.clear()
    session.build(Recipe(Endless))
    session.build(Recipe(Doorway, {"pedestrians": 4, "rng": 1}))
    until(lambda: session.status.value.inside == 4 and session.status.value.state == "ready")


def test_a_first_model_that_cannot_be_made_is_no_model_under_way():
    session, said = Session(), []
    session.start()
    session.build(Recipe(Doorway, {"pedestrians": -1}), said.append)
    until(lambda: said)
    until(lambda: session.status.value.state == "no model")
    session.close()


def test_a_model_without_memory_says_so():
    class Greedy(Doorway):
        def __init__(self, rng=None):
            raise MemoryError

    session, said = Session(), []
    session.start()
    session.build(Recipe(Greedy), said.append)
    until(lambda: said)
    assert said == ["the model needs more memory than there is"]
    session.close()


def test_of_wishes_in_quick_succession_the_last_one_alone_is_made(session):
    """As a slider gives that is moved with the arrow keys."""
    made = []

    class Counted(Doorway):
        def __init__(self, pedestrians=1, rng=None):
            made.append(pedestrians)
            super().__init__(pedestrians=pedestrians, rng=rng)

    until(lambda: time.monotonic() > session._wanted_at + 0.3)
    for pedestrians in range(1, 9):
        session.build(Recipe(Counted, {"pedestrians": pedestrians, "rng": 1}))
        time.sleep(0.05)
    until(lambda: session.status.value.state == "ready" and session.status.value.inside == 8)
    # The first at once, and the one after which nothing came.
    assert made == [1, 8]


class Warns(Doorway):
    """Warns of itself when it is made."""

    def __init__(self, rng=None):
        super().__init__(pedestrians=2, rng=rng)
        warnings.warn("the door is\nnarrow", UserWarning, stacklevel=1)


def test_warnings_of_a_model_are_shown_as_long_as_it_runs(session, monkeypatch, capsys):
    monkeypatch.setattr(warnings, "showwarning", warnings.showwarning)
    with warnings.catch_warnings():
        hand_out_warnings()
        said = []
        for times in (1, 2):
            session.build(Recipe(Warns), said.append)
            until(lambda times=times: len(said) == times)
            assert said == [""] * times
            assert session.notices.value == ("the door is narrow",)
        # No behaviour has a weight: the model warns of that when somebody decides.
        for term in session.behaviours.value:
            session.set_behaviour(term.name, term.on, 0.0)
        session.play(True)
        until(lambda: len(session.notices.value) == 2)
        session.build(Recipe(Doorway, {"pedestrians": 3}), said.append)
        until(lambda: len(said) == 3)
        assert session.notices.value == ()
    assert capsys.readouterr().err == ""
