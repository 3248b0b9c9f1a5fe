"""Users' own pages, and cleaning up when pages are closed."""

import time
from pathlib import Path

import numpy as np
import pytest
from mesa_mobility.models import Doorway

from mesa_mobility.crowd import FREE
from tests.dashboard.selectors import CANVAS, SHOWN
from tests.fixtures import face_to_face
from tests.fixtures.waiting import until

MODEL = '''
from mesa_mobility import Exit, FloorPlan, PedestrianModel


class Room(PedestrianModel):
    """A room.

    Args:
        pedestrians: people.
    """

    def __init__(self, pedestrians: int = 9, rng: int | None = None):
        plan = FloorPlan(
            "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))", exits=[Exit("door", (10, 3), (10, 5))]
        )
        super().__init__(plan, rng=rng)
        self.add_pedestrians(plan.random_points(pedestrians, self.rng, spacing=0.5, clearance=0.3))

'''
OWN = MODEL + "from mesa_mobility.dashboard import Dashboard\n\npage = Dashboard(Room)\n"
MESA = (
    MODEL
    + "from mesa.visualization import SolaraViz\n"
    + "from mesa_mobility.dashboard import make_crowd_view\n\n"
    + "page = SolaraViz(Room(rng=5), components=[make_crowd_view('density')])\n"
)
FORBIDDING = """
import numpy as np

from mesa_mobility import CostTerm


class Forbidding(CostTerm):
    name = "forbidding"

    def cost(self, candidates):
        return np.where(candidates.headings > candidates.facings[candidates.owner], 1e200, 0.0)


class Model(Room):
    def __init__(self, rng: int | None = None):
        super().__init__(rng=rng)
        self.terms.append(Forbidding())
"""
FORBIDDEN = (
    MODEL
    + FORBIDDING
    + "\n\nfrom mesa_mobility.dashboard import Dashboard\n\npage = Dashboard(Model)\n"
)
BLOCKED = (
    "from blocked import FaceToFace\nfrom mesa_mobility.dashboard import Dashboard\n\n"
    "page = Dashboard(FaceToFace)\n"
)
ELAPSED = f"{SHOWN}.elapsed"
VIEW = "document.querySelector('.mm-decision').__vue__"
COLOURS = f"Array.from({VIEW}.o.totals, (_, k) => {VIEW}.colour(k))"
PLACE = f"(({{ x, y, width, height }}) => [x, y, width, height])({CANVAS}.getBoundingClientRect())"


@pytest.mark.thorough
def test_a_model_of_somebodys_own_has_a_page(start_server, open_tab):
    tab = open_tab(start_server(OWN).address)
    assert tab.shown()["inside"] == 9
    tab.set("pedestrians", "4")
    tab.wait(f"() => {SHOWN}.inside === 4")
    tab.step(2)
    tab.click_person(2)
    tab.choose("model", "straight_walk")
    tab.wait(f"() => {SHOWN}.inside === 50")


@pytest.mark.thorough
def test_options_that_are_forbidden_have_the_colour_of_the_dearest(start_server, open_tab):
    tab = open_tab(start_server(FORBIDDEN).address)
    tab.click_person(2)
    # Costs go to the page in single precision, in which 1e200 is infinite.
    shown = tab.decision()
    free, infinite = np.array(shown["verdicts"]) == FREE, np.isinf(shown["totals"])
    assert (free & infinite).any()
    assert (free & ~infinite).any()
    colours = np.array(tab.page.evaluate(f"() => {COLOURS}"))
    assert set(colours[free & infinite]) == {"rgb(68,1,84)"}
    assert len(set(colours[free & ~infinite])) > 10


@pytest.mark.thorough
def test_messages_leave_the_crowd_where_it_is(start_server, open_tab):
    blocked = Path(face_to_face.__file__).read_text()
    tab = open_tab(start_server(BLOCKED, blocked=blocked).address, height=600)
    tab.choose("speed", "full")
    tab.button("Play").click()  # the run may have ended before its Pause is seen
    # The clicks may have scrolled the page.
    place = tab.page.evaluate(f"() => {PLACE}")
    standing = tab.page.get_by_text("blocked for a minute: people 0")
    standing.wait_for()
    assert tab.page.evaluate(f"() => {PLACE}") == place
    tab.set("person", "99")
    alert = tab.page.get_by_role("alert").filter(has_text="expected at most 2")
    # Also where the window is too low for the whole page.
    for message in (alert, standing):
        tab.expect(message).to_be_in_viewport(ratio=1.0)
    assert tab.page.evaluate(f"() => {PLACE}") == place


@pytest.mark.thorough
def test_the_crowd_view_is_a_component_for_mesas_own_page(start_server, open_tab):
    tab = open_tab(start_server(MESA).address)
    before = tab.people()
    assert len(before) == 9
    tab.page.get_by_role("button", name="step").first.click()
    tab.wait(f"() => Math.abs({ELAPSED} - 0.1) < 1e-6")
    assert tab.shown()["legend"]["label"].startswith("people within 1 m")
    assert np.abs(tab.people()[:, 1:3] - before[:, 1:3]).max() > 0.0


@pytest.mark.slow
def test_two_models_and_twenty_resets_leave_nothing_behind(open_tab, server):
    tab = open_tab()

    def play_and_reset(model, people, times):
        tab.choose("model", model)
        tab.wait(f"(n) => {SHOWN}.inside === n", people)
        for _ in range(times):
            tab.play()
            tab.wait(f"() => {ELAPSED} > 0.3")
            tab.button("Reset").click()
            tab.at_rest(0.0)

    # The threads that share the work of large crowds come with the first such crowd, and stay.
    play_and_reset("auditorium", 750, 1)
    threads = server.threads()
    play_and_reset("auditorium", 750, 20)
    play_and_reset("doorway", 60, 20)
    assert np.array_equal(tab.people()[:, 0], Doorway(rng=1).rows)
    until(lambda: server.threads() <= threads)


@pytest.mark.slow
def test_closed_tabs_leave_no_thread(open_tab, server):
    keep = open_tab()
    tabs = 8
    threads = server.threads()
    for _ in range(tabs):
        tab = open_tab()
        tab.play()
        tab.wait(f"() => {ELAPSED} > 0.3")
        tab.page.close()
    # The web server keeps a few threads for later; a thread left for each tab would be more.
    end = time.monotonic() + 30.0
    while server.threads() > threads + tabs // 2 and time.monotonic() < end:
        time.sleep(0.2)
    assert server.threads() <= threads + tabs // 2
    assert keep.shown()["elapsed"] == 0.0
