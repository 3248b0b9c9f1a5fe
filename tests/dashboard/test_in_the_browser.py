"""The dashboard as a researcher meets it."""

import csv
import re

import numpy as np
import pytest
from mesa_mobility.models import Auditorium, Doorway

from mesa_mobility.crowd import FREE, Watch
from tests.dashboard.selectors import CANVAS, CLUSTER, DECISION, SHOWN

SEED = 1  # what the page starts with


def ahead(model, steps):
    for _ in range(steps):
        model.step()
    return model


def same_people(people, model):
    """Whether people on the canvas are those of a model, in the same places."""
    rows, crowd = model.rows, model.crowd
    expected = np.column_stack([rows, crowd.x[rows], crowd.y[rows]])
    turn = people[:, 3] - crowd.heading[rows]
    return np.allclose(people[:, :3], expected, atol=1e-5) and np.allclose(
        np.sin(turn), 0.0, atol=1e-5
    )


def test_it_plays_and_people_move(tab):
    assert tab.shown()["elapsed"] == 0.0
    assert tab.shown()["inside"] == 60
    before, places = tab.pixels(), tab.people()
    tab.play()
    tab.wait(f"() => {SHOWN}.elapsed > 1.5")
    tab.pause()
    tab.wait(f"(before) => {CANVAS}.toDataURL() !== before", before)
    moved = np.hypot(*(tab.people()[:, 1:3] - places[: len(tab.people()), 1:3]).T)
    assert (moved > 0.3).mean() > 0.5


@pytest.mark.thorough
def test_the_canvas_shows_the_model_step_by_step(tab):
    model = Doorway(rng=SEED)
    assert same_people(tab.people(), model)
    for _ in range(3):
        tab.step()
        ahead(model, 1)
        assert same_people(tab.people(), model)


@pytest.mark.thorough
def test_reset_and_seed_bring_the_same_first_frames(tab):
    tab.step(4)
    first = tab.people()
    tab.button("Reset").click()
    tab.at_rest(0.0)
    tab.step(4)
    assert np.array_equal(tab.people(), first)
    run = tab.shown()["run"]
    tab.set("seed", "7")
    tab.wait(f"(run) => {SHOWN}.run > run", run)
    tab.step(4)
    assert same_people(tab.people(), ahead(Doorway(rng=7), 4))
    tab.set("seed", str(SEED))
    tab.at_rest(0.0)
    tab.step(4)
    assert np.array_equal(tab.people(), first)


@pytest.mark.thorough
def test_a_parameter_takes_effect(tab):
    tab.set("pedestrians", "17")
    tab.wait(f"() => {SHOWN}.inside === 17")
    assert same_people(tab.people(), Doorway(pedestrians=17, rng=SEED))


@pytest.mark.thorough
def test_another_model_and_another_preset(tab):
    tab.choose("model", "auditorium")
    tab.wait(f"() => {SHOWN}.inside === 750")
    assert same_people(tab.people(), Auditorium(rng=SEED))
    run = tab.shown()["run"]
    tab.choose("preset", "paper")
    tab.wait(f"(run) => {SHOWN}.run > run", run)
    tab.step(2)
    assert same_people(tab.people(), ahead(Auditorium(preset="paper", rng=SEED), 2))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("many", "pedestrians: got 'many', expected a whole number"),
        ("-3", "pedestrians: got -3, expected 1 or more"),
    ],
)
def test_bad_input_gives_a_message_beside_its_control_and_the_run_goes_on(tab, text, message):
    tab.play()
    tab.wait(f"() => {SHOWN}.elapsed > 0.5")
    tab.set("pedestrians", text)
    field = tab.below("pedestrians")
    field.filter(has_text=message).wait_for()
    elapsed = tab.shown()["elapsed"]
    tab.wait(f"(t) => {SHOWN}.elapsed > t + 0.5", elapsed)
    assert tab.shown()["inside"] > 17
    tab.set("pedestrians", "17")
    tab.wait(f"() => {SHOWN}.inside === 17")
    tab.expect(field.filter(has_text=message)).to_have_count(0)


