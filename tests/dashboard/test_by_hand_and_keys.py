"""The crowd's canvas under pointer, wheel, fingers and keys; on a phone; in the dark."""

import re

import numpy as np
import pytest

from tests.dashboard.selectors import CANVAS, CLUSTER, DECISION, SHOWN

SELECTED = f"() => {SHOWN}.selected"


def view(tab):
    return tab.shown()["view"]


def box(tab):
    return tab.page.locator(".mm-crowd-canvas").bounding_box()


def middle(tab):
    where = box(tab)
    return where["x"] + where["width"] / 2, where["y"] + where["height"] / 2


def opened(tab, name):
    return tab.page.evaluate(
        "(name) => document.querySelector('.mm-crowd').__vue__.floor.openings"
        ".find((each) => each.name === name).open",
        name,
    )


@pytest.mark.thorough
def test_a_door_is_closed_by_its_name_although_people_stand_there(tab):
    plate = next(each for each in tab.shown()["plates"] if each["name"] == "first door")
    where = box(tab)
    # As many people as there are, all right below the name.
    tab.page.evaluate(
        """([x, y]) => {
            const vue = document.querySelector('.mm-crowd').__vue__, people = vue.to.people;
            const [mx, my] = vue.metres({ clientX: x, clientY: y });
            for (let k = 0; k < people.length; k += 6) [people[k + 1], people[k + 2]] = [mx, my];
        }""",
        [where["x"] + plate["x"], where["y"] + plate["y"]],
    )
    tab.page.mouse.click(where["x"] + plate["x"], where["y"] + plate["y"])
    tab.page.get_by_role("button", name="first door: door, closed").wait_for()
    assert not opened(tab, "first door")
    assert tab.shown()["selected"] == -1
    tab.page.get_by_role("button", name="first door: door, closed").click()
    tab.page.get_by_role("button", name="first door: door, open").wait_for()
    assert opened(tab, "first door")


@pytest.mark.thorough
def test_only_the_wheel_with_ctrl_zooms_and_the_page_scrolls_without(tab):
    tab.page.set_viewport_size({"width": 1100, "height": 600})
    tab.wait(f"() => !{SHOWN}.moving")
    tab.page.mouse.move(*middle(tab))
    before, top = view(tab), box(tab)["y"]
    tab.page.mouse.wheel(0, 120)
    tab.wait(f"(y) => {CANVAS}.getBoundingClientRect().top < y - 60", top)
    assert view(tab) == before
    tab.page.mouse.move(*middle(tab))
    tab.page.keyboard.down("Control")
    tab.page.mouse.wheel(0, -250)
    tab.page.keyboard.up("Control")
    tab.comes_to(f"() => {SHOWN}.view.scale", pytest.approx(before["scale"] * np.exp(0.5)))


@pytest.mark.thorough
def test_the_view_outlasts_another_size_and_another_tab(tab):
    tab.button("zoom in").click()
    tab.button("zoom in").click()
    before = view(tab)
    wide = box(tab)["width"]
    tab.page.set_viewport_size({"width": 1300, "height": 800})
    tab.wait(f"(w) => {CANVAS}.getBoundingClientRect().width !== w", wide)
    tab.page.get_by_role("tab", name="Mobility map").click()
    tab.wait(f"() => {CANVAS}.offsetParent === null")
    tab.page.get_by_role("tab", name="Simulation").click()
    tab.wait(f"() => {CANVAS}.offsetParent !== null")
    assert view(tab) == before
    tab.button("Fit").click()
    assert view(tab)["scale"] != before["scale"]


def test_keys_play_move_zoom_and_deselect(tab):
    page = tab.page
    # While a model is made, Play is off, and the first button that is on gets the focus.
    tab.wait(
        "() => [...document.querySelectorAll('.mm-time button')].some("
        "(b) => /play/i.test(b.innerText) && !b.disabled)"
    )
    page.locator("body").press("Tab")
    tab.expect(page.get_by_text("Skip to the crowd")).to_be_focused()
    page.keyboard.press("Enter")
    tab.expect(tab.button("Play")).to_be_focused()
    tab.click_person(23)
    tab.expect(page.locator(".mm-crowd-canvas")).to_be_focused()
    page.keyboard.press("Escape")
    tab.wait(f"{SELECTED} === -1")
    page.keyboard.press("Space")
    tab.button("Pause").wait_for()
    page.keyboard.press("Space")
    tab.button("Play").wait_for()
    before = view(tab)
    page.keyboard.press("+")
    assert view(tab)["scale"] == pytest.approx(1.25 * before["scale"])
    page.keyboard.press("ArrowRight")
    assert view(tab)["x"] > before["x"]
    page.keyboard.press("ArrowUp")
    assert view(tab)["y"] > before["y"]
    page.keyboard.press("0")
    assert view(tab) == before


