"""A floor plan drawn in the browser, saved and run."""

import matplotlib.image
import numpy as np
import pytest

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