def test_a_click_opens_the_decision_with_its_numbers(tab):
    tab.step(8)
    model = ahead(Doorway(rng=SEED), 8)
    tab.click_person(23)
    explained, shown = model.explain(23), tab.decision()
    assert not shown["taken"]
    tab.expect(tab.page.get_by_text("If they decided now, at 0.80 s")).to_be_visible()
    assert shown["terms"] == list(explained.terms)
    assert shown["totals"] == pytest.approx(explained.totals, rel=1e-5)
    assert np.array_equal(shown["verdicts"], explained.verdicts)
    assert shown["chosen"] == explained.chosen
    assert shown["blockedBy"] == explained.blocked_by
    assert shown["arrow"] == (explained.blocked_by >= 0)

    # The numbers of the option under the pointer.
    table = tab.page.get_by_role("table", name="costs")
    option = int(np.argmax(np.where(explained.verdicts == FREE, explained.totals, -np.inf)))
    where = [float(x) for x in explained.candidates.points[option]]
    tab.page.mouse.move(*tab.page.evaluate(f"([x, y]) => {DECISION}.onPage(x, y)", where))
    table.get_by_text("option under the pointer").wait_for()
    pointed = tab.decision()["pointed"]
    assert explained.candidates.points[pointed] == pytest.approx(where, abs=0.02)
    costs = explained.weights * explained.costs[:, pointed]
    rows = {**dict(zip(explained.terms, costs, strict=True)), "^total": explained.totals[pointed]}
    for name, cost in rows.items():
        row = table.get_by_role("row", name=re.compile(name))
        tab.expect(row.get_by_role("cell").last).to_have_text(f"{cost:.3f}")


@pytest.mark.thorough
def test_one_pedestrian_is_clicked_after_another(tab):
    tab.step(1)
    for row in (23, 11, 23, 7):
        tab.click_person(row)
        tab.wait(f"(row) => {SHOWN}.selected === row", row)
    # A decision that is open outlasts the other tab, and goes with another run.
    tab.page.get_by_role("tab", name="Mobility map").click()
    tab.wait(f"() => {CANVAS}.offsetParent === null")
    tab.page.get_by_role("tab", name="Simulation").click()
    tab.wait(f"() => {CANVAS}.offsetParent !== null")
    tab.click_person(11)
    tab.button("if they decided now").click()
    tab.click_person(7)
    tab.button("Reset").click()
    tab.at_rest(0.0)
    tab.wait(f"() => {SHOWN}.selected === -1")
    tab.click_person(11)
    tab.click_person(23)
    tab.choose("model", "straight_walk")
    tab.wait(f"() => {SHOWN}.inside === 50")
    tab.click_person(3)
    tab.click_person(4)


@pytest.mark.thorough
def test_the_decision_shown_is_the_one_the_engine_takes(tab):
    tab.step(2)
    tab.click_person(11)
    tab.button("To the next decision").click()
    tab.page.get_by_text("Decision as taken at").wait_for()
    shown = tab.decision()

    model = ahead(Doorway(rng=SEED), 2)
    model.watch = Watch(11)
    while model.watch.decision is None:
        model.step()
    taken = model.watch.decision
    assert (shown["taken"], shown["frame"]) == (True, taken.frame)
    assert shown["chosen"] == taken.chosen
    assert shown["totals"] == pytest.approx(taken.totals, rel=1e-5)
    assert np.array_equal(shown["verdicts"], taken.verdicts)
    # It is under way there.
    x, y = taken.paths[taken.chosen, :2, taken.knots[taken.chosen] - 1]
    assert (model.crowd.to_x[11], model.crowd.to_y[11]) == pytest.approx((x, y))


