"""Looking back at a run while it goes on."""

import numpy as np
import pytest
from mesa_mobility.models import Doorway

from mesa_mobility.results import Trajectories
from tests.dashboard.selectors import CANVAS, SHOWN

VIEW = "document.querySelector('.mm-crowd').__vue__"
BOX = "document.querySelector('.mm-bodies .mm-box')"

# People who set off late: long runs in which little has to be computed.
MADE = {"pedestrians": 12, "pre_movement": 52.0, "rng": 5}


@pytest.fixture(scope="module")
def known() -> Trajectories:
    model = Doorway(**MADE, record=True)
    model.run(max_seconds=75)
    return Trajectories.of(model)


def played(tab, seconds):
    for name, value in (("seed", "rng"), ("pre movement", "pre_movement")):
        before = tab.shown()["run"]
        tab.set(name, str(MADE[value]))
        tab.wait(f"(run) => {SHOWN}.run > run", before)
    tab.set("pedestrians", str(MADE["pedestrians"]))
    tab.wait(f"(n) => {SHOWN}.inside === n", MADE["pedestrians"])
    tab.choose("speed", "5 x")
    tab.play()
    tab.page.wait_for_function(f"(t) => {SHOWN}.past[1] > t", arg=seconds, timeout=300_000)


def off(people, known, elapsed):
    """Distance of everybody from where the run has them at a time, metres; the people must be those
    of the run."""
    frame = elapsed * known.frame_rate
    low = int(np.floor(frame + 1e-6))
    apart = []
    for row, x, y in people:
        track = known.rows_of(int(row))
        own = np.column_stack([known.x[track], known.y[track]])
        at = [np.interp(frame, known.frame[track], own[:, k]) for k in (0, 1)]
        apart.append(np.hypot(x - at[0], y - at[1]))
    inside = (known.exit_frames < 0) | (known.exit_frames > low + 3)
    assert {int(row) for row, _, _ in people} >= set(np.flatnonzero(inside).tolist())
    assert len(people) <= np.count_nonzero((known.exit_frames < 0) | (known.exit_frames > low - 3))
    return np.array(apart)


@pytest.mark.slow
def test_looking_back_shows_the_right_people_at_the_right_places(tab, known):
    played(tab, 64.0)
    slider = tab.page.get_by_label("time that is shown")
    last = tab.page.evaluate(f"() => {SHOWN}.past[1]")
    times = np.array(tab.page.evaluate(f"() => {VIEW}.past.pictures.map((each) => each.elapsed)"))
    # Those pictures are exact; between two that came soon after each other people go straight.
    asks = [(times[np.argmin(np.abs(times - last + back))], 0.002) for back in (62, 30, 14, 8, 3)]
    near = np.flatnonzero((np.diff(times) < 0.35) & (times[:-1] > 54.0))
    asks += [((times[k] + times[k + 1]) / 2, 0.05) for k in near[:: max(len(near) // 3, 1)]]
    for asked, most in asks:
        asked = float(asked)
        slider.evaluate(
            "(input, value) => { input.value = value; input.dispatchEvent(new Event('input')); }",
            asked,
        )
        tab.wait(f"(t) => Math.abs({SHOWN}.elapsed - t) < 1e-3", asked)
        shown = tab.people()
        assert off(shown[:, :3], known, asked).max(initial=0.0) < most
    # The model has gone on meanwhile.
    assert tab.page.evaluate(f"() => {SHOWN}.past[1]") > last
    tab.page.get_by_role("button", name="Go on").click()
    tab.wait(f"(t) => {SHOWN}.elapsed > t + 0.3", asked)
    tab.page.get_by_role("button", name="Live").click()
    tab.wait(f"() => {SHOWN}.cursor === null")


@pytest.mark.slow
def test_curves_count_who_has_passed_and_lead_to_a_time(tab, known):
    played(tab, 66.0)
    tab.pause()
    passed = tab.page.evaluate(f"() => Object.fromEntries({VIEW}.past.doors)")
    last = tab.page.evaluate(f"() => {SHOWN}.past[1]")
    left = known.exit_frames[known.exit_frames >= 0] / 30
    times = np.array(passed["second door"])
    assert len(times) == np.count_nonzero(left <= last)
    np.testing.assert_allclose(times, np.sort(left)[: len(times)], atol=1.0)
    box = tab.page.locator(".mm-curves").bounding_box()
    tab.page.mouse.click(box["x"] + 8 + 0.5 * (box["width"] - 16), box["y"] + 20)
    tab.wait(f"(t) => Math.abs({SHOWN}.elapsed - t) < 0.3", last / 2)


@pytest.mark.slow
def test_maps_of_the_floor_follow_the_time(tab):
    tab.choose("map of the floor", "density")
    tab.wait(f"() => {SHOWN}.map?.kind === 'density'")
    some = tab.page.evaluate(f"() => {SHOWN}.map.cells.some((each) => each > 0)")
    assert some
    grid = tab.page.evaluate(
        f"() => {{ const v = {VIEW}; return [v.grid.step, "
        f"Array.from(v.grid.densities(v.placesOf(v.to)), (n) => Number.isFinite(n) ? n : 0), "
        f"Array.from(v.grid.shares)]; }}"
    )
    step, densities, shares = grid
    people = np.dot(densities, shares) * step**2
    assert people == pytest.approx(60, rel=0.03)
    tab.choose("map of the floor", "plain floor")
    tab.wait(f"() => {SHOWN}.map === null")


@pytest.mark.slow
def test_in_three_dimensions_people_are_where_they_were(tab, known):
    tab.button("three dimensions").click()
    tab.wait(f"() => {BOX} && ({BOX}.shown().ready || {BOX}.shown().trouble)")
    if tab.page.evaluate(f"() => {BOX}.shown().trouble"):
        pytest.skip("this browser draws without WebGL")
    tab.button("plan").click()
    tab.wait(f"() => {CANVAS}?.shown?.().drawn > 0")
    played(tab, 50.0)
    tab.choose("speed", "1 x")
    tab.button("three dimensions").click()
    later = f"() => {BOX} && {BOX}.shown().past[1] > 60"
    tab.page.wait_for_function(later, timeout=300_000)
    view = "document.querySelector('.mm-bodies').__vue__"
    # Seen in three dimensions, and from before.
    times = np.array(tab.page.evaluate(f"() => {view}.past.pictures.map((each) => each.elapsed)"))
    for about, limbs in ((59.0, True), (20.0, False)):
        asked = float(times[np.argmin(np.abs(times - about))])
        tab.page.evaluate(f"(t) => {view}.scrub(t)", asked)
        tab.wait(f"(t) => Math.abs({BOX}.shown().elapsed - t) < 1e-3", asked)
        shown = np.array(tab.page.evaluate(f"() => {BOX}.shown().places"))
        assert off(shown[:, :3], known, asked).max() < 0.005
        bodies = tab.page.evaluate(f"() => {view}.there({asked} * 30).some((p) => p.course)")
        assert bodies == limbs
