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

NEAR = 0.1
"""Metres by which people may be off."""


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


def with_bodies(tab):
    """Whether the browser can draw in three dimensions; the plan is shown."""
    tab.button("three dimensions").click()
    tab.wait(f"() => {BOX} && ({BOX}.shown().ready || {BOX}.shown().trouble)")
    trouble = tab.page.evaluate(f"() => {BOX}.shown().trouble")
    tab.button("plan").click()
    tab.wait(f"() => {CANVAS}?.shown?.().drawn > 0")
    return not trouble


def off(people, known, elapsed):
    """Distance of everybody from where the run has them at a time, metres; the people must be those
    of the run, but for those who leave within half a frame."""
    frame = elapsed * known.frame_rate
    apart = []
    for row, x, y in people:
        track = known.rows_of(int(row))
        own = np.column_stack([known.x[track], known.y[track]])
        at = [np.interp(frame, known.frame[track], own[:, k]) for k in (0, 1)]
        apart.append(np.hypot(x - at[0], y - at[1]))
    found = [int(row) for row, _, _ in people]
    assert len(set(found)) == len(found)
    leaves = np.where(known.exit_frames < 0, np.inf, known.exit_frames)
    assert {*np.flatnonzero(leaves > frame + 0.5).tolist()} <= {*found}
    assert {*found} <= {*np.flatnonzero(leaves > frame - 0.5).tolist()}
    return np.array(apart)


def scrub(tab, asked):
    """Look at a time of the past, as a reader does who drags the slider."""
    tab.page.get_by_label("time that is shown").evaluate(
        "(input, value) => { input.value = value; input.dispatchEvent(new Event('input')); }", asked
    )


def people_at(tab, asked):
    """(n, 3) row, x and y of everybody who is drawn at a time of the past."""
    scrub(tab, asked)
    tab.wait(f"(t) => Math.abs({SHOWN}.elapsed - t) < 1e-3", asked)
    return tab.people()[:, :3]


def bodies_at(tab, asked):
    """The same in three dimensions."""
    scrub(tab, asked)
    tab.wait(f"(t) => Math.abs({BOX}.shown().elapsed - t) < 1e-3", asked)
    return np.array(tab.page.evaluate(f"() => {BOX}.shown().places")).reshape(-1, 5)[:, :3]


@pytest.mark.slow
def test_looking_back_shows_the_right_people_at_the_right_places(tab, known):
    played(tab, 64.0)
    last = tab.page.evaluate(f"() => {SHOWN}.past[1]")
    long_ago = [last - back for back in (62.0, 30.0, 14.0)]
    for asked in (*long_ago, *np.linspace(51.0, last - 0.3, 25).tolist()):
        assert off(people_at(tab, asked), known, asked).max(initial=0.0) < NEAR
    # The model has gone on meanwhile.
    assert tab.page.evaluate(f"() => {SHOWN}.past[1]") > last
    asked = last - 5.0
    people_at(tab, asked)
    tab.page.get_by_role("button", name="Go on").click()
    tab.wait(f"(t) => {SHOWN}.elapsed > t + 0.3", asked)
    tab.page.get_by_role("button", name="Live").click()
    tab.wait(f"() => {SHOWN}.cursor === null")


SELDOM = """
from mesa_mobility.dashboard import Dashboard
from mesa_mobility.dashboard.session import view_state

view_state.FRAME_INTERVAL = 2.0  # seconds
page = Dashboard("doorway")
"""


@pytest.mark.thorough
def test_right_people_at_right_places_where_pictures_are_far_apart(start_server, open_tab, known):
    tab = open_tab(start_server(SELDOM).address)
    three = with_bodies(tab)
    played(tab, 62.0)
    pictures = f"{VIEW}.past.pictures.map(({{ elapsed, number = -1 }}) => [elapsed, number])"
    times, numbers = np.array(tab.page.evaluate(f"() => {pictures}")).T
    # Between two pictures that were drawn there are seconds, between two that are known 0.2 s.
    drawn = times[numbers >= 0]
    assert np.diff(drawn).max() > 5.0
    assert np.diff(times).max() < 0.2 + 1e-6
    last = float(times[-1])
    asks = [last - 60.0, *np.linspace(last - 14.0, last - 0.05, 40).tolist()]
    seen = [people_at(tab, asked) for asked in asks]
    apart = [off(*each).max(initial=0.0) for each in zip(seen, [known] * 41, asks, strict=True)]
    assert max(apart) < NEAR
    # Some walk, and some have left.
    assert len(seen[-1]) < len(seen[0]) == MADE["pedestrians"]
    if not three:
        return
    tab.button("three dimensions").click()
    tab.wait(f"() => {BOX} && {BOX}.shown().ready")
    apart = [off(bodies_at(tab, asked), known, asked).max(initial=0.0) for asked in asks]
    assert max(apart) < NEAR


@pytest.mark.slow
def test_curves_count_who_has_passed_and_lead_to_a_time(tab, known):
    played(tab, 66.0)
    tab.pause()
    passed = tab.page.evaluate(f"() => Object.fromEntries({VIEW}.past.doors)")
    last = tab.page.evaluate(f"() => {SHOWN}.past[1]")
    left = known.exit_frames[known.exit_frames >= 0] / 30
    times = np.array(passed["second door"])
    assert len(times) == np.count_nonzero(left <= last)
    np.testing.assert_allclose(times, np.sort(left)[: len(times)], atol=0.1 + 1e-6)
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
    if not with_bodies(tab):
        pytest.skip("this browser draws without WebGL")
    played(tab, 50.0)
    tab.choose("speed", "1 x")
    tab.button("three dimensions").click()
    later = f"() => {BOX} && {BOX}.shown().past[1] > 60"
    tab.page.wait_for_function(later, timeout=300_000)
    view = "document.querySelector('.mm-bodies').__vue__"
    # Seen in three dimensions, and from before.
    for asked, limbs in ((59.03, True), (20.11, False), (56.48, True)):
        assert off(bodies_at(tab, asked), known, asked).max() < NEAR
        bodies = tab.page.evaluate(f"() => {view}.there({asked} * 30).some((p) => p.course)")
        assert bodies == limbs
