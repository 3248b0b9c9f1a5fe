"""The crowd in three dimensions, beside the plan."""

import base64
import json
import zlib

import numpy as np
import pytest
from mesa_mobility.models import Doorway, MixedEvacuation

from mesa_mobility.bodies import PoseBank
from mesa_mobility.bodies.sequence import pose_sequence
from mesa_mobility.results import Trajectories

BOX = "document.querySelector('.mm-bodies .mm-box')"
BODIES = f"{BOX}.shown()"


def test_what_people_do_now_is_what_they_have_decided():
    from mesa_mobility.dashboard.session.bodies import Bodies

    model = Doorway(pedestrians=12, record="decisions", rng=3)
    bodies = Bodies(model)
    assert bodies.now().shape == (12, 5)
    for _ in range(20):
        model.step()
    run = Trajectories.of(model)
    bank = PoseBank.of(model.pedestrian_types[0].mobility_map.digest)
    for row, (which, into, number, moving, _) in zip(model.rows, bodies.now(), strict=True):
        frames = np.arange(model.frame + 1)
        poses = pose_sequence(bank, frames, run.decisions.movements_of(int(row))).numbers
        now = int(bank.later(np.array([number]), np.array([into * moving]))[0])
        assert (which, now) == (0, poses[-1])


def test_people_are_told_by_their_types():
    from mesa_mobility.dashboard.session.bodies import Bodies

    model = MixedEvacuation(
        pedestrians=20, population="wheelchair_manual: 0.5, cane: 0.3, child: 0.2", rng=3
    )
    bodies = Bodies(model)
    content = zlib.decompress(base64.b64decode(bodies.bundle()))
    header = json.loads(content[4 : 4 + int.from_bytes(content[:4], "little")])
    types = [
        (kind.name, of["aid"], of["bank"] >= 0)
        for kind, of in zip(model.pedestrian_types, header["types"], strict=True)
    ]
    assert types == [
        ("wheelchair_manual", "wheelchair", False),
        ("cane", "cane", True),
        ("child", "", True),
    ]
    now = bodies.now()
    np.testing.assert_array_equal(now[:, 0], model.crowd.type_index[model.rows])
    assert not now[now[:, 0] == 0, 1:].any()
    assert (now[now[:, 0] > 0, 4] > 0).all()


@pytest.fixture
def open_bodies(open_tab):
    def opened(**context):
        tab = open_tab(**context)
        tab.button("three dimensions").click()
        tab.wait(f"() => {BOX} && ({BODIES}.ready || {BODIES}.trouble)")
        if tab.page.evaluate(f"() => {BODIES}.trouble"):
            pytest.skip("this browser draws without WebGL")
        tab.wait(f"() => {BODIES}.drawn > 0")
        return tab

    return opened


@pytest.mark.slow
def test_people_walk_in_three_dimensions_and_the_plan_comes_back(open_bodies):
    tab = open_bodies()
    tab.wait(f"() => {BODIES}.inside === 60 && {BODIES}.figures.reduce((a, b) => a + b) === 60")
    tab.play()
    tab.wait(f"() => {BODIES}.elapsed > 1.5 && {BODIES}.drawn > 10")
    assert tab.page.evaluate(f"() => {BODIES}.figures")[2] == 0  # all have limbs
    tab.button("Pause").click()
    tab.button("Play").wait_for()
    tab.wait("() => !document.querySelector('.mm-bodies').__vue__.moving(performance.now())")
    before = tab.page.evaluate(f"() => {BODIES}.elapsed")
    tab.button("plan").click()
    tab.wait("() => document.querySelector('.mm-crowd-canvas')?.shown?.().drawn > 0")
    assert tab.shown()["elapsed"] == pytest.approx(before, abs=0.2)
    tab.button("three dimensions").click()
    tab.wait(f"() => {BOX} && {BODIES}.drawn > 0")


@pytest.mark.slow
def test_somebody_is_chosen_and_followed(open_bodies):
    tab = open_bodies()
    for name, how in (
        ("Follow", "follow"),
        ("Eyes", "eyes"),
        ("Above", "plan"),
        ("Orbit", "orbit"),
    ):
        tab.button(name).click()
        tab.wait(f"(how) => {BODIES}.how === how", how)
    # Who is looked after is the person whose decision is shown.
    tab.wait(f"() => {BODIES}.selected >= 0")
    row = tab.page.evaluate(f"() => {BODIES}.selected")
    tab.button("To the next decision").click()
    tab.page.get_by_text("Decision as taken").wait_for()
    assert tab.decision()["pedestrian"] == row


@pytest.mark.slow
def test_another_run_and_another_model(open_bodies):
    tab = open_bodies()
    tab.set("pedestrians", "17")
    tab.wait(f"() => {BODIES}.inside === 17 && {BODIES}.figures[1] + {BODIES}.figures[0] === 17")
    tab.choose("model", "auditorium")
    tab.wait(f"() => {BODIES}.inside === 750")
    tab.choose("model", "mixed_evacuation")
    tab.wait(f"() => {BODIES}.inside === 60")
    meshes = f"{BODIES}.meshes"
    tab.wait(f"() => ({meshes}.wheelchair_far || 0) + ({meshes}.wheelchair_near || 0) > 10")


@pytest.mark.slow
def test_a_view_of_somebody_who_has_left_becomes_the_overview(open_bodies):
    tab = open_bodies()
    tab.set("pedestrians", "2")
    tab.wait(f"() => {BODIES}.inside === 2")
    tab.button("Eyes").click()
    tab.wait(f"() => {BODIES}.selected >= 0")
    row = tab.page.evaluate(f"() => {BODIES}.selected")
    tab.page.get_by_label("speed", exact=True).select_option("full")
    tab.play()
    tab.wait(f"() => {BODIES}.gone !== ''")
    assert tab.page.evaluate(f"() => {BODIES}.gone") == (
        f"Person {row} has left; the whole floor is shown"
    )
    # From farther above than any eye.
    tab.wait(f"() => {BODIES}.camera[2] > 3")
