"""Bodies of several discs in finished trajectories."""

import numpy as np
import pytest
import shapely

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import Trajectories, check_safety, read_parquet

CHAIR = ((-0.25, 0.35), (0.0, 0.35), (0.25, 0.35))
WALKER = ((0.0, 0.15), (0.0, 0.0), (0.0, 0.0))
NO_WALLS = np.empty((0, 4))


def frames_of(*frames, discs) -> Trajectories:
    """A run of some frames, in each of which everybody has x, y and heading."""
    poses = np.array(frames, dtype=np.float64)
    people = poses.shape[1]
    return Trajectories(
        frame=np.repeat(np.arange(len(poses)), people),
        person=np.tile(np.arange(people), len(poses)),
        x=poses[:, :, 0].ravel(),
        y=poses[:, :, 1].ravel(),
        heading=poses[:, :, 2].ravel(),
        core_radius=np.array([max(r for _, r in body) for body in discs]),
        discs=np.array(discs),
    )


@pytest.mark.parametrize(
    ("pose", "overlaps"),
    [
        # Nose to tail along x: 0.25 + 0.35 + 0.35 + 0.25 m.
        ((1.19, 0.0, 0.0), 1),
        ((1.21, 0.0, 0.0), 0),
        # Side by side: 0.35 + 0.35 m.
        ((0.0, 0.69, 0.0), 1),
        ((0.0, 0.71, np.pi), 0),
        # Across in front: 0.25 + 0.35 + 0.35 m.
        ((0.94, 0.0, np.pi / 2), 1),
        ((0.96, 0.0, np.pi / 2), 0),
    ],
)
def test_overlaps_are_those_of_discs(pose, overlaps):
    run = frames_of([(0.0, 0.0, 0.0), pose], discs=[CHAIR, CHAIR])
    report = check_safety(run, NO_WALLS)
    assert report.overlaps == overlaps
    assert report.min_distance_m == pytest.approx(np.hypot(*pose[:2]))


@pytest.mark.parametrize(("x", "overlaps"), [(0.74, 1), (0.76, 0)])
def test_discs_that_a_body_does_not_have_touch_nobody(x, overlaps):
    # 0.25 + 0.35 + 0.15 m before a chair's nose; abreast only 0.35 + 0.15 m.
    run = frames_of(
        [(0.0, 0.0, 0.0), (x, 0.0, 0.3), (0.0, 0.51, 0.0)], discs=[CHAIR, WALKER, WALKER]
    )
    assert check_safety(run, NO_WALLS).overlaps == overlaps


def test_overlaps_are_those_of_each_pair_of_discs():
    rng = np.random.default_rng(1)
    people = 60
    poses = np.column_stack([rng.uniform(0, 9, (people, 2)), rng.uniform(-4, 4, people)])
    bodies = [CHAIR if k % 3 else WALKER for k in range(people)]
    run = frames_of(poses.tolist(), discs=bodies)
    shapes = [
        shapely.union_all([
            shapely.Point(x + o * np.cos(h), y + o * np.sin(h)).buffer(r, quad_segs=400)
            for o, r in body if r
        ])
        for (x, y, h), body in zip(poses, bodies, strict=True)
    ]  # fmt: skip
    expected = sum(a.intersects(b) for k, a in enumerate(shapes) for b in shapes[:k])
    assert check_safety(run, NO_WALLS).overlaps == expected > 20


def test_a_nose_that_swings_through_a_wall_crosses_it():
    # The position keeps 0.1 m off the wall, the centre of the foremost disc swings through it.
    run = frames_of([(0.0, 0.0, 0.0)], [(0.0, 0.0, 0.6)], discs=[CHAIR])
    wall = np.array([[0.15, 0.1, 0.4, 0.1]])
    assert check_safety(run, wall).wall_crossings == 1
    assert check_safety(frames_of([(0, 0, 0)], [(0, 0, 0.6)], discs=[WALKER]), wall).passed


def test_discs_on_the_floor():
    run = frames_of([(1.0, 2.0, np.pi / 2), (5.0, 5.0, 0.0)], discs=[CHAIR, WALKER])
    whose, discs = run.placed_discs(np.arange(2))
    assert whose.tolist() == [0, 0, 0, 1]
    assert discs == pytest.approx(
        np.array([(1, 1.75, 0.35), (1, 2, 0.35), (1, 2.25, 0.35), (5, 5, 0.15)])
    )


def test_discs_are_kept_in_files(tmp_path):
    run = frames_of([(1.0, 2.0, 0.5), (5.0, 5.0, 0.0)], discs=[CHAIR, WALKER])
    run.to_parquet(tmp_path / "run.parquet")
    again = read_parquet(tmp_path / "run.parquet")
    assert again.discs.tolist() == run.discs.tolist()
    assert again.radii.tolist() == [0.35, 0.15]


@pytest.mark.parametrize(
    ("discs", "message"),
    [
        ([[(0.0, 0.3)]], r"shape \(1, 1, 2\)"),
        ([WALKER], r"for 2 people"),
        ([CHAIR, ((0.0, 0.0),) * 3], "positive radius for each"),
        ([CHAIR, ((0.0, -0.1),) * 3], "positive radius for each"),
        ([CHAIR, ((np.nan, 0.1),) * 3], "must be finite"),
    ],
)
def test_discs_that_fit_nobody_are_refused(discs, message):
    with pytest.raises(ResultsError, match=message):
        Trajectories(
            frame=[0, 0], person=[0, 1], x=[0, 9], y=[0, 9], heading=[0, 0], discs=np.array(discs)
        )  # fmt: skip
