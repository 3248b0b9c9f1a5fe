"""Corners and the counter, on ways and figures made up by hand."""

import numpy as np
import pytest

from mesa_mobility.results import Trajectories
from mesa_mobility.validation.scenes import corners, counter


def unmet(verdict) -> list[str]:
    return [check.figure for check in verdict.checks if check.gates and not check.met]


def test_a_detour_is_measured_against_the_way_that_touches_the_inner_corner():
    # The inner corner is at (9.6, 2.4): 6 m along x and 8 m along y from it, at right angles.
    start, end = (3.6, 2.4), (9.6, 10.4)
    assert corners.detour(np.array([start, corners.INNER, end])) == pytest.approx(1.0)
    # By the outer corner: 8.4 m + 8 m + 2.4 m + 2.4 m in place of 14 m.
    outer = np.array([start, (3.6, 0.0), (12.0, 0.0), (12.0, 10.4), end])
    assert corners.detour(outer) == pytest.approx((2.4 + 8.4 + 10.4 + 2.4) / 14.0)
    # From beside the outer wall to just behind the corner the straight line is free.
    free = np.array([(9.0, 0.2), (11.0, 3.0)])
    assert corners.detour(free) == pytest.approx(1.0)
    there_and_back = np.array([(9.0, 0.2), (8.0, 0.2), (9.0, 0.2), (11.0, 3.0)])
    length = np.hypot(2.0, 2.8)
    assert corners.detour(there_and_back) == pytest.approx((2.0 + length) / length)


def corner(lone: dict | None = None, crowd: dict | None = None) -> list[dict]:
    """Lone people on the shortest way, and a crowd as measured: 1.75/m2, 0.867 m/s, 3.64 1/s."""
    walkers = {"detours": np.full(24, 1.05), "left_inside": 0, **(lone or {})}
    measured = {
        "density": 1.8,
        "speed": 0.85,
        "flow": 3.6,
        "inner_speed": 0.8,
        "outer_speed": 0.9,
        "inner_share": 0.5,
        **(crowd or {}),
    }
    return [walkers, measured]


def test_corners_as_measured_pass():
    assert unmet(corners.judge([corner()])) == []


@pytest.mark.parametrize(
    ("changes", "wrong"),
    [
        (
            {"lone": {"detours": np.array([1.0] * 22 + [1.4] * 2)}},
            "alone: way over the shortest one, p95",
        ),
        ({"lone": {"left_inside": 1}}, "alone: left inside"),
        ({"crowd": {"density": 1.3}}, "condition of crowd before the corner: density 1/m2"),
        ({"crowd": {"flow": 3.1}}, "condition of crowd before the corner: flow 1/s"),
        # 0.651 to 1.051 m/s were measured.
        ({"crowd": {"speed": 1.1}}, "crowd: speed before the corner m/s"),
        # The queue stands along the inner wall, and the outer half walks.
        ({"crowd": {"inner_speed": 0.3}}, "crowd: speed of the inner half over the outer"),
        ({"crowd": {"outer_speed": 0.5}}, "crowd: speed of the inner half over the outer"),
        ({"crowd": {"inner_share": 0.75}}, "crowd: share of people in the inner half"),
        ({"crowd": {"inner_share": None}}, "crowd: share of people in the inner half"),
    ],
)
def test_each_figure_of_a_corner_is_judged_on_its_own(changes, wrong):
    assert unmet(corners.judge([corner(**changes)])) == [wrong]


def standing(places, frames: int = 91) -> Trajectories:
    """People who stand still for three seconds."""
    x, y = np.repeat(np.array(places).T[:, None], frames, axis=1)
    frame, person = np.indices((frames, len(places)))
    return Trajectories(
        frame.ravel(), person.ravel(), x.ravel(), y.ravel(), np.zeros(x.size), frame_rate=30.0
    )


def test_a_line_has_no_breadth_and_a_half_disc_has():
    x, y = counter.COUNTER
    line = [(x - 0.6 * k, y) for k in range(6)]
    breadth, waiting = counter.breadths(standing(line))
    np.testing.assert_allclose(breadth, [0.0, 0.0, 0.0], atol=1e-6)
    assert waiting.tolist() == [6, 6, 6]
    # A half disc of radius R has variances R^2/4 across and R^2 (1/4 - 16/(9 pi^2)) along.
    grid = np.stack(np.meshgrid(np.linspace(-2, 0, 41), np.linspace(-2, 2, 81)), axis=-1)
    cloud = grid.reshape(-1, 2)
    cloud = cloud[np.hypot(*cloud.T) <= 2.0] + counter.COUNTER
    breadth, _ = counter.breadths(standing(cloud))
    assert breadth == pytest.approx(np.sqrt(1 - 64 / (9 * np.pi**2)), abs=0.01)


def test_people_who_are_few_or_walk_or_are_far_do_not_wait():
    x, y = counter.COUNTER
    three = [(x - 0.6 * k, y) for k in range(3)]
    assert len(counter.breadths(standing([*three, (x - 6.5, y)]))[0]) == 0
    run = standing([(x - 0.6 * k, y) for k in range(4)])
    walking = Trajectories(
        run.frame, run.person, run.x + 0.02 * run.frame, run.y, run.heading, frame_rate=30.0
    )
    assert len(counter.breadths(walking)[0]) == 0


@pytest.mark.parametrize(
    ("change", "wrong"),
    [
        ({}, []),
        ({"breadth": np.full(20, 0.5)}, ["breadth over length of the queue, p90"]),
        (
            {"breadth": np.empty(0), "waiting": np.empty(0, dtype=int)},
            [
                "condition of the counter: most people who wait",
                "breadth over length of the queue, p90",
            ],
        ),
        ({"left_inside": 2}, ["left inside"]),
    ],
)
def test_a_queue_is_told_from_a_cloud(change, wrong):
    run = {"breadth": np.full(20, 0.05), "waiting": np.full(20, 5), "left_inside": 0, **change}
    assert unmet(counter.judge([[run]])) == wrong


def test_pictures_can_be_drawn():
    verdict = corners.judge([corner()])
    ratio, halves = corners.draw(verdict.figures).axes
    assert sum(each.get_height() for each in ratio.patches) == 24
    assert [each.get_height() for each in halves.patches[:2]] == [0.8, 0.9]
    run = {"breadth": np.full(20, 0.05), "waiting": np.full(20, 5), "left_inside": 0}
    (bars,) = counter.draw(counter.judge([[run]]).figures).axes
    assert sum(each.get_height() for each in bars.patches) == 20
