"""Clicks and texts that arrive when what they were meant for has changed."""

import time

import pytest

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

import solara
from mesa_mobility.models import Doorway, StraightWalk

from mesa_mobility.dashboard.session.run_config import Recipe
from mesa_mobility.dashboard.session.session import Session
from mesa_mobility.dashboard.widgets.fields import TextField


@pytest.fixture
def replaced():
    """A session whose 40 people have just become 3, and the number of the run that went."""
    session = Session()
    session.start()
    show(session, Recipe(Doorway, {"pedestrians": 40, "rng": 3}))
    before = session.frame.value["run"]
    show(session, Recipe(StraightWalk, {"pedestrians": 3, "rng": 3}))
    yield session, before
    session.close()


def show(session, recipe):
    session.build(recipe)
    wait(lambda: session.status.value.state == "ready" and session.recipe.value is recipe)


def wait(condition, seconds=60.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.01)


def stepped(session):
    """Whether the page's thread still executes commands."""
    before = session.status.value.elapsed
    session.step()
    wait(lambda: session.status.value.elapsed > before)


def test_a_person_of_another_crowd_is_not_selected(replaced):
    session, before = replaced
    for row in (1, 35, 5000):
        session.select(row, before)
        stepped(session)
        assert session.selected.value == -1
    session.select(2, session.frame.value["run"])
    stepped(session)
    assert session.selected.value == 2


def test_doors_and_obstacles_of_another_floor_stay_as_they_are(replaced):
    session, before = replaced
    floor = session.floor.value
    session.toggle_opening("exit", before)
    session.toggle_obstacle(7, before)
    stepped(session)
    assert session.floor.value is floor
    assert session.problem.value == ""


def test_a_field_reports_the_text_that_its_event_brings():
    """Not the text that the server knows of, which is an older one while the page is busy."""
    reported = []
    field = TextField("weight", "1", reported.append, says="weight of headway")
    box, context = solara.render(field, handle_error=False)
    (widget,) = box.children
    widget._handle_custom_msg({"event": "done", "data": "2.5"}, [])
    context.close()
    assert reported == ["2.5"]
