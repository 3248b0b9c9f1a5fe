"""The page without a pointer or without eyes: keys alone, and what a screen reader is told."""

import re
from itertools import pairwise
from pathlib import Path

import pytest

from tests.dashboard.selectors import DECISION, SHOWN

LOOKING = (Path(__file__).parent / "looking.js").read_text(encoding="utf-8")


def looking(page, what):
    """What a function of looking.js finds on a page."""
    return page.evaluate(f"() => {{ {LOOKING}\nreturn {what}(); }}")


def tab_to(page, name, most=90):
    """Press Tab until the control of this name has the focus."""
    for _ in range(most):
        page.keyboard.press("Tab")
        if re.fullmatch(name, looking(page, "focused"), re.IGNORECASE):
            return
    pytest.fail(f"{name} is not reached by Tab; last is {looking(page, 'focused')}")


@pytest.mark.slow
def test_a_session_with_the_keyboard_alone_from_start_to_decision(open_tab):
    """Tab, Enter, Space, arrows and letters: no pointer, and no focus set by the test."""
    tab = open_tab()
    page = tab.page
    tab_to(page, "model")
    run = tab.shown()["run"]
    page.keyboard.type("straight")  # as in any list of a browser
    tab.wait(f"(run) => {SHOWN}.run > run && {SHOWN}.inside === 50", run)
    assert re.fullmatch("model", looking(page, "focused"))
    tab_to(page, "pedestrians")
    page.keyboard.press("Control+a")
    page.keyboard.type("12")
    page.keyboard.press("Enter")
    tab.wait(f"() => {SHOWN}.inside === 12")
    tab_to(page, "play")
    page.keyboard.press("Enter")
    tab.button("Pause").wait_for()
    tab.wait(f"() => {SHOWN}.elapsed > 0.5")
    page.keyboard.press("Enter")
    tab.button("Play").wait_for()
    tab_to(page, "crowd")
    page.keyboard.press("n")
    tab.wait(f"() => {SHOWN}.selected === 0 && {DECISION}.shown()?.pedestrian === 0")
    page.keyboard.press("n")
    tab.wait(f"() => {DECISION}.shown()?.pedestrian === 1")
    page.keyboard.press("p")
    tab.wait(f"() => {DECISION}.shown()?.pedestrian === 0")
    tab_to(page, "next person")
    page.keyboard.press("Enter")
    tab.wait(f"() => {DECISION}.shown()?.pedestrian === 1")
    tab_to(page, "person")
    page.keyboard.press("Control+a")
    page.keyboard.type("7")
    page.keyboard.press("Enter")
    tab.wait(f"() => {DECISION}.shown()?.pedestrian === 7")
    tab_to(page, "to the next decision")
    page.keyboard.press("Enter")
    page.get_by_text("Decision as taken at").wait_for()
    page.get_by_role("table", name="costs").get_by_role("row").nth(3).wait_for()
    tab.expect(page.get_by_role("img", name="movement options of person 7")).to_have_count(1)


@pytest.mark.thorough
def test_tabs_are_turned_by_arrows(tab):
    tab.page.get_by_role("tab", name="Simulation").focus()
    for key, name in (
        ("ArrowRight", "Mobility map"),
        ("End", "Saved run"),
        ("ArrowRight", "Simulation"),
    ):
        tab.page.keyboard.press(key)
        tab.page.get_by_role("tabpanel", name=name).wait_for()
        tab.expect(tab.page.get_by_role("tab", name=name)).to_be_focused()
        tab.expect(tab.page.get_by_role("tab", selected=True)).to_have_text([name])
        tab.expect(tab.page.get_by_role("tabpanel")).to_have_count(1)
    # Charts of the first tab, which was left before they could be drawn, are drawn now.
    tab.page.locator(".solara-echarts canvas").first.wait_for()


@pytest.mark.thorough
def test_only_errors_are_alerts_and_the_status_is_told_politely(tab):
    page = tab.page
    status = page.locator(".mm-status")
    tab.expect(status).to_have_text("ready")
    tab.expect(status).to_have_attribute("role", "status")
    assert page.get_by_role("alert").count() == 0
    tab.play()
    tab.wait(f"() => {SHOWN}.elapsed > 2.2")
    # The pace beside it changes each second, and is not read aloud.
    assert status.inner_text() == "running"
    tab.pause()
    tab.set("pedestrians", "many")
    page.get_by_role("alert").filter(has_text="expected a whole number").wait_for()
    tab.expect(page.get_by_role("alert")).to_have_count(1)
    field = page.get_by_role("textbox", name="pedestrians", exact=True)
    tab.expect(field).to_have_attribute("aria-invalid", "true")


def looked_at(tab):
    """In each tab what is wrong for people who do not see it."""
    found = []
    for name in ("Simulation", "Mobility map", "Drawing board", "Saved run"):
        tab.turn_to(name)
        tab.page.wait_for_timeout(300)
        tab.wait("() => document.getAnimations().every((each) => each.playState !== 'running')")
        found += [f"{name}, {each}" for each in looking(tab.page, "nameless")]
        found += [f"{name}, contrast {each}" for each in looking(tab.page, "faint")]
        levels = looking(tab.page, "levels")
        assert (levels[0], levels.count(1)) == (1, 1)
        assert all(after <= before + 1 for before, after in pairwise(levels))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_names_roles_headings_and_contrast(open_tab, scheme):
    tab = open_tab(color_scheme=scheme)
    tab.step(2)
    tab.click_person(23)
    assert looked_at(tab) == []
    tab.expect(tab.page).to_have_title("doorway - mesa-mobility")
    tab.expect(tab.page.locator("html")).to_have_attribute("lang", "en")


@pytest.mark.thorough
def test_what_has_the_focus_is_seen(tab):
    """Each stop of Tab has an outline of 2 pixels or more that stands out."""
    page, bare = tab.page, []
    page.evaluate("() => document.body.focus()")
    for _ in range(60):
        page.keyboard.press("Tab")
        bare += looking(page, "bareFocus")
    assert bare == []


def test_the_next_person_is_the_one_with_the_next_number(session):
    from tests.fixtures.waiting import until

    for by, row in ((1, 0), (1, 1), (-1, 0), (-1, 11), (1, 0)):
        session.select_beside(by)
        until(lambda row=row: session.selected.value == row)
    session.select(12)
    until(lambda: session.problem.value == "person: got 12, expected at most 11")
    assert session.selected.value == 0
