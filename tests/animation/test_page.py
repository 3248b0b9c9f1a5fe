"""The page that plays a run, in a browser without a network."""

from dataclasses import replace

import numpy as np
import pytest

from mesa_mobility import PedestrianModel
from mesa_mobility.animation import Selection, write_page
from mesa_mobility.bodies.skeleton import JOINT
from mesa_mobility.errors import ResultsError
from mesa_mobility.results import Trajectories
from tests.fixtures.buildings import two_storeys


@pytest.fixture
def page(open_page, run, plan):
    return open_page(run, plan, title="two <people>")


@pytest.mark.slow
def test_a_run_plays_stops_and_steps(page):
    assert page.inner_text("#title") == "two <people>"
    assert page.evaluate("state.people.map(each => each.row)") == [0, 1]
    page.evaluate("show(30)")
    page.click("#on")
    assert page.evaluate("state.frame") == 31
    page.keyboard.press("Escape")
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("ArrowLeft")
    assert page.evaluate("state.frame") == 30
    assert page.inner_text("#said").startswith("1.00 of 3.0 s")
    page.click("#play")
    page.wait_for_function("state.frame > 33")


@pytest.mark.slow
def test_bodies_in_the_page_are_those_of_the_run(page, run):
    for person in (0, 1):
        last = int(run.frame[run.rows_of(person)][-1])
        frames = list(range(3, last, 3))
        shown = page.evaluate(
            """([person, frames]) => frames.map((frame) => {
              const { body } = state.stage, who = state.people.find((each) => each.row === person);
              body.pose(who, frame, true);
              return Array.from(body.places);
            })""",
            [person, frames],
        )
        apart = np.linalg.norm(
            np.array(shown).reshape(-1, 22, 3) - run.poses(person, frames).positions, axis=2
        )
        # Places are stored to 1 mm; a step that gets a foot back may come a frame later.
        assert apart[:, JOINT["head"]].max() < 0.002
        assert np.median(apart, axis=0).max() < 0.002
        assert np.quantile(apart, 0.99) < 0.01


@pytest.mark.slow
def test_a_page_of_a_building_has_storeys_and_feet_on_treads(open_page):
    office = two_storeys()
    model = PedestrianModel(office, record="decisions", rng=3)
    model.add_pedestrians(office.places([(6.6, 0.6)], level=1))
    model.add_pedestrians(office.places([(18.0, 4.0)], level=0))
    model.run(max_seconds=8)
    tracks = Trajectories.of(model)
    page = open_page(tracks, office, title="office")
    assert page.eval_on_selector_all("#storey option", "all => all.map(each => each.text)") == [
        "all",
        "up to level 0",
    ]
    middle = int(np.argmin(np.abs(tracks.z - 1.53)))
    frame = int(tracks.frame[middle])
    known = page.evaluate("frame => state.people[0].track.at(frame)[3]", frame)
    assert known == pytest.approx(tracks.z[middle], abs=0.002)
    frames = list(range(3, frame + 30, 3))
    shown = page.evaluate(
        """(frames) => frames.map((frame) => {
          state.stage.body.pose(state.people[0], frame, true);
          return Array.from(state.stage.body.places);
        })""",
        frames,
    )
    own = tracks.poses(0, frames, building=office).positions
    apart = np.linalg.norm(np.array(shown).reshape(-1, 22, 3) - own, axis=2)
    assert np.median(apart, axis=0).max() < 0.003
    # At first both are there; without the upper storey only the one below is.
    page.evaluate("show(1)")
    assert page.inner_text("#said").endswith("2 there")
    page.select_option("#storey", "3.06")
    page.evaluate("show(1)")
    assert page.inner_text("#said").endswith("1 there")
    assert page.evaluate("state.stage.scenery.fixed.every(e => e.mesh.visible === e.base < 3)")


@pytest.mark.slow
def test_all_views_draw_and_a_click_chooses(page):
    page.evaluate("show(30)")
    for view in ("plan", "follow", "eyes", "orbit"):
        page.select_option("#camera", view)
        drawn = "state.plan.drawn" if view == "plan" else "state.stage.drawn"
        before = page.evaluate(drawn)
        page.evaluate("draw()")
        assert page.evaluate(drawn) > before
    # Somebody is followed as soon as a view needs it.
    assert page.input_value("#person") == "0"
    page.select_option("#person", "-1")
    # What is told of the person chosen before may lie over the place.
    page.wait_for_function("!element('why').textContent")
    x, y = page.evaluate(
        """() => {
          const { canvas, perspective } = state.stage, box = canvas.getBoundingClientRect();
          const [x, y] = state.people[1].track.at(state.frame);
          const at = new THREE.Vector3(x, y, 1).project(perspective);
          return [box.left + (at.x + 1) / 2 * box.width, box.top + (1 - at.y) / 2 * box.height];
        }"""
    )
    page.mouse.click(x, y)
    assert page.input_value("#person") == "1"


