"""Pictures are looked at through their pixels: what must be seen has a colour of its own."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.image import imread

from mesa_mobility.errors import ResultsError
from mesa_mobility.floorplan import Exit, FloorPlan
from mesa_mobility.results import plot_occupancy, plot_snapshots, plot_trajectories
from mesa_mobility.results.floor import DOOR, EXIT, OBSTACLE, WALL
from mesa_mobility.results.plots import BODY, LEFT_INSIDE, REFERENCE


def pixels(path, colour):
    """(k, 2) column and row, from the lower left, of the pixels of a colour.

    Only squares of 2 x 2 count: the soft edges of letters have single pixels of any grey.
    """
    picture = imread(path)[::-1, :, :3]
    same = np.all(np.abs(picture - to_rgb(colour)) < 0.004, axis=-1)
    rows, columns = np.nonzero(same[1:, 1:] & same[1:, :-1] & same[:-1, 1:] & same[:-1, :-1])
    return np.column_stack((columns, rows))


@pytest.fixture
def empty_room():
    return FloorPlan("POLYGON ((0 0, 10 0, 10 4, 0 4, 0 0))", exits=[Exit("e", (10, 1), (10, 3))])


def test_the_plan_is_where_it_should_be(two_leave_one_stays, room, tmp_path):
    path = tmp_path / "tracks.png"
    plot_trajectories(two_leave_one_stays, room, path)
    walls, door, way_out, pillar = (pixels(path, colour) for colour in (WALL, DOOR, EXIT, OBSTACLE))
    # Just below the upper wall only the left and the right wall are dark; below the plan, the
    # legend repeats each colour once more.
    top = walls[:, 1].max()
    left, right = walls[walls[:, 1] == top - 4, 0]
    metre = (right - left) / 10
    bottom = top - 4 * metre

    def upper(found):
        return found[found[:, 1] > bottom - 0.05 * metre]

    assert upper(door)[:, 0].mean() == pytest.approx(left + 5 * metre, abs=0.1 * metre)
    assert np.ptp(upper(door)[:, 1]) == pytest.approx(4 * metre, rel=0.05)
    assert upper(way_out)[:, 0].mean() == pytest.approx(right, abs=0.1 * metre)
    assert upper(way_out)[:, 1].mean() == pytest.approx(bottom + 2 * metre, abs=0.1 * metre)
    assert upper(pillar).mean(axis=0) == pytest.approx(
        [left + 2.5 * metre, bottom + 1.5 * metre], abs=0.1 * metre
    )


def test_only_what_the_plan_has_is_explained(walk, empty_room, tmp_path):
    path = tmp_path / "tracks.png"
    plot_trajectories(walk({0: (0, [(1, 1), (2, 2)])}, last_frame=2), empty_room, path)
    assert len(pixels(path, EXIT))
    for colour in (DOOR, OBSTACLE):
        assert not len(pixels(path, colour))


def test_a_closed_exit_is_a_wall(walk, tmp_path):
    plan = FloorPlan(
        "POLYGON ((0 0, 10 0, 10 4, 0 4, 0 0))",
        exits=[Exit("e", (10, 1), (10, 3)), Exit("w", (0, 1), (0, 3))],
    )
    run = walk({0: (0, [(1, 1), (2, 2)])})
    plot_trajectories(run, plan, tmp_path / "open.png")
    plan.close_gate("w")
    plot_trajectories(run, plan, tmp_path / "closed.png")
    # The legend's own line counts in both.
    assert len(pixels(tmp_path / "closed.png", EXIT)) < 0.8 * len(
        pixels(tmp_path / "open.png", EXIT)
    )


def test_who_is_still_inside_is_marked(walk, empty_room, tmp_path):
    marks = []
    for name, inside in (("some.png", [0]), ("nobody.png", [])):
        run = walk({0: (0, [(1, 1), (2, 2)])}, inside_at_end=inside)
        plot_trajectories(run, empty_room, tmp_path / name)
        marks.append(len(pixels(tmp_path / name, LEFT_INSIDE)))
    # Letters and the frame of the colour bar are black too.
    assert marks[0] > marks[1] + 50


def test_equal_runs_give_equal_pictures(two_leave_one_stays, room, tmp_path):
    for name in ("a.png", "b.png"):
        plot_trajectories(two_leave_one_stays, room, tmp_path / name)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_occupancy_shows_the_reference_when_there_is_one(tmp_path):
    curve = [[0, 10], [1, 6], [2, 0]]
    plot_occupancy(curve, tmp_path / "alone.png")
    plot_occupancy(curve, tmp_path / "compared.png", reference={0.5: 8, 1.5: 2})
    assert len(pixels(tmp_path / "alone.png", BODY))
    assert not len(pixels(tmp_path / "alone.png", REFERENCE))
    assert len(pixels(tmp_path / "compared.png", REFERENCE))


def test_occupancy_of_nothing_is_refused(tmp_path):
    with pytest.raises(ResultsError, match="no occupancy"):
        plot_occupancy([], tmp_path / "none.png")
    assert list(tmp_path.iterdir()) == []


def test_snapshots_show_everybody_inside(two_leave_one_stays, empty_room, tmp_path):
    plot_snapshots(two_leave_one_stays, empty_room, tmp_path / "one.png", times=[2.0])
    plot_snapshots(two_leave_one_stays, empty_room, tmp_path / "three.png", times=[0.5])
    assert len(pixels(tmp_path / "three.png", BODY)) > len(pixels(tmp_path / "one.png", BODY)) > 0


@pytest.mark.parametrize("times", [[], [2.5], [-1.0]])
def test_snapshots_outside_the_run_are_refused(two_leave_one_stays, empty_room, tmp_path, times):
    with pytest.raises(ResultsError, match=r"run of 2\.00 s"):
        plot_snapshots(two_leave_one_stays, empty_room, tmp_path / "none.png", times=times)
