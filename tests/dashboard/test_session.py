"""The thread behind a page: what it publishes, and that it ends."""

import re
import threading
import time
from pathlib import Path
from typing import Annotated

import numpy as np
import pytest

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

from mesa_mobility.models import Doorway, OpenSpace

from mesa_mobility import CostTerm, Files, Range
from mesa_mobility.dashboard.offered import blamed, large, recipe_of, settable
from mesa_mobility.dashboard.session import kept
from mesa_mobility.dashboard.session.clock import FULL_SPEED
from mesa_mobility.dashboard.session.run_config import Recipe
from mesa_mobility.dashboard.session.session import IF_NOW, Session
from mesa_mobility.dashboard.views.charts import charts, csv_text
from mesa_mobility.errors import ModelError


class Faulty(CostTerm):
    """Fails in its own way."""

    name = "faulty"

    def cost(self, candidates):
        raise KeyError("no such thing")


class DoorwayWithAFault(Doorway):
    """A doorway with a term that fails."""

    def __init__(self, rng=None):
        super().__init__(pedestrians=3, rng=rng)
        self.terms.append(Faulty())


def until(condition, seconds=60.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.01)


@pytest.fixture
def session():
    session = Session()
    session.start()
    session.build(Recipe(Doorway, {"pedestrians": 12, "rng": 3}))
    until(lambda: session.status.value.state == "ready")
    yield session
    session.close()


def frame_people(session):
    import base64

    flat = np.frombuffer(base64.b64decode(session.frame.value["people"]), dtype="<f4")
    return flat.reshape(-1, 5)


def answering(session):
    """Has the page answer each frame at once, as a browser does."""
    publish = session.frame.set

    def set_and_answer(frame):
        publish(frame)
        session.seen(frame["number"])

    session.frame.set = set_and_answer


def test_a_closed_session_leaves_no_thread():
    before = set(threading.enumerate())
    for _ in range(5):
        session = Session()
        session.start()
        session.build(Recipe(Doorway, {"pedestrians": 5, "rng": 1}))
        session.set_speed(FULL_SPEED)
        session.play(True)
        session.close()
    until(lambda: not [t for t in set(threading.enumerate()) - before if "page" in t.name])


def test_frames_carry_the_crowd(session):
    model = Doorway(pedestrians=12, rng=3)
    assert frame_people(session)[:, 1:3] == pytest.approx(
        np.column_stack([model.crowd.x[:12], model.crowd.y[:12]]), abs=1e-5
    )
    session.step()
    until(lambda: session.frame.value["elapsed"] > 0.0)
    model.step()
    assert frame_people(session)[:, 1:3] == pytest.approx(
        np.column_stack([model.crowd.x[:12], model.crowd.y[:12]]), abs=1e-5
    )


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


def test_a_term_that_fails_stops_the_run_and_is_told(caplog):
    session = Session()
    session.start()
    session.build(Recipe(DoorwayWithAFault, {"rng": 1}))
    session.play(True)
    until(lambda: session.problem.value)
    assert session.problem.value == "KeyError: 'no such thing'"
    until(lambda: session.status.value.state == "failed")
    session.set_behaviour("faulty", False, 1.0)
    session.reset()
    until(lambda: session.status.value.state == "ready")
    session.step()
    until(lambda: session.frame.value["elapsed"] > 0.0)
    assert session.problem.value == ""
    session.close()


def test_a_run_to_its_end_counts_everybody(session):
    answering(session)
    session.set_speed(FULL_SPEED)
    session.play(True)
    until(lambda: session.status.value.state == "finished")
    _, observer = session.series.value
    columns = observer.columns()
    assert columns["inside"][0] == 12
    assert columns["inside"][-1] == 0
    assert columns["passed first door"][-1] == 12
    assert columns["passed second door"][-1] == 12
    # What has flowed in windows side by side is what has passed.
    seconds = len(columns["elapsed"]) - 2
    flowed = 10.0 * sum(columns["flow first door"][k] for k in range(seconds, 0, -10))
    assert flowed == pytest.approx(columns["passed first door"][seconds])
    unit, inside = charts(observer)["People inside"]
    assert unit == "people"
    assert csv_text(inside).splitlines()[:2] == ["elapsed_s,inside", "0.0,12"]


def test_a_page_that_no_longer_answers_holds_the_run(session, monkeypatch):
    monkeypatch.setattr("mesa_mobility.dashboard.session.view_state.PATIENCE", 0.3)
    session.set_speed(FULL_SPEED)
    session.play(True)
    until(lambda: session._sent > session._seen)
    time.sleep(0.8)
    held = session._current.model.elapsed
    time.sleep(0.5)
    assert session._current.model.elapsed == held
    answering(session)
    session.seen(session._sent)
    until(lambda: session.status.value.state == "finished")


def test_decisions_are_told_as_taken_and_as_they_would_be(session):
    session.step()
    session.select(4)
    until(lambda: session.decision.value.get("pedestrian") == 4)
    assert not session.decision.value["taken"]
    session.play_to_decision()
    until(lambda: session.decision.value.get("taken"))
    until(lambda: session.status.value.state == "ready")
    session.tell(IF_NOW)
    until(lambda: not session.decision.value["taken"])
    session.select(-1)
    until(lambda: session.decision.value == {})


