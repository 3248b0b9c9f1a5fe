"""Somebody is steered with keys while they are held; the crowd makes way."""

import math

import numpy as np
import pytest

from mesa_mobility import Exit, FloorPlan
from tests.dashboard.selectors import SHOWN
from tests.fixtures.maps import shipped_map
from tests.fixtures.scenes import model_of, put
from tests.fixtures.waiting import until

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz,test]'")

from mesa_mobility.dashboard.session.run import ByHand

BOX = "document.querySelector('.mm-bodies .mm-box')"
BODIES = f"{BOX}.shown()"


@pytest.fixture
def hall():
    """A hall with a door in its right wall."""
    plan = FloorPlan(
        "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))", exits=[Exit("door", (10, 3.5), (10, 4.5))]
    )
    return model_of(plan, shipped_map(), record=False)


def steps(model, seconds):
    for _ in range(round(30 * seconds)):
        model.step()


def place_of(model, row):
    return np.array([model.crowd.x[row], model.crowd.y[row]])


def test_somebody_walks_at_its_own_speed_stands_and_goes_on_as_before(hall):
    hand = ByHand(hall)
    row = put(hall, 2.0, 2.0, heading=math.pi / 2, preferred_speeds=1.0).row
    hand.steer(row, (0.0, 5.0))
    steps(hall, 3.0)
    x, y = place_of(hall, row)
    # 1 m/s whatever the length of the direction, but for the first steps.
    assert abs(x - 2.0) < 0.3
    assert 2.0 < y - 2.0 < 3.1
    hand.steer(row, (0.0, 0.0))
    steps(hall, 2.0)
    stopped = place_of(hall, row)
    steps(hall, 2.0)
    assert math.dist(place_of(hall, row), stopped) < 0.1
    hand.release()
    steps(hall, 12.0)
    assert not hall.crowd.active[row]


def test_of_two_the_one_steered_before_is_handed_back(hall):
    hand = ByHand(hall)
    one, other = put(hall, 5.0, 3.0).row, put(hall, 2.0, 6.0).row
    hand.steer(one, (0.0, 0.0))
    hand.steer(other, (0.0, 0.0))
    steps(hall, 8.0)
    assert not hall.crowd.active[one]
    assert math.dist(place_of(hall, other), (2.0, 6.0)) < 0.3
    # Who has left, was never there, or is to walk nowhere at all, is steered no further.
    for row, direction in ((one, (1.0, 0.0)), (10**9, (1.0, 0.0)), (other, (math.nan, 0.0))):
        hand.steer(row, direction)
    steps(hall, 12.0)
    assert not hall.crowd.active[other]


def test_a_model_is_as_it_was_made_until_somebody_is_steered(hall):
    before = list(hall.tactics)
    hand = ByHand(hall)
    hand.release()
    hand.steer(0, (1.0, 0.0))  # nobody is there
    assert hall.tactics == before
    put(hall, 2.0, 4.0)
    hand.steer(0, (1.0, 0.0))
    assert [each.name for each in hall.tactics if each not in before] == [
        "walking_orders",
        "steering",
    ]


def test_another_selection_and_the_end_of_the_page_hand_back(session):
    until(lambda: session.status.value.state == "ready")
    runs = []
    session.post(runs.append)
    until(lambda: runs)
    hand, (one, other) = runs[0].hand, runs[0].model.rows[:2].tolist()
    session.steer(one, (0.0, 1.0))
    until(lambda: hand.row == one)
    session.select(one)
    session.steer(other, (1.0, 0.0), session.run_number + 1)  # of another run than the one shown
    done = []
    session.post(done.append)
    until(lambda: done)
    assert hand.row == one
    session.select(other)
    until(lambda: hand.row == -1)
    session.steer(other, (1.0, 0.0))
    until(lambda: hand.row == other)
    session.close()
    session.join()
    assert hand.row == -1


def held(tab, keys, seconds):
    """Hold keys for some simulated seconds while time goes by."""
    until = tab.shown()["elapsed"] + seconds
    for key in keys:
        tab.page.keyboard.down(key)
    tab.wait(f"(t) => {SHOWN}.elapsed >= t", until)


def where(tab, row):
    return next(each for each in tab.people() if each[0] == row)[1:3]


@pytest.fixture
def chosen(tab):
    """A tab on a few people in the doorway's room, one of whom is selected: the one on the left."""
    tab.set("pedestrians", "5")
    tab.wait(f"() => {SHOWN}.inside === 5 && {SHOWN}.elapsed === 0")
    row = int(min(tab.people(), key=lambda each: each[1])[0])
    tab.click_person(row)
    return tab, row