@pytest.mark.thorough
def test_weights_and_behaviours_change_while_it_runs(tab):
    tab.step(2)
    tab.page.get_by_label("weight of preferred velocity", exact=True).fill("0")
    tab.page.get_by_label("weight of preferred velocity", exact=True).press("Enter")
    tab.page.get_by_role("checkbox", name="headway", exact=True).click()
    tab.step(15)
    model = ahead(Doorway(rng=SEED), 2)
    (velocity,) = (term for term in model.terms if term.name == "preferred_velocity")
    velocity.weight = 0.0
    model.terms = [term for term in model.terms if term.name != "headway"]
    assert same_people(tab.people(), ahead(model, 15))
    assert not same_people(tab.people(), ahead(Doorway(rng=SEED), 17))


@pytest.mark.thorough
def test_a_door_closes_and_opens_by_a_click(tab):
    tab.click_at(10.1, 5.0)
    closed = "() => document.querySelector('.mm-crowd').__vue__.floor.openings[0].open"
    tab.wait(f"() => !({closed})()")
    tab.step(1)
    model = Doorway(rng=SEED)
    model.floor_plan.close_gate("first door")
    assert same_people(tab.people(), ahead(model, 1))
    tab.click_at(10.1, 5.0)
    tab.wait(closed)


@pytest.mark.thorough
def test_two_tabs_do_not_disturb_each_other(open_tab):
    one, other = open_tab(), open_tab()
    one.set("pedestrians", "25")
    one.wait(f"() => {SHOWN}.inside === 25")
    one.play()
    one.wait(f"() => {SHOWN}.elapsed > 0.5")
    assert other.shown()["elapsed"] == 0.0
    assert other.shown()["inside"] == 60
    other.step(3)
    assert same_people(other.people(), ahead(Doorway(rng=SEED), 3))
    one.pause()
    assert same_people(
        one.people(), ahead(Doorway(pedestrians=25, rng=SEED), round(one.shown()["elapsed"] * 10))
    )


@pytest.mark.thorough
def test_charts_and_pictures_are_saved(tab, tmp_path):
    tab.step(12)
    with tab.page.expect_download() as download:
        tab.page.get_by_title("People inside, CSV").click()
    download.value.save_as(tmp_path / "inside.csv")
    with open(tmp_path / "inside.csv", newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["elapsed_s", "inside"]
    assert [[float(x) for x in row] for row in rows[1:]] == [[0, 60], [1, 60]]
    with tab.page.expect_download() as download:
        tab.page.locator(".mm-crowd").get_by_role("button", name="PNG").click()
    download.value.save_as(tmp_path / "crowd.png")
    assert (tmp_path / "crowd.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


@pytest.mark.thorough
def test_the_map_view_shows_clusters_and_their_sources(tab):
    tab.turn_to("Mobility map")
    map_ = Doorway(pedestrians=1).pedestrian_types[0].mobility_map
    tab.wait(f"() => {CLUSTER}?.shown().options === {len(map_.options_of(0))}")
    tab.page.get_by_label(f"cluster, 0 to {map_.n_clusters - 1}").fill("5")
    tab.page.get_by_label(f"cluster, 0 to {map_.n_clusters - 1}").press("Enter")
    tab.wait(f"() => {CLUSTER}.shown().number === 5")
    tab.comes_to(f"() => {CLUSTER}.shown().options", len(map_.options_of(5)))
    tab.page.get_by_text("Recordings and licences").click()
    tab.page.get_by_role("cell", name=map_.metadata["provenance"][0]["clip"]).first.wait_for()
    panel = tab.expect(tab.page.locator(".mm-panel:visible"))
    for line in map_.metadata["acknowledgements"]:
        panel.to_contain_text(line, use_inner_text=True)
    poses = f"23700, 1, 1, 1, 1|{map_.metadata['build']['poses_in_component']}"
    panel.to_contain_text(re.compile(poses), use_inner_text=True)
