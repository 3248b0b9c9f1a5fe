"""A short run of two people, of whom one leaves."""

import pytest

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.animation import write_page
from mesa_mobility.results import Trajectories

DRAWN_BY_THE_PROCESSOR = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")


@pytest.fixture(scope="package")
def plan() -> FloorPlan:
    return FloorPlan(
        "POLYGON ((0 0, 8 0, 8 4, 0 4, 0 0))", exits=[Exit("door", (8, 1.0), (8, 3.0))]
    )


@pytest.fixture(scope="package")
def run(plan) -> Trajectories:
    model = PedestrianModel(plan, record="decisions", rng=5)
    model.add_pedestrians([(1.0, 1.0), (6.5, 2.0)])
    model.run(max_seconds=3)
    return Trajectories.of(model)


@pytest.fixture
def open_page(playwright, browser_program, tmp_path):
    """Opens the page of a run; it may ask for nothing, and nothing may go wrong in it."""
    path = tmp_path / "replay.html"
    trouble = []
    browser = playwright.chromium.launch(
        executable_path=browser_program, args=DRAWN_BY_THE_PROCESSOR
    )
    context = browser.new_context(offline=True, viewport={"width": 900, "height": 560})

    def opened(*arguments, **keywords):
        write_page(*arguments, path=path, **keywords)
        shown = context.new_page()
        shown.on("pageerror", lambda error: trouble.append(str(error)))
        shown.on("request", lambda request: asked(request.url))
        shown.goto(path.as_uri())
        shown.wait_for_selector("body[data-ready=yes]", timeout=60_000)
        shown.click("#play")
        return shown

    def asked(address):
        if address != path.as_uri() and not address.startswith(("data:", "blob:")):
            trouble.append(f"asks for {address}")

    yield opened
    browser.close()
    assert trouble == []
