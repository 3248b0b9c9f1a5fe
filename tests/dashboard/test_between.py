"""Messages to the page tell of the time since the last one that it has got."""

import base64
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

from mesa_mobility.models import Doorway

from mesa_mobility import dashboard
from mesa_mobility.dashboard.session import serialization
from mesa_mobility.dashboard.session.colouring import COLOURINGS
from mesa_mobility.dashboard.session.observer import Observer
from mesa_mobility.dashboard.views.canvases import VIEWER
from mesa_mobility.results import Trajectories
from tests.fixtures.waiting import until

PLACES = (Path(dashboard.__file__).parent / "views" / "browser", VIEWER)
"""Where the page's scripts are."""


def decoded(between):
    """(n, 5) frame, row, x, y and heading of every place, and (m, 6) of those who have left."""

    def numbers(name, kind):
        return np.frombuffer(base64.b64decode(between[name]), kind)

    places = numbers("places", "<u2").reshape(-1, 3)
    frames = np.repeat(between["frames"], between["counts"])
    points = np.array(between["origin"]) + between["step"] * places[:, :2]
    turns = places[:, 2] * (2 * np.pi / 65536)
    inside = np.column_stack([frames, numbers("rows", "<i4"), points, turns])
    return inside, numbers("left", "<f4").reshape(-1, 6)


def test_places_are_told_to_half_a_millimetre():
    model = Doorway(pedestrians=40, record=True, frames_per_step=45, rng=3)
    observer = Observer(model)
    while model.frame < 630:
        model.step()
    told = serialization.frame(model, COLOURINGS["speed"], observer, run=1, number=1)
    inside, left = decoded(told["between"])
    run = Trajectories.of(model)
    assert told["between"]["frames"] == list(range(0, 630, 6))
    for frame in (6, 300, 624):
        at = run.frame == frame
        at &= ~np.isin(run.person, np.flatnonzero(run.exit_frames == frame))
        found = inside[inside[:, 0] == frame]
        assert found[:, 1].tolist() == run.person[at].tolist()
        np.testing.assert_allclose(found[:, 2], run.x[at], atol=5.1e-4)
        np.testing.assert_allclose(found[:, 3], run.y[at], atol=5.1e-4)
        apart = np.remainder(found[:, 4] - run.heading[at] + np.pi, 2 * np.pi) - np.pi
        assert np.abs(apart).max() < 1e-4
    out = {row: run.exit_frames[int(row)] for row in left[:, 0]}
    assert len(out) == np.count_nonzero(run.exit_frames >= 0) > 3
    assert all(out[row] == frame for row, frame in left[:, :2])
    # 10 bytes each, four characters for three bytes.
    size = sum(len(told["between"][name]) for name in ("rows", "places"))
    assert size == pytest.approx(len(inside) * 10 * 4 / 3, abs=8)


def test_steps_are_longer_on_wide_plans():
    model = Doorway(pedestrians=2, rng=3)
    model.dynamics.trace = None
    trace = Observer(model).trace
    for frame, x in ((0, -500.0), (6, 500.0)):
        model.crowd.x[:2] = x
        trace.add(frame, model.rows, model.crowd)
    told = serialization.steps_between(trace.until(7), model.lifts.log)
    assert told["step"] == pytest.approx(1000 / 65535)
    inside, _ = decoded(told)
    np.testing.assert_allclose(inside[:, 2], [-500.0, -500.0, 500.0, 500.0], atol=1e-9)


def test_passages_are_told_with_their_times():
    model = Doorway(pedestrians=12, record=True, rng=3)
    observer = Observer(model)
    model.run()
    # Steps were 0.1 s long while nobody looked.
    assert observer.passed(-1.0) == []
    model = Doorway(pedestrians=12, record=True, rng=3)
    observer = Observer(model)
    while model.running:
        model.step()
        observer.after_step()
    times = np.sort(Trajectories.of(model).exit_frames) / 30
    told = [each for each in observer.passed(-1.0) if each[0] == "second door"]
    assert [people for _, people, _ in told][-1] == 12
    seconds = np.repeat(
        [seconds for _, _, seconds in told], np.diff([0, *[people for _, people, _ in told]])
    )
    assert ((seconds - times) > -1e-9).all()
    assert ((seconds - times) < 0.1 + 1e-9).all()
    some = told[3][2]
    later = [each for each in observer.passed(-1.0) if each[2] > some]
    assert observer.passed(some) == later


def published(session):
    """Each message of a session, as it is sent; the page answers none."""
    found, publish = [], session.frame.set

    def keep(value):
        found.append(value)
        publish(value)

    session.frame.set = keep
    return found


def test_what_the_page_has_not_got_is_told_again(session):
    told = published(session)
    for _ in range(10):
        session.step()
    until(lambda: told and told[-1]["elapsed"] > 0.99)
    # Steps are 3 frames long; the picture itself tells of its own frame.
    assert told[-1]["between"]["frames"] == [0, 6, 12, 18, 24]
    session.seen(next(each["number"] for each in told if abs(each["elapsed"] - 0.5) < 1e-6))
    session.step()
    until(lambda: told[-1]["elapsed"] > 1.09)
    assert told[-1]["between"]["frames"] == [18, 24, 30]
    session.seen(told[-1]["number"])
    session.step()
    until(lambda: told[-1]["elapsed"] > 1.19)
    assert told[-1]["between"]["frames"] == []


