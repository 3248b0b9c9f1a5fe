"""A floor plan drawn in the browser, saved and run."""

import json

import matplotlib.image
import numpy as np
import pytest
from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure
from mesa_mobility.models import Scenario
from shapely.geometry import shape

from mesa_mobility import FloorPlan, PedestrianModel


class Board:
    """The drawing board of a tab, 30 m wide."""

    def __init__(self, tab):
        self.tab, self.page = tab, tab.page
        tab.turn_to("Drawing board")
        self.sheet = self.page.get_by_label("drawing board", exact=True)
        self.sheet.wait_for()

    def tool(self, name):
        self.page.get_by_role("group", name="tool").get_by_role(
            "button", name=name, exact=True
        ).click()

    def at(self, x, y):
        """A place on the page, of metres on the sheet."""
        self.sheet.scroll_into_view_if_needed()
        box = self.sheet.bounding_box()
        return box["x"] + x / 30 * box["width"], box["y"] + box["height"] * (1 - y / 18)

    def drag(self, x0, y0, x1, y1):
        mouse = self.page.mouse
        mouse.move(*self.at(x0, y0))
        mouse.down()
        mouse.move(*self.at((x0 + x1) / 2, (y0 + y1) / 2))
        mouse.move(*self.at(x1, y1))
        mouse.up()

    def draw(self, tool, *ends):
        self.tool(tool)
        self.drag(*ends)

    def count(self, kind):
        return self.sheet.locator(f".{kind}").count()

    def save(self, path):
        with self.page.expect_download() as saving:
            self.page.get_by_role("button", name="save", exact=True).click()
        saving.value.save_as(path)
        return saving.value.suggested_filename


def test_a_plan_is_drawn_saved_and_run(tab, tmp_path):
    board = Board(tab)
    board.draw("floor", 2, 2, 12, 10)
    board.draw("floor", 12, 2, 20, 10)
    board.draw("wall", 12, 2, 12, 10)
    board.draw("door", 12, 5, 12, 6.5)
    board.draw("exit", 20, 5, 20, 7)
    board.draw("obstacle", 5, 5, 6, 6)
    board.draw("obstacle", 15, 3, 16, 4)
    # The last obstacle is taken back; the one before it is moved by 2 m.
    board.page.get_by_role("button", name="undo", exact=True).click()
    tab.expect(board.sheet.locator(".obstacle")).to_have_count(1)
    board.tool("select")
    board.drag(5, 5.5, 7, 5.5)
    board.page.get_by_label("name of the plan").fill("two rooms")
    name = board.save(tmp_path / "drawn.geojson")
    assert name == "two rooms.geojson"
    plan = FloorPlan.from_file(tmp_path / "drawn.geojson")
    assert plan.walkable.area == pytest.approx(18 * 8)
    assert [(each.a, each.b) for each in plan.exits] in (
        [((20.0, 5.0), (20.0, 7.0))],
        [((20.0, 7.0), (20.0, 5.0))],
    )
    assert next(each.bounds for each in plan.obstacles.values()) == (7.0, 5.0, 8.0, 6.0)
    assert [round(each.area) for each in plan.rooms] == [79, 63]
    model = PedestrianModel(plan, rng=1)
    model.fill("room 1", 8)
    model.run(max_seconds=120)
    assert model.inside == 0


def test_what_is_no_plan_is_said_and_nothing_is_saved(tab):
    board = Board(tab)
    board.draw("floor", 2, 2, 12, 10)
    board.page.get_by_role("button", name="save", exact=True).click()
    tab.page.get_by_role("status").filter(has_text="no exit").wait_for()
    board.sheet.focus()
    board.page.keyboard.press("Delete")
    tab.expect(board.sheet.locator(".floor")).to_have_count(0)
    board.page.keyboard.press("Control+z")
    tab.expect(board.sheet.locator(".floor")).to_have_count(1)


def test_a_picture_has_its_scale_by_two_clicks(tab, tmp_path):
    matplotlib.image.imsave(tmp_path / "plan.png", np.ones((30, 60, 3)))
    board = Board(tab)
    board.page.get_by_label("picture to draw over").set_input_files(tmp_path / "plan.png")
    image = board.sheet.locator("image")
    image.wait_for()
    assert float(image.get_attribute("width")) == 30.0
    board.page.on("dialog", lambda dialog: dialog.accept("5"))
    board.tool("scale")
    board.page.mouse.click(*board.at(5, 5))
    board.page.mouse.click(*board.at(15, 5))
    # 10 m on the sheet are 5 m: the picture of 30 m is 15 m wide.
    tab.page.get_by_role("status").filter(has_text="wide").wait_for()
    assert float(image.get_attribute("width")) == pytest.approx(15.0, abs=0.2)
    assert float(image.get_attribute("height")) == pytest.approx(7.5, abs=0.1)


def test_people_of_a_drawn_source_are_served_and_leave(tab, tmp_path):
    board = Board(tab)
    board.draw("floor", 2, 2, 20, 10)
    board.draw("exit", 20, 5, 20, 7)
    board.draw("source", 2, 2, 5, 10)
    board.page.get_by_label("people", exact=True).fill("6")
    board.page.get_by_label("seconds over which they come").fill("12")
    board.page.get_by_label("name of the selected").fill("bus")
    board.draw("counter", 10, 3, 12, 4)
    board.page.get_by_label("seconds for each").fill("2")
    board.page.get_by_label("people at once").fill("3")
    board.draw("counter", 14, 3, 15, 4)
    board.page.get_by_role("button", name="delete", exact=True).click()
    tab.expect(board.sheet.locator(".counter")).to_have_count(1)
    board.tool("select")
    board.drag(11, 4, 11, 8)
    board.save(tmp_path / "desk.geojson")
    features = json.loads((tmp_path / "desk.geojson").read_text())["features"]
    drawn = {each["properties"]["kind"]: each for each in features}
    assert drawn["source"]["properties"] == {
        "kind": "source",
        "name": "bus",
        "number": 6,
        "seconds": 12,
    }
    given = drawn["counter"]["properties"]
    assert (given["stay"], given["capacity"]) == (2, 3)
    assert shape(drawn["counter"]["geometry"]).bounds == (10.0, 7.0, 12.0, 8.0)
    model = Scenario(tmp_path / "desk.geojson", rng=1)
    model.run(max_seconds=120)
    assert (model.sources[0].entered, model.inside) == (6, 0)


def test_a_page_of_a_pdf_is_drawn_over(tab, tmp_path):
    with PdfPages(tmp_path / "plan.pdf") as pdf:
        for size in ((6, 3), (4, 4)):
            figure = Figure(figsize=size)
            figure.subplots()
            pdf.savefig(figure)
    board = Board(tab)
    board.page.get_by_label("picture to draw over").set_input_files(tmp_path / "plan.pdf")
    image = board.sheet.locator("image")
    image.wait_for()
    tab.expect(image).to_have_attribute("height", "15")
    page = board.page.get_by_label("page of the PDF")
    page.fill("2")
    page.press("Enter")
    tab.expect(image).to_have_attribute("height", "30")
    page.fill("3")
    page.press("Enter")
    tab.page.get_by_role("status").filter(has_text="has 2 pages").wait_for()
