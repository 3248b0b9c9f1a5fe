"""What a message tells of the time since the last one that the page has got."""

import base64

import numpy as np
import pytest

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

from mesa_mobility.models import Doorway

from mesa_mobility.dashboard.session import serialization
from mesa_mobility.dashboard.session.colouring import COLOURINGS
from mesa_mobility.dashboard.session.observer import Observer
from mesa_mobility.results import Trajectories
from tests.fixtures.waiting import until


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
