"""The crowd of a building: one storey at a time, and a section.

Both levels are 24 m by 8 m. The upper one lies 3.06 m higher, and 24 + 20 m to the right in the
plane. The straight stair goes down from x = 8 to x = 12.93.
"""

import base64

import numpy as np
import pytest

from mesa_mobility import Building, Exit, Level, Lift, PedestrianModel, Trajectories
from mesa_mobility.dashboard.session.colouring import COLOURINGS
from mesa_mobility.dashboard.session.observer import Observer
from mesa_mobility.dashboard.session.plan_changes import PlanChanges
from mesa_mobility.dashboard.session.serialization import floor, frame
from mesa_mobility.dashboard.session.storeys import storeys
from tests.dashboard.selectors import CANVAS, SHOWN
from tests.fixtures.buildings import two_storeys, with_refuge_and_lift

DRAWN_BY_THE_PROCESSOR = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")

OFFICE = two_storeys()


def test_sheets_tell_where_they_are():
    found = storeys(OFFICE)
    assert [(each["name"], each["level"]) for each in found["sheets"]] == [
        ("level 0", True),
        ("level 1", True),
        ("landing of north", False),
    ]
    assert found["bounds"] == [0.0, 0.0, 24.0, 8.0]
    ground, upper, landing = found["sheets"]
    assert (ground["bounds"], ground["shift"]) == ([0.0, 0.0, 24.0, 8.0], [0.0, 0.0])
    assert (upper["bounds"], upper["shift"]) == ([44.0, 0.0, 68.0, 8.0], [44.0, 0.0])
    assert ground["right"] == upper["left"] == 34.0
    assert [each["elevation"] for each in found["sheets"]] == [0.0, 3.06, 1.53]
    assert landing["left"] == upper["right"]
    # The landing is 2 * 1.2 + 0.2 m wide and 1.2 m deep, 8 treads from the head at x = 14.
    assert landing["floor"] == pytest.approx([16.32, 5.4, 17.52, 8.0])
    south = found["flights"][0]
    assert (south["upper"], south["lower"], south["risers"]) == (1, 0, 18)
    assert south["head"] == pytest.approx([8.0, 0.6])
    assert south["riser"] == pytest.approx(0.17)


def test_stairs_and_lifts_have_their_own_names_and_close_as_a_whole():
    building = with_refuge_and_lift()
    model = PedestrianModel(building, rng=1)
    assert Observer(model).openings == ("west",)
    changes = PlanChanges(model)

    def found():
        return [(each["name"], each["a"][0], each["open"]) for each in changes.drawn()["openings"]]

    # The flight is 4.93 m long from x = 8, and drawn 0.3 m beyond either end. Its gates are
    # half-way from the middle to the ends of the drawing. The upper sheet is 44 m to the right.
    half = (4.93 / 2 + 0.3) / 2
    lines = [("west", 0.0), ("south", 8 + 4.93 / 2 + half), ("south", 44 + 8 + 4.93 / 2 - half)]
    lines += [("lift", 20.0), ("lift", 64.0)]
    assert [each[0] for each in found()] == [name for name, _ in lines]
    assert [each[1] for each in found()] == pytest.approx([x for _, x in lines])
    kinds = [each["kind"] for each in changes.drawn()["openings"]]
    assert kinds == ["exit", "stairs", "stairs", "lift", "lift"]
    for _ in range(2):
        assert all(is_open for _, _, is_open in found())
        changes.toggle_opening("south")
        changes.toggle_opening("lift")
        assert [is_open for _, _, is_open in found()] == [True, False, False, False, False]
        changes.toggle_opening("south")
        changes.toggle_opening("lift")


def test_refuges_are_drawn_on_the_sheet_of_their_level():
    building = with_refuge_and_lift()
    [refuge] = floor(building.floor_plan, building=building)["refuges"]
    # The sheet of the upper level is 44 m to the right.
    assert (refuge["name"], refuge["middle"]) == ("north lobby", [44 + 17, 2.5])
    assert sorted(map(tuple, refuge["rings"][0]))[0] == (44 + 15, 1)