@pytest.mark.slow
def test_the_page_tells_what_somebody_is_doing(page, run):
    own = run.decisions.rows_of(0)
    frames = run.decisions.frame[own].tolist()
    page.select_option("#person", "0")
    assert len(frames) > 1
    page.evaluate(f"show({frames[1] + 1})")
    said = page.inner_text("#why")
    assert f"decision 2 of {len(frames)}, taken at {frames[1] / 30:.2f} s" in said
    assert f"option {run.decisions.option[own[1]]} of its map" in said
    page.click("#earlier")
    assert page.evaluate("state.frame") == frames[1]
    page.click("#earlier")
    assert page.evaluate("state.frame") == frames[0]
    page.click("#later")
    assert page.evaluate("state.frame") == frames[1]


@pytest.mark.slow
def test_the_page_tells_of_any_person_at_any_time(page, run):
    for person in (0, 1):
        own = run.decisions.rows_of(person)
        decided, options = run.decisions.frame[own], run.decisions.option[own]
        frames = run.frame[run.rows_of(person)]
        assert len(frames) > 45
        said = page.evaluate(
            """([person, frames]) => {
              element("person").value = person;
              return frames.map((frame) => (state.frame = frame, why()));
            }""",
            [str(person), frames.tolist()],
        )
        for frame, text in zip(frames, said, strict=True):
            k = int((decided <= frame).sum()) - 1
            if k < 0:
                assert text == f"person {person}: has not decided yet"
                continue
            assert f"decision {k + 1} of {len(own)}, taken at {decided[k] / 30:.2f} s" in text
            assert f"option {options[k]} of its map" in text
            assert text.endswith(f"--person {person} --time {decided[k] / 30:.2f}")


@pytest.mark.slow
def test_people_without_poses_are_drawn_without_limbs(open_page, run, plan):
    page = open_page(replace(run, decisions=None), plan, title="no decisions")
    page.evaluate("show(30)")
    assert page.evaluate("state.stage.figures") == [0, 0, 2]
    page.select_option("#person", "0")
    page.evaluate("show(31)")
    assert "no record of decisions" in page.inner_text("#why")


@pytest.fixture
def mixed(open_page, run, plan):
    """Somebody in a wheelchair, and somebody with a cane."""
    types = np.array(["wheelchair_manual", "cane"])
    page = open_page(replace(run, person_data={"type": types}), plan, title="mixed")
    page.evaluate("show(30)")
    return page


@pytest.mark.slow
def test_wheelchairs_and_sticks_are_drawn_near_and_far(mixed):
    counts = "(draw(), state.stage.troops.counts())"

    def expected(level):
        return {f"{name}_{level}": 1 for name in ("seated", "wheelchair", "person", "cane")}

    stand = """(metres) => {
      const { perspective, orbit } = state.stage;
      perspective.position.copy(orbit.target).add(new THREE.Vector3(0, -metres, metres));
      orbit.update();
    }"""
    mixed.evaluate(stand, 2)
    assert mixed.evaluate(counts) == expected("near")
    mixed.evaluate(stand, 12)
    assert mixed.evaluate(counts) == expected("far")
    # From far away people have no limbs and no sticks, but they still sit.
    mixed.evaluate("Object.assign(state.stage, { detail: DETAIL.length - 1 }); null")
    mixed.evaluate(stand, 40)
    assert mixed.evaluate(counts) == {"seated_far": 1, "wheelchair_far": 1, "person_speck": 1}
    # Through the eyes of somebody who sits.
    mixed.select_option("#person", "0")
    mixed.select_option("#camera", "eyes")
    mixed.evaluate("draw()")
    assert mixed.evaluate("state.stage.perspective.position.z") == pytest.approx(1.25, abs=0.1)


