"""Users' own models in a page: the README's, both ways of serving, and a refresh."""

import re
from pathlib import Path

import pytest

from tests.dashboard.selectors import SHOWN

README = Path(__file__).parents[3] / "README.md"

PLAIN = """
from mesa_mobility import Exit, FloorPlan, PedestrianModel


class Room(PedestrianModel):
    def __init__(self, pedestrians=40, mobility_map=None, rng=None):
        plan = FloorPlan(
            "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))", exits=[Exit("door", (10, 3.5), (10, 4.5))]
        )
        super().__init__(plan, mobility_map=mobility_map, rng=rng)
        self.add_pedestrians(plan.random_points(pedestrians, self.rng, spacing=0.5, clearance=0.3))
"""
LONG = "import time\n" + PLAIN.replace(
    "        plan =", "        time.sleep(40.0 if pedestrians > 100_000 else 0.0)\n        plan ="
)
PAGE = "from mesa_mobility.dashboard import Dashboard\nfrom my_models import Room\n\n"
PAGE += "page = Dashboard(Room)\n"
VIZ = (
    "from mesa.visualization import SolaraViz\n"
    "from mesa_mobility.dashboard import make_crowd_view\nfrom my_models import Room\n\n"
    "page = SolaraViz(Room(rng=5), components=[make_crowd_view()],\n"
    "    model_params={'rng': {'type': 'InputText', 'value': '5', 'label': 'seed'}})\n"
)


def readme_room():
    """The model in the README."""
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(), re.S)
    return next(block for block in blocks if "class Room" in block)


def inside(tab, people):
    tab.wait(f"(n) => {SHOWN}.inside === n && {SHOWN}.elapsed === 0", people)


def plays_and_slides(tab):
    """Whether a page of the README's model plays, and its slider makes the model anew."""
    assert tab.shown()["inside"] == 40
    tab.play()
    tab.wait(f"() => {SHOWN}.elapsed > 0.5")
    tab.pause()
    slider = tab.page.get_by_role("slider").first
    slider.focus()
    slider.press("ArrowRight")
    inside(tab, 41)
    tab.expect(tab.page.get_by_label("pedestrians", exact=True)).to_have_value("41")
    slider.press("ArrowLeft")
    inside(tab, 40)
    # JSON has no NaN: the page reports a message that it cannot read.
    tab.set("pedestrians", "nan")
    tab.page.locator(".mm-below").filter(has_text="nan").first.wait_for()


@pytest.mark.slow
def test_the_readmes_model_as_the_recipe_says(start_server, open_tab):
    plays_and_slides(open_tab(start_server(PAGE, my_models=readme_room()).address))


@pytest.mark.slow
def test_the_readmes_model_by_the_command(start_dashboard, open_tab, tmp_path):
    (tmp_path / "room.py").write_text(readme_room())
    tab = open_tab(start_dashboard("room.py:Room", cwd=tmp_path).address)
    plays_and_slides(tab)
    tab.choose("model", "straight_walk")
    inside(tab, 50)


@pytest.mark.slow
def test_a_model_without_annotations_takes_what_is_typed(start_server, open_tab, tmp_path):
    tab = open_tab(start_server(PAGE, my_models=PLAIN).address)
    assert tab.shown()["inside"] == 40
    tab.set("pedestrians", "12")
    inside(tab, 12)
    tab.set("pedestrians", "many")
    tab.page.get_by_text("pedestrians: got 'many', expected a whole number").wait_for()
    # No map lies in the folder, so there is none to choose.
    assert tab.page.get_by_label("mobility map", exact=True).count() == 0
    tab.set("pedestrians", "13")
    inside(tab, 13)
    tab.play()
    tab.wait(f"() => {SHOWN}.elapsed > 0.3")


@pytest.mark.slow
def test_a_seed_typed_into_mesas_page_is_taken(start_server, open_tab):
    tab = open_tab(start_server(VIZ, my_models=PLAIN).address)
    before = tab.people()
    tab.set("seed", "6")
    tab.page.get_by_role("button", name="reset").first.click()
    tab.wait(f"(x) => Math.abs({SHOWN}.people[1] - x) > 1e-3", float(before[0, 1]))
    assert len(tab.people()) == 40