def test_another_run_tells_nothing_of_the_one_before(session):
    from mesa_mobility.dashboard.session.run_config import Recipe

    told = published(session)
    for _ in range(5):
        session.step()
    until(lambda: told and told[-1]["elapsed"] > 0.49)
    session.seen(told[-1]["number"])
    session.build(Recipe(Doorway, {"pedestrians": 7, "rng": 3}))
    until(lambda: told[-1]["inside"] == 7)
    assert told[-1]["between"]["frames"] == []
    for _ in range(4):
        session.step()
    until(lambda: told[-1]["elapsed"] > 0.39)
    assert told[-1]["between"]["frames"] == [0, 6]


@pytest.fixture
def scripted(browser):
    """An empty page with what the views know of the past."""
    page = browser.new_page()
    for name in ("assembling.js", "plan/drawing.js", "plan/people.js", "sheets.js"):
        page.add_script_tag(path=next(each / name for each in PLACES if (each / name).is_file()))
    for name in ("between.js", "past.js"):
        page.add_script_tag(path=PLACES[0] / name)
    page.evaluate(
        "() => { globalThis.picture = (elapsed, ...people) => ({ elapsed, inside: people.length,"
        " legend: { low: 0, high: 1, names: [] }, people: Float32Array.from(people.flat()) }); }"
    )
    yield page
    page.close()


def rows_at(page, script):
    found = page.evaluate(f"() => Array.from({script}.people)")
    return {int(row): each for row, *each in np.array(found).reshape(-1, 6).tolist()}


@pytest.mark.thorough
def test_people_come_and_leave_between_two_pictures(scripted):
    scripted.evaluate(
        """() => {
          const rows = [[7, 0, 2, 0, 0.5, 0], [9, 3, 3, 0, 0, 0], [5, 0, 0, 6.2, 0, 0]];
          globalThis.a = picture(1.0, ...rows);
          globalThis.b = picture(1.2, [5, 1, 0, 0.2, 0, 0], [8, 6, 0, 0, 0.7, 0]);
          globalThis.passages = {
            left: new Map([[7, { elapsed: 1.1, people: Float32Array.of(7, 1, 2, 0, 0, 0) }]]),
            came: new Map([[8, { elapsed: 1.1, people: Float32Array.of(8, 5, 0, 0, 0, 0) }]]) };
        }"""
    )
    early = rows_at(scripted, "mixed(a, b, 1.05, passages)")
    assert sorted(early) == [5, 7, 9]
    assert early[7] == pytest.approx([0.5, 2, 0, 0.5, 0], abs=1e-6)
    assert early[5] == pytest.approx([0.25, 0, 6.2 + 0.25 * (2 * np.pi - 6.0), 0, 0], abs=1e-5)
    late = rows_at(scripted, "mixed(a, b, 1.15, passages)")
    # Nobody knows when 9 has left.
    assert sorted(late) == [5, 8, 9]
    assert late[8] == pytest.approx([5.5, 0, 0, 0.7, 0], abs=1e-6)
    assert late[9] == pytest.approx([3, 3, 0, 0, 0])


@pytest.mark.thorough
def test_people_change_sheets_between_two_pictures(scripted):
    # The upper level lies 44 m to the right, 3 m higher: somebody goes on from 9.0 to 9.4 m on a
    # stair, and somebody has come down by a lift.
    storeys = (
        "{ sheets: [{ right: 34, shift: [0, 0], elevation: 0 },"
        " { right: 1e9, shift: [44, 0], elevation: 3 }], flights: [] }"
    )
    scripted.evaluate(
        """() => {
          globalThis.a = picture(1.0, [1, 53.0, 0.6, 0, 0, 0], [2, 64.5, 4.5, 0, 0, -3]);
          globalThis.b = picture(1.2, [1, 9.4, 0.6, 0, 0, 0], [2, 20.5, 4.5, 0, 0, 0]);
          globalThis.none = { left: new Map(), came: new Map() };
        }"""
    )
    early = rows_at(scripted, f"mixed(a, b, 1.05, none, {storeys})")
    assert early[1][:2] == pytest.approx([53.1, 0.6])
    assert early[2] == pytest.approx([64.5, 4.5, 0, 0, -3])
    late = rows_at(scripted, f"mixed(a, b, 1.15, none, {storeys})")
    assert late[1][:2] == pytest.approx([9.3, 0.6])
    assert late[2] == pytest.approx([20.5, 4.5, 0, 0, 0], abs=1e-6)


@pytest.mark.thorough
def test_the_page_takes_in_each_sample_once_and_forgets_the_oldest(scripted):
    model = Doorway(pedestrians=12, rng=3)
    observer = Observer(model)
    for _ in range(20):
        model.step()
    told = serialization.frame(model, COLOURINGS["speed"], observer, run=1, number=1)
    times = scripted.evaluate(
        """(told) => {
          globalThis.past = new Past(1);
          const next = { ...told, people: numbers(told.people) };
          past.take(picture(0, [0, 0, 0, 0, 0, 0]), { passed: [], between: told.between });
          for (let n = 0; n < 2; n += 1) past.take(next, told);
          return past.pictures.map((each) => each.elapsed);
        }""",
        told,
    )
    assert times == pytest.approx([0.0, *np.arange(1, 11) * 0.2])
    # Pictures of 41,667 people, 24 bytes each.
    kept = scripted.evaluate(
        """() => {
          for (let n = 0; n < 150; n += 1) {
            past.take({ ...picture(10 + n), people: new Float32Array(250002) },
              { passed: [], between: { frames: [], came: "", left: "" } });
          }
          return [past.bytes, past.pictures.length, past.last];
        }"""
    )
    assert 80e6 < kept[0] < 96e6
    assert kept[1:] == [round(kept[0] / 1000264), 159]