@pytest.mark.slow
def test_people_who_come_later_are_drawn_too(page):
    pixels = """(places) => {
      const { stage } = state, gl = stage.renderer.getContext(), person = present()[0];
      const [x, y] = person.track.at(state.frame);
      const at = (k) => [x - k % 20 / 4, y - 1 + k / 200, 0, 0];
      const people = places.map((k) => ({ ...person, track: { at: () => at(k) } }));
      stage.still = true;
      stage.draw(people, state.frame, -1);
      const { width, height } = stage.canvas, drawn = new Uint8Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, drawn);
      return Array.from(drawn);
    }"""
    page.evaluate("show(30)")
    none, few, more = (
        np.array(page.evaluate(pixels, list(range(count)))).reshape(-1, 4) for count in (0, 70, 400)
    )

    def covered(drawn):
        return (drawn != none).any(axis=1).sum()

    assert 0 < covered(few) < covered(more)
    # More copies than an instance holds, and no more of them than people.
    assert page.evaluate("state.stage.troops.shadows.count") == 400
    assert (
        page.evaluate(
            "Object.values(state.stage.troops.counts()).reduce((all, each) => all + each, 0)"
        )
        == 400
    )


@pytest.mark.slow
def test_thousands_of_bodies_fit_into_a_texture(page):
    width, height = page.evaluate(
        "(({ width, height }) => [width, height])(sheet(2 * BONES, 10000).image)"
    )
    # WebGL 2 promises 2048.
    assert max(width, height) <= 2048
    assert width * height >= 10000 * 44


@pytest.mark.slow
def test_without_webgl_the_plan_is_left(playwright, browser_program, run, plan, tmp_path):
    path, trouble = tmp_path / "replay.html", []
    write_page(run, plan, path=path, title="plan only")
    browser = playwright.chromium.launch(
        executable_path=browser_program, args=["--no-sandbox", "--disable-3d-apis"]
    )
    page = browser.new_page()
    page.on("pageerror", lambda error: trouble.append(str(error)))
    page.goto(path.as_uri())
    page.wait_for_selector("body[data-ready=yes]", timeout=60_000)
    assert page.input_value("#camera") == "plan"
    assert "need WebGL" in page.inner_text("#flat")
    page.evaluate("show(30)")
    assert page.inner_text("#said").startswith("1.00 of")
    assert page.evaluate("state.plan.drawn") > 0
    browser.close()
    assert trouble == []


@pytest.mark.slow
def test_a_part_of_a_run(open_page, run, plan):
    page = open_page(run, plan, selection=Selection((0,), 1.0, 2.0), title="one second of one")
    assert page.evaluate("[state.first, state.last, state.people.length]") == [30, 60, 1]
    page.evaluate("show(45)")
    assert page.evaluate("present().length") == 1


def test_other_frame_rates_are_refused(run, plan, tmp_path):
    slower: Trajectories = replace(run, frame_rate=10.0, decisions=None)
    with pytest.raises(ResultsError, match="10 frames a second: expected 30"):
        write_page(slower, plan, tmp_path / "page.html", title="")


@pytest.mark.slow
def test_the_camera_that_follows_looks_over_walls_and_keeps_its_distance(page):
    over = "([walls, target, camera]) => overWalls(walls, target, camera)"

    def raised(walls, camera):
        return np.array(page.evaluate(over, [walls, [0, 0, 1.1], camera]))

    bench = [[1, -1, 1, 1], [2, -1, 2, 1], [1, -1, 2, -1], [1, 1, 2, 1]]
    behind = [-1, -5, -1, 5]
    assert raised([*bench, behind], [0, 3, 1.1]).tolist() == [0, 3, 1.1]
    # In the bench: at 1 m it has to be 0.35 m higher than the person's 1.1 m.
    made = raised(bench, [1.5, 0, 1.1])
    assert np.linalg.norm(made - [0, 0, 1.1]) == pytest.approx(1.5)
    assert (made[2] - 1.1) / made[0] == pytest.approx(0.35)
    assert made[1] == 0
    # High enough already.
    assert raised(bench, [1.5, 0, 2.0]).tolist() == [1.5, 0, 2.0]
    random = np.random.default_rng(1)
    for _ in range(100):
        walls = random.uniform(-4, 4, (6, 4)).tolist()
        made = raised(walls, [*random.uniform(-4, 4, 2).tolist(), random.uniform(0.2, 3)])
        for share in np.linspace(0.02, 1, 50):
            x, y, z = share * made + (1 - share) * np.array([0, 0, 1.1])
            for ax, ay, bx, by in walls:
                along = np.array([bx - ax, by - ay])
                t = np.clip(np.dot([x - ax, y - ay], along) / np.dot(along, along), 0, 1)
                near = np.hypot(*(np.array([ax, ay]) + t * along - [x, y])) < 1e-3
                assert not (near and z < 1.2)
