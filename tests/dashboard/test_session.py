"""The thread behind a page: what it publishes, and that it ends."""

import threading
import time

import numpy as np
import pytest

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

from mesa_mobility.models import Doorway, OpenSpace

from mesa_mobility import CostTerm
from mesa_mobility.dashboard.controls import standing_in_words
from mesa_mobility.dashboard.session.run_config import Recipe
from mesa_mobility.dashboard.session.session import IF_NOW, Session
from mesa_mobility.dashboard.views.charts import charts, csv_text
from mesa_mobility.live.clock import FULL_SPEED
from tests.fixtures.face_to_face import FaceToFace
from tests.fixtures.waiting import until


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


def frame_people(session):
    import base64

    flat = np.frombuffer(base64.b64decode(session.frame.value["people"]), dtype="<f4")
    return flat.reshape(-1, 6)


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


def test_a_term_that_fails_stops_the_run_with_a_message(caplog):
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
    # Flow summed over adjacent windows is the number of people who passed.
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


def test_decisions_are_shown_as_taken_and_as_they_would_be(session):
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


def stalled_session(session):
    """A doorway whose only way out is closed, a minute later."""
    session.build(Recipe(Doorway, {"pedestrians": 2, "rng": 3}))
    until(lambda: session.status.value.inside == 2)
    session.toggle_opening("second door")
    session.set_speed(FULL_SPEED)
    session.play(True)
    until(lambda: session.status.value.state == "stalled", 60)


def test_people_who_block_each_other_are_listed(session):
    session.build(Recipe(FaceToFace, {"rng": 1}))
    until(lambda: session.status.value.inside == 3)
    assert standing_in_words(session.status.value) == ""
    session.set_speed(FULL_SPEED)
    session.play(True)
    until(lambda: session.status.value.blocked, 60)
    assert session.status.value.blocked == ((0, (1, 0)), (1, (0, 1)))
    assert standing_in_words(session.status.value) == (
        "blocked for a minute: people 0 (in the way: 1, 0); 1 (in the way: 0, 1)"
    )


CHANGES = {
    "door": lambda session: session.toggle_opening("second door"),
    "weight": lambda session: session.set_behaviour("headway", True, 2.0),
    "behaviour": lambda session: session.set_behaviour("headway", False, 1.0),
    "choice": lambda session: session.choose_targets_by(session.choice.value.names[-1]),
    "hand": lambda session: session.steer(0, (1.0, 0.0)),
}


@pytest.mark.thorough
@pytest.mark.parametrize("change", CHANGES)
def test_a_run_that_has_stalled_goes_on_after_any_change(session, change):
    stalled_session(session)
    before = session.status.value.elapsed
    session.set_speed(1.0)
    CHANGES[change](session)
    session.step()
    until(lambda: session.status.value.elapsed == pytest.approx(before + 0.1))
    assert session.status.value.state == "ready"
    session.play(True)
    until(lambda: session.status.value.elapsed > before + 0.15)
    assert session.status.value.state == "playing"


def test_somebody_who_is_shut_in_goes_nowhere(session):
    session.select(3)
    until(lambda: session.decision.value.get("pedestrian") == 3)
    assert session.decision.value["goes"] == "They go to second door"
    assert not session.decision.value["lost"]
    session.toggle_opening("second door")
    session.tell(IF_NOW)
    for _ in range(20):  # until their movement has ended
        session.step()
    until(lambda: session.decision.value["lost"])
    assert session.decision.value["goes"] == "There is no way to any exit; they wait"
    assert session.decision.value["target"] == session.decision.value["position"]
