"""Models in files, floor plans and saved runs of the folder that the dashboard was started in."""

import os
import re
from urllib.parse import urlsplit

import pytest

from tests.dashboard.files.test_own_models import PLAIN, inside
from tests.dashboard.selectors import SHOWN

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz,test]'")

TWO = """
import mesa_mobility.models
from mesa_mobility import CostTerm, PedestrianModel as Base
from mesa_mobility.models import Doorway as Door

class Term(CostTerm): ...
class Narrow(Door): ...
class Narrower(Narrow): ...
class Other(mesa_mobility.PedestrianModel): ...
"""
WKT = "walkable POLYGON ((0 0, 9 0, 9 6, 0 6, 0 0))\nexit street LINESTRING (9 2, 9 4)\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    from mesa_mobility.dashboard import offered

    monkeypatch.setattr(offered, "FOLDER", tmp_path)
    return tmp_path


def test_models_are_found_without_executing_their_files(folder):
    from mesa_mobility.dashboard.model_files import offered_models

    touched = folder / "touched"
    (folder / "room.py").write_text(f"{PLAIN}\nopen({str(touched)!r}, 'w')\n")
    (folder / "two.py").write_text(TWO)
    (folder / "script.py").write_text("print('no model')\n")
    (folder / "uses.py").write_text("from mesa_mobility import PedestrianModel\n")
    (folder / "broken.py").write_text("class Room(PedestrianModel:\n")
    (folder / "other.txt").write_text(PLAIN)
    (folder / "odd.py").write_bytes(b"\xff\xfe")
    assert offered_models() == [
        "broken.py",
        "room.py",
        "two.py:Narrow",
        "two.py:Narrower",
        "two.py:Other",
    ]
    assert not touched.exists()


def test_only_offered_models_are_loaded_and_once_while_they_stay_the_same(folder):
    from mesa_mobility.dashboard.model_files import load_offered
    from mesa_mobility.errors import ModelError

    (folder / "room.py").write_text(PLAIN)
    (folder / "broken.py").write_text("class Room(PedestrianModel:\n")
    first = load_offered("room.py")
    assert first.__name__ == "Room"
    assert load_offered("room.py") is first
    os.utime(folder / "room.py", ns=(1, 1))
    assert load_offered("room.py") is not first
    for name in ("../room.py", "/etc/x.py", "room.py:Other", "absent.py"):
        with pytest.raises(ModelError, match="expected a model of a file in"):
            load_offered(name)
    with pytest.raises(ModelError, match=r"broken.py:1: cannot be loaded: SyntaxError"):
        load_offered("broken.py")


def test_saved_runs_are_those_of_the_folder_the_newest_first(folder):
    from mesa_mobility.dashboard.saved_runs import offered_runs, replay_of
    from mesa_mobility.errors import ResultsError

    for age, name in enumerate(("new", "out/old", "too/deep/down", "unfinished")):
        (folder / name).mkdir(parents=True)
        (folder / name / "summary.json").write_text("{}")
        os.utime(folder / name / "summary.json", (1e9 - age, 1e9 - age))
        if name != "unfinished":
            (folder / name / "trajectories.parquet").write_bytes(b"damaged")
    assert offered_runs() == ["new", "out/old"]
    for name in ("too/deep/down", "../new", "unfinished", "/tmp"):
        with pytest.raises(ResultsError, match="expected a saved run in"):
            replay_of(name)
    with pytest.raises(ResultsError, match=r"new/trajectories.parquet: "):
        replay_of("new")


@pytest.fixture(scope="module")
def own_folder(tmp_path_factory):
    """A folder with a model, three floor plans and a saved run."""
    from mesa_mobility.models import Doorway

    from mesa_mobility.results import Trajectories
    from mesa_mobility.results.run import write_run

    ezdxf = pytest.importorskip("ezdxf", reason="no ezdxf: pip install 'mesa-mobility[cad]'")
    folder = tmp_path_factory.mktemp("own")
    (folder / "room.py").write_text(PLAIN)
    (folder / "broken.py").write_text("class Room(PedestrianModel:\n")
    (folder / "hall.wkt").write_text(WKT)
    for name, code in (("hall.dxf", 4), ("unknown.dxf", 0)):
        document = ezdxf.new(units=code)
        space = document.modelspace()
        corners = [(0, 0), (9000, 0), (9000, 6000), (0, 6000)]
        space.add_lwpolyline(corners, close=True, dxfattribs={"layer": "walkable"})
        space.add_line((9000, 2000), (9000, 3500), dxfattribs={"layer": "exit street"})
        document.saveas(folder / name)
    model = Doorway(pedestrians=9, record="decisions", rng=3)
    for _ in range(30):
        model.step()
    write_run(
        folder / "out" / "nine",
        summary={"model": "doorway", **model.summary()},
        trajectories=Trajectories.of(model),
        plan=model.floor_plan,
    )
    return folder