@pytest.mark.slow
def test_keys_steer_the_selected_person_and_letting_them_go_hands_it_back(chosen):
    tab, row = chosen
    tab.page.get_by_text(f"W A S D or arrow keys steer person {row}").wait_for()
    view = tab.shown()["view"]
    # The room is 8 m wide or more: three metres up or down are always there.
    key, way = ("w", 1) if where(tab, row)[1] < 5 else ("s", -1)
    tab.play()
    # It ends the movement that it has begun.
    held(tab, [key], 2.0)
    tab.page.get_by_text(f"person {row} is steered").wait_for()
    assert tab.shown()["steered"] == [0, way]
    begin = where(tab, row)
    held(tab, [key], 1.0)
    x, y = where(tab, row) - begin
    assert way * y > 0.3
    assert abs(x) < 0.5 * abs(y)
    tab.page.keyboard.up(key)
    tab.page.get_by_text(f"W A S D or arrow keys steer person {row}").wait_for()
    assert tab.shown()["steered"] is None
    # It leaves as the others do, and arrows have moved nobody's view.
    tab.choose("speed", "20 x")
    tab.wait(f"() => {SHOWN}.inside === 0")
    assert tab.shown()["view"] == view


@pytest.mark.slow
def test_arrow_keys_steer_and_move_the_floor_when_nobody_is_selected(chosen):
    tab, _ = chosen
    before = tab.shown()["view"]
    tab.page.keyboard.down("ArrowRight")
    tab.page.keyboard.down("ArrowUp")
    half = math.sqrt(0.5)
    assert tab.shown()["steered"] == pytest.approx([half, half])
    tab.page.keyboard.down("ArrowLeft")
    assert tab.shown()["steered"] == pytest.approx([0, 1])
    for key in ("ArrowRight", "ArrowUp", "ArrowLeft"):
        tab.page.keyboard.up(key)
    assert (tab.shown()["steered"], tab.shown()["view"]) == (None, before)
    tab.page.keyboard.press("Escape")
    tab.wait(f"() => {SHOWN}.selected === -1")
    tab.page.keyboard.press("ArrowRight")
    assert tab.shown()["view"]["x"] > before["x"]


@pytest.mark.slow
def test_who_is_deselected_or_whose_page_loses_the_focus_is_handed_back(chosen):
    tab, _ = chosen
    tab.page.keyboard.down("w")
    assert tab.shown()["steered"] == [0, 1]
    tab.page.evaluate("() => window.dispatchEvent(new Event('blur'))")
    assert tab.shown()["steered"] is None
    tab.page.keyboard.up("w")
    tab.page.keyboard.down("d")
    assert tab.shown()["steered"] == [1, 0]
    tab.page.keyboard.press("Escape")
    tab.wait(f"() => {SHOWN}.selected === -1 && {SHOWN}.steered === null")
    # Nor are letters that are typed into a field for anybody.
    tab.page.keyboard.up("d")
    tab.set("door width", "1.2")


@pytest.mark.slow
def test_in_three_dimensions_ahead_is_where_the_view_looks(chosen):
    tab, row = chosen
    tab.button("three dimensions").click()
    tab.wait(f"() => {BOX} && ({BODIES}.ready || {BODIES}.trouble)")
    if tab.page.evaluate(f"() => {BODIES}.trouble"):
        pytest.skip("this browser draws without WebGL")
    tab.wait(f"(row) => {BODIES}.drawn > 0 && {BODIES}.selected === row", row)
    tab.page.locator(".mm-bodies .mm-box").focus()
    tab.button("Above").click()
    tab.page.keyboard.down("w")
    assert tab.page.evaluate(f"() => {BODIES}.steered") == pytest.approx([0, 1], abs=1e-6)
    tab.page.keyboard.up("w")
    tab.button("Orbit").click()
    tab.page.wait_for_timeout(200)
    tab.page.keyboard.down("w")
    ahead = tab.page.evaluate(f"() => {BODIES}.steered")
    # The view from anywhere begins at (0.31, -0.77) from the middle and looks there.
    assert ahead == pytest.approx(np.array([-0.31, 0.77]) / math.hypot(0.31, 0.77), abs=0.02)
    tab.page.keyboard.up("w")
    assert tab.page.evaluate(f"() => {BODIES}.steered") is None