def test_frames_tell_how_far_a_lift_has_carried_somebody():
    hall = "POLYGON ((0 0, 24 0, 24 8, 0 8, 0 0))"
    levels = [Level(0, hall, exits=[Exit("west", (0, 3), (0, 5))]), Level(1, hall, 3.0)]
    lift = Lift("lift", [1, 0], ((20.0, 6.5), (20.9, 6.5)), everybody=True, door_s=2.0)
    building = Building(levels, lifts=[lift])
    model = PedestrianModel(building, record=True, rng=1)
    model.add_pedestrians(building.places([(20.45, 4.5)], level=1))
    observer, colouring, found = Observer(model), COLOURINGS["speed"], []
    while model.inside and model.elapsed < 15.0:
        model.step()
        drawn = frame(model, colouring, observer, run=1, number=1)["people"]
        found.append(np.frombuffer(base64.b64decode(drawn), "<f4")[5])
    # From the upper level they come down by 3 m; from where they get out, they have not risen.
    assert min(found) == -3.0
    assert (found[0], found[-1]) == (0.0, 0.0)
    tracks = Trajectories.of(model)
    on = np.where(tracks.level == 1, 3.0, 0.0)
    shown = np.arange(1, len(found) + 1) * model.frames_per_step  # the only person has a row each
    assert (tracks.z - on)[shown] == pytest.approx(np.array(found), abs=1e-5)


@pytest.mark.slow
def test_a_storey_is_shown_alone_and_the_section_shows_all(start_dashboard, open_tab, tmp_path):
    OFFICE.write_geojson(tmp_path / "office.geojson")
    server = start_dashboard("--plan", tmp_path / "office.geojson")
    tab = open_tab(server.address)
    shown = tab.shown()
    assert shown["storeys"] == ["level 1", "level 0", "landing of north"]
    all_x = (shown["view"]["x"], shown["view"]["scale"])
    tab.page.get_by_label("storey", exact=True).select_option("level 1")
    tab.wait(f"() => {SHOWN}.storey === 'level 1'")
    view = tab.shown()["view"]
    assert view["x"] == pytest.approx(44 + 12)
    assert view["scale"] > 1.5 * all_x[1]
    # Exits are on the ground floor alone.
    west = f"(there) => {SHOWN}.plates.some((each) => each.name === 'west') === there"
    tab.wait(west, False)
    tab.page.get_by_label("storey", exact=True).select_option("level 0")
    tab.wait(west, True)
    # Mid flight of the straight stair is half a storey up, on either sheet.
    true_of = f"([x, y]) => {CANVAS}.trueOf(x, y)"
    for shift in (0.0, 44.0):
        place = [8 + 4.93 / 2 + shift, 0.6]
        assert tab.page.evaluate(true_of, place) == pytest.approx([8 + 4.93 / 2, 0.6, 1.53])
    # Everybody on the page is where the building says.
    people = tab.people()[:, 1:3]
    places, _ = OFFICE.true_places(people)
    found = np.array([tab.page.evaluate(true_of, each) for each in people.tolist()])
    assert found == pytest.approx(places, abs=1e-4)
    section = "document.querySelector('.mm-section canvas').toDataURL()"
    before = tab.page.evaluate(section)
    tab.button("Turn").click()
    tab.wait(f"(before) => {section} !== before", before)


@pytest.mark.slow
def test_the_running_crowd_stands_on_its_storeys_in_three_dimensions(
    start_dashboard, browser_program, playwright, tmp_path
):
    OFFICE.write_geojson(tmp_path / "office.geojson")
    server = start_dashboard("--plan", tmp_path / "office.geojson")
    chromium = playwright.chromium.launch(
        executable_path=browser_program, args=list(DRAWN_BY_THE_PROCESSOR)
    )
    page = chromium.new_page(viewport={"width": 900, "height": 700})
    page.set_default_timeout(180_000)
    page.goto(server.address)
    page.wait_for_function(f"() => {CANVAS}?.shown?.().drawn > 0")
    plane = np.array(page.evaluate(f"{SHOWN}.people")).reshape(-1, 6)
    places, levels = OFFICE.true_places(plane[:, 1:3])
    assert set(levels) == {0, 1}
    page.get_by_role("button", name="three dimensions", exact=True).click()
    view = "document.querySelector('.mm-bodies .mm-box').shown()"
    count = f"(count) => {view.replace('.shown', '?.shown?.')}?.places?.length === count"
    page.wait_for_function(count, arg=len(plane))
    shown = np.array(page.evaluate(f"{view}.places"))
    assert np.array_equal(shown[:, 0], plane[:, 0])
    assert shown[:, [1, 2, 4]] == pytest.approx(places, abs=1e-4)
    page.get_by_label("storeys", exact=True).select_option(label="up to level 0")
    page.wait_for_function(count, arg=int((levels == 0).sum()))
    chromium.close()
