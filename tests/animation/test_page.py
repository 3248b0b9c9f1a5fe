"""The page that plays a run, in a browser without a network."""

import os
import shutil

import pytest

from mesa_mobility.animation import Selection, walkers, write_page

PROGRAMS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
DRAWN_BY_THE_PROCESSOR = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")


@pytest.fixture
def page(run, plan, tmp_path):
    api = pytest.importorskip("playwright.sync_api")
    program = os.environ.get("MESA_MOBILITY_BROWSER") or next(
        filter(None, map(shutil.which, PROGRAMS)), None
    )
    if program is None:
        pytest.skip("no Chromium or Chrome on the path (MESA_MOBILITY_BROWSER can name one)")
    path = tmp_path / "replay.html"
    write_page(walkers(run, Selection()), plan, path, title="two <people>")
    with api.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=program, args=DRAWN_BY_THE_PROCESSOR)
        context = browser.new_context(offline=True, viewport={"width": 480, "height": 320})
        shown = context.new_page()
        shown.faults = []
        shown.on("pageerror", lambda error: shown.faults.append(str(error)))
        shown.goto(path.as_uri())
        shown.wait_for_selector("body[data-ready=yes]", timeout=60_000)
        yield shown
        browser.close()


@pytest.mark.slow
def test_a_run_plays_stops_and_steps(page, run):
    assert page.inner_text("#title") == "two <people>"
    assert page.evaluate("state.people.map(each => each.number)") == ["0", "1"]
    page.click("#play")
    page.evaluate("state.time = 1.0")
    page.click("#on")
    assert page.evaluate("state.time") == pytest.approx(31 / 30)
    page.keyboard.press("ArrowLeft")
    assert page.evaluate("state.time") == pytest.approx(1.0)
    # Somebody's head is where it is in our poses: y is up, and z is -y.
    page.wait_for_function("element('said').textContent.startsWith('1.00 ')")
    head = page.evaluate("state.people[0].head.getWorldPosition(new THREE.Vector3()).toArray()")
    x, y, z = run.poses(0, [30]).positions[0, 4]
    assert head == pytest.approx([x, z, -y], abs=0.001)
    assert page.faults == []


@pytest.mark.slow
def test_all_views_draw(page):
    page.click("#play")
    for view in ("plan", "follow", "eyes", "orbit"):
        page.select_option("#camera", view)
        before = page.evaluate("state.drawn")
        page.wait_for_function(f"state.drawn > {before + 1}")
    assert page.faults == []