@pytest.fixture
def own_tab(start_dashboard, open_tab, own_folder):
    return open_tab(start_dashboard("doorway", cwd=own_folder).address)


@pytest.mark.slow
def test_models_plans_and_runs_are_opened(own_tab):
    tab = own_tab
    tab.choose("model", "room.py")
    inside(tab, 40)
    tab.set("pedestrians", "12")
    inside(tab, 12)
    tab.page.wait_for_url("**set.pedestrians=12**")
    tab.page.reload()
    tab.wait(f"() => {SHOWN.replace(').', ')?.')}?.inside === 12")
    tab.expect(tab.page).to_have_url(re.compile("model=room.py"))
    tab.choose("model", "broken.py")
    tab.page.get_by_text("broken.py:1: cannot be loaded: SyntaxError").wait_for()
    tab.choose("model", "floor_plan")
    tab.page.get_by_text("plan: got none, expected a file of a floor plan").wait_for()
    for name, exit_width in (("hall.wkt", 2.0), ("hall.dxf", 1.5)):
        tab.choose("plan", name)
        inside(tab, 50)
        tab.wait(
            "(width) => document.querySelector('.mm-crowd').__vue__.floor.openings.some("
            "(o) => o.name === 'street' && Math.abs(o.b[1] - o.a[1] - width) < 1e-6)",
            exit_width,
        )
    tab.choose("plan", "unknown.dxf")
    tab.page.get_by_text("unknown.dxf: does not say its unit").wait_for()
    assert tab.shown()["inside"] == 50


@pytest.mark.slow
def test_a_saved_run_plays_in_a_frame_of_its_own(own_tab):
    tab = own_tab
    tab.turn_to("Saved run")
    tab.choose("saved run", "out/nine")
    frame = tab.page.frame_locator("iframe.mm-saved")
    frame.locator("body[data-ready=yes]").wait_for()
    tab.expect(frame.locator("#title")).to_contain_text("9 people")
    assert float(frame.locator("#time").get_attribute("max")) == pytest.approx(3.0)
    # It has no access to the page around it.
    sealed = "() => { try { return String(parent.document) } catch (error) { return error.name } }"
    assert frame.locator("body").evaluate(sealed) == "SecurityError"
    tab.page.get_by_role("tab", name="Simulation").click()
    tab.step(1)


@pytest.mark.slow
def test_on_a_network_no_python_file_is_offered(start_dashboard, open_tab, own_folder):
    server = start_dashboard("doorway", "--host", "0.0.0.0", cwd=own_folder)
    place = urlsplit(server.address)
    tab = open_tab(f"http://127.0.0.1:{place.port}/?{place.query}")
    offered = tab.page.get_by_label("model", exact=True).locator("option")
    tab.expect(offered.filter(has_text=re.compile(r"^\s*floor_plan\s*$"))).to_have_count(1)
    assert [text for text in offered.all_text_contents() if ".py" in text] == []


HELPLESS = """() => [...document.querySelectorAll("button, a, input, select, [role='tab']")]
    .filter((e) => e.offsetParent && e.type !== "hidden")
    .filter((e) => !(e.closest("[title]") || e.querySelector("[title]")
        || document.getElementById(e.getAttribute("aria-describedby"))?.innerText))
    .map((e) => e.outerHTML.slice(0, 200))"""
"""Controls that do not say what they are for."""


@pytest.mark.slow
def test_every_control_says_what_it_is_for(own_tab):
    tab = own_tab
    tab.click_person(3)
    tab.play()
    tab.wait(f"() => {SHOWN}.elapsed > 1.5")
    tab.pause()
    tab.comes_to(HELPLESS, [])
    tab.button("three dimensions").click()
    tab.page.locator(".mm-bodies").wait_for()
    tab.comes_to(HELPLESS, [])
    for name in ("Mobility map", "Saved run"):
        tab.turn_to(name)
        tab.page.locator(".mm-panel:visible .mm-entry").first.wait_for()
        tab.comes_to(HELPLESS, [])
    tab.turn_to("Simulation")
    for model in ("room.py", "floor_plan", "mixed_evacuation"):
        tab.choose("model", model)
        tab.expect(tab.page).to_have_title(f"{model} - mesa-mobility")
        tab.page.wait_for_timeout(500)
        tab.comes_to(HELPLESS, [])