@pytest.mark.thorough
def test_every_control_has_a_name_and_the_page_a_language(tab):
    tab.expect(tab.page.locator("html")).to_have_attribute("lang", "en")
    nameless = """() => [...document.querySelectorAll("button, a, input, [tabindex='0']")]
        .filter((e) => e.offsetParent && e.type !== "hidden")
        .filter((e) => !(e.ariaLabel || e.innerText || e.labels?.[0]?.innerText || e.title))
        .map((e) => e.outerHTML)"""
    tab.comes_to(nameless, [])


@pytest.mark.thorough
def test_a_phone_shows_the_crowd_and_two_fingers_zoom(open_tab):
    tab = open_tab(width=420, height=800, has_touch=True, is_mobile=True)
    # It is drawn open until the page knows how narrow it is.
    tab.wait("() => !document.querySelector('.v-navigation-drawer--open')")
    tab.wait("() => document.getAnimations().every((each) => each.playState !== 'running')")
    tab.wait(
        """() => {
            const [play, speed] = [".mm-time button", ".mm-time .mm-entry label"]
                .map((what) => document.querySelector(what).getBoundingClientRect());
            return speed.top >= play.bottom || speed.left >= play.right;
        }"""
    )
    before, (x, y) = view(tab), middle(tab)
    touch = tab.page.context.new_cdp_session(tab.page)

    def fingers(kind, *places):
        points = [{"x": px, "y": py, "id": k} for k, (px, py) in enumerate(places)]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    fingers("touchStart", (x - 50, y), (x + 50, y))
    fingers("touchMove", (x - 75, y), (x + 75, y))
    fingers("touchMove", (x - 100, y), (x + 100, y))
    fingers("touchEnd")
    tab.comes_to(f"() => {SHOWN}.view.scale", pytest.approx(2.0 * before["scale"]))
    # One finger is the page's.
    before, top = view(tab), box(tab)["y"]
    fingers("touchStart", (x, y))
    for k in range(1, 6):
        fingers("touchMove", (x, y - 20 * k))
    fingers("touchEnd")
    tab.wait(f"(y) => {CANVAS}.getBoundingClientRect().top < y - 30", top)
    assert view(tab) == before


@pytest.mark.thorough
def test_a_dark_page_has_a_dark_floor(open_tab):
    tab = open_tab(color_scheme="dark")
    tab.wait("() => document.querySelector('.mm-crowd').classList.contains('mm-dark')")
    tab.wait(
        f"""() => {{
            const pixel = {CANVAS}.getContext('2d').getImageData(3, 120, 1, 1).data;
            return Math.max(...pixel.slice(0, 3)) < 80;
        }}"""
    )


DARK_GROUND = """(canvas) => {
    const ctx = canvas.getContext('2d');
    const pixel = ctx.getImageData(canvas.width - 4, canvas.height / 3, 1, 1).data;
    return Math.max(...pixel.slice(0, 3)) < 80 && pixel[3] === 255;
}"""


@pytest.mark.thorough
def test_a_dark_page_has_a_dark_decision_and_a_dark_cluster(open_tab):
    tab = open_tab(color_scheme="dark")
    tab.step(2)
    tab.click_person(int(tab.people()[0, 0]))
    tab.wait(f"() => ({DARK_GROUND})({DECISION})")
    tab.page.get_by_role("tab", name="Mobility map").click()
    tab.wait(f"() => {CLUSTER}?.shown?.().options > 0 && ({DARK_GROUND})({CLUSTER})")
    spine = tab.page.locator(".mm-cluster svg line").last
    tab.expect(spine).to_have_attribute("stroke", "#eeeeee")


@pytest.mark.thorough
def test_a_page_that_turns_dark_draws_the_decision_anew(tab):
    tab.step(2)
    tab.click_person(int(tab.people()[0, 0]))
    tab.wait(f"() => !({DARK_GROUND})({DECISION})")
    tab.page.emulate_media(color_scheme="dark")
    tab.wait(f"() => ({DARK_GROUND})({DECISION})")


@pytest.mark.slow
def test_a_run_that_has_stalled_goes_on_when_its_door_is_opened_again(tab):
    tab.set("pedestrians", "3")
    tab.wait(f"() => {SHOWN}.inside === 3")
    tab.page.get_by_role("button", name="second door: exit, open").click()
    tab.choose("speed", "full")
    tab.button("Play").click()
    tab.page.get_by_text(re.compile("^stalled: every exit is closed")).wait_for()
    tab.wait(f"() => !{SHOWN}.moving")
    stalled = tab.shown()["elapsed"]
    tab.page.get_by_role("button", name="second door: exit, closed").click()
    tab.page.get_by_role("button", name="second door: exit, open").wait_for()
    tab.step(1)
    assert tab.shown()["elapsed"] == pytest.approx(stalled + 0.1)
    tab.button("Play").click()
    tab.wait(f"() => {SHOWN}.inside === 0")