@pytest.mark.slow
def test_a_plan_opens_without_a_model(start_dashboard, open_tab, tmp_path):
    from mesa_mobility import Exit, FloorPlan

    plan = FloorPlan(
        "POLYGON ((0 0, 12 0, 12 8, 0 8, 0 0))", exits=[Exit("door", (12, 3), (12, 5))]
    )
    plan.write_geojson(tmp_path / "room.geojson")
    tab = open_tab(start_dashboard("--plan", tmp_path / "room.geojson").address)
    assert tab.shown()["inside"] == 50
    tab.set("pedestrians", "7")
    inside(tab, 7)
    assert tab.page.get_by_label("plan", exact=True).count() == 0


@pytest.mark.thorough
def test_a_refresh_comes_back_to_the_same_run(tab):
    tab.set("pedestrians", "17")
    inside(tab, 17)
    tab.set("weight of headway", "2.5")
    tab.page.wait_for_url("**weight.headway=2.5**")
    tab.step(4)
    before, elapsed = tab.people(), tab.shown()["elapsed"]
    tab.page.wait_for_url("**set.pedestrians=17**")
    tab.page.reload()
    tab.wait(f"() => {SHOWN.replace(').', ')?.')}?.inside === 17")
    tab.at_rest(elapsed)
    assert tab.people().tolist() == before.tolist()
    tab.expect(tab.page.get_by_label("pedestrians", exact=True)).to_have_value("17")
    tab.expect(tab.page.get_by_label("weight of headway", exact=True)).to_have_value("2.5")
    tab.step(1)


@pytest.mark.slow
def test_an_address_alone_sets_up_the_same_model_in_another_tab(tab, open_tab, server):
    tab.set("pedestrians", "18")
    inside(tab, 18)
    tab.step(2)
    tab.page.wait_for_url(re.compile(r"run=.*set\.pedestrians=18"))
    other = open_tab(server.known(tab.page.url))
    inside(other, 18)
    # The run is that of the tab that is open.
    assert tab.shown()["elapsed"] == pytest.approx(0.2)
    key = re.search(r"run=([^&]+)", tab.page.url)[1]
    other.page.wait_for_url(re.compile(r"run=(?!" + re.escape(key) + ")"))
    tab.step(1)


@pytest.mark.thorough
def test_both_fields_that_are_wrong_are_marked(tab):
    tab.set("pedestrians", "")
    tab.set("door width", "wide")
    tab.page.get_by_text("door_width: got 'wide', expected a number").wait_for()
    expected = "pedestrians: got nothing, expected a whole number"
    tab.expect(tab.below("pedestrians")).to_have_text(expected)
    assert tab.shown()["inside"] == 60


@pytest.mark.slow
def test_a_crowd_of_millions_is_refused_and_a_large_one_asked_about(tab, open_tab):
    other = open_tab()
    tab.set("pedestrians", "3000000")
    tab.page.get_by_text("pedestrians: got 3000000, expected at most 1000000").wait_for()
    tab.set("pedestrians", "300000")
    tab.page.get_by_text("pedestrians 300,000: to make this model may take minutes").wait_for()
    other.step(2)
    tab.button("Make it").click()
    other.step(2)
    tab.page.get_by_text(re.compile(r"room for \d+ of 300000 people")).wait_for()
    assert tab.shown()["inside"] == 60
    tab.set("pedestrians", "12")
    inside(tab, 12)


@pytest.mark.slow
def test_a_model_that_takes_long_can_be_cancelled_and_other_tabs_go_on(
    start_dashboard, open_tab, tmp_path
):
    (tmp_path / "room.py").write_text(LONG)
    address = start_dashboard("room.py", cwd=tmp_path).address
    tab, other = open_tab(address), open_tab(address)
    inside(tab, 40)
    tab.set("pedestrians", "1000000")
    tab.button("Make it").click()
    tab.button("Cancel").wait_for()
    other.step(3)
    tab.button("Cancel").click()
    tab.page.locator(".mm-status", has_text="ready").wait_for()
    assert tab.shown()["inside"] == 40
    tab.step(2)


@pytest.mark.thorough
def test_a_closed_exit_is_the_reason_why_nobody_leaves(tab):
    x, y = 18.2, 7.0
    tab.click_at(x, y)
    tab.page.locator(".mm-status", has_text="every exit is closed").wait_for()