def test_the_decision_of_somebody_who_has_left_goes(session):
    session.select(4)
    until(lambda: session.decision.value.get("pedestrian") == 4)
    answering(session)
    session.set_speed(FULL_SPEED)
    session.play(True)
    until(lambda: session.status.value.state == "finished")
    assert session.decision.value == {"left": 4}
    assert session.selected.value == -1


def test_an_obstacle_goes_and_comes_back_unless_somebody_stands_there(session):
    class Pillar(OpenSpace):
        def __init__(self, rng=None):
            super().__init__(pedestrians=1, rng=rng)
            self.floor_plan.add_obstacle("POLYGON((24 24, 26 24, 26 26, 24 26, 24 24))")

    session.build(Recipe(Pillar, {"rng": 1}))
    until(lambda: session.floor.value["obstacles"])
    assert [each["there"] for each in session.floor.value["obstacles"]] == [True]
    session.toggle_obstacle(0)
    until(lambda: not session.floor.value["obstacles"][0]["there"])
    session.toggle_obstacle(0)
    until(lambda: session.floor.value["obstacles"][0]["there"])
    session.toggle_obstacle(0)
    until(lambda: not session.floor.value["obstacles"][0]["there"])
    session.post(lambda run: run.model.add_pedestrians([(25.0, 25.0)]))
    session.toggle_obstacle(0)
    until(lambda: session.problem.value)
    assert session.problem.value == ("obstacle 0: pedestrian 1 stands there, expected free floor")


def test_recipes_come_from_what_the_constructor_takes():
    recipe = recipe_of(Doorway, {"pedestrians": "7", "door_width": "1.5", "rng": "4"})
    assert recipe.keywords == {"pedestrians": 7, "door_width": 1.5, "rng": 4}
    assert "record" not in settable(Doorway)
    with pytest.raises(ModelError, match="preset: got 'fast', expected paper or default"):
        recipe_of(Doorway, {"preset": "fast"})


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


def test_maps_come_from_the_folder_and_from_nowhere_else(tmp_path, monkeypatch):
    monkeypatch.setattr("mesa_mobility.dashboard.offered.FOLDER", tmp_path)
    outside = tmp_path.parent / "outside.npz"
    outside.write_bytes(b"")
    assert "mobility_map" not in settable(Doorway)
    (tmp_path / "small.npz").write_bytes(b"")
    (tmp_path / "secret.txt").write_text("")
    assert settable(Doorway)["mobility_map"].kinds == (("none", "small.npz"),)
    recipe = recipe_of(Doorway, {"mobility_map": "small.npz"})
    assert recipe.keywords == {"mobility_map": str(tmp_path / "small.npz")}
    assert recipe_of(Doorway, {"mobility_map": "none"}).keywords == {"mobility_map": None}
    said = set()
    for text in ("../outside.npz", "../nowhere.npz", str(outside), "/etc/passwd", "secret.txt"):
        with pytest.raises(ModelError) as refused:
            recipe_of(Doorway, {"mobility_map": text})
        said.add(re.sub("'.*'", "FILE", str(refused.value)))
    # Nothing tells a file that is there from one that is not.
    assert said == {"mobility_map: got FILE, expected none or small.npz"}


def test_the_page_offers_no_file_that_the_author_has_not_offered(tmp_path, monkeypatch):
    monkeypatch.setattr("mesa_mobility.dashboard.offered.FOLDER", tmp_path)
    (tmp_path / "hall.geojson").write_text("")

    class Reader(Doorway):
        def __init__(
            self,
            plan: Annotated[Path | None, Files("*.geojson")] = None,
            notes: Path = Path("notes.txt"),
            rng=None,
        ):
            pass

    known = settable(Reader)
    assert known["plan"].kinds == (("none", "hall.geojson"),)
    assert "notes" not in known
    assert "plan" not in settable(Reader, {"plan": "hall.geojson"})


@pytest.mark.parametrize(
    ("message", "names"),
    [
        ("pedestrians: got 0, expected 1 or more", ["pedestrians"]),
        ("slowest and fastest: got 2 and 1 m/s, expected 0 < slowest", ["slowest", "fastest"]),
        ("the plan leaves room for 3 of 9 pedestrians", []),
        ("TypeError: pedestrians", []),
    ],
)
def test_an_error_is_about_the_parameters_that_its_beginning_names(message, names):
    assert blamed(message, ["slowest", "fastest", "pedestrians"]) == names


def test_large_numbers_are_asked_about_unless_the_author_has_named_them():
    class Hall(Doorway):
        def __init__(
            self,
            pedestrians: Annotated[int, Range(1, 50_000)] = 60,
            visitors: int = 20_000,
            size: float = 1.0,
            rng=None,
        ):
            pass

    def asked(**texts):
        return large(settable(Hall), recipe_of(Hall, texts))

    assert asked(pedestrians="50000", visitors="20000", size="10000", rng="99999999") == {}
    assert asked(pedestrians="50001", visitors="20001", size="10000.5") == {
        "pedestrians": 50001,
        "visitors": 20001,
        "size": 10000.5,
    }
    with pytest.raises(ModelError, match="visitors: got 1000001, expected at most 1000000"):
        asked(visitors="1000001")
