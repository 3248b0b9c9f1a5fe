import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility.results import Overlap, Trajectories, check_safety

NO_WALLS = np.empty((0, 4))


@pytest.mark.parametrize(
    ("distance", "overlaps"),
    [(0.30, 0), (0.299995, 0), (0.29998, 1), (0.1, 1), (0.0, 1)],
)
def test_bodies_may_touch_but_not_overlap(walk, distance, overlaps):
    run = walk({0: (0, [(0.0, 0.0)]), 1: (0, [(distance, 0.0)])}, core_radius=0.15)
    report = check_safety(run, NO_WALLS)
    assert report.overlaps == overlaps
    assert report.min_distance_m == pytest.approx(distance)
    assert report.passed is (overlaps == 0)


def test_each_pair_counts_in_each_frame(walk):
    # Three people on one spot for two frames are 3 pairs x 2 frames; in the third they part.
    spot, apart = (1.0, 1.0), [(0.0, 0.0), (3.0, 4.0), (6.0, 8.0)]
    run = walk({p: (0, [spot, spot, apart[p]]) for p in range(3)})
    report = check_safety(run, NO_WALLS)
    assert report.overlaps == 6
    assert report.overlapping_pairs[0] == Overlap(frame=0, first=0, second=1, distance_m=0.0)
    assert {(o.frame, o.first, o.second) for o in report.overlapping_pairs} == {
        (frame, *pair) for frame in (0, 1) for pair in ((0, 1), (0, 2), (1, 2))
    }


def test_each_person_has_its_own_radius(walk):
    # 0.15 + 0.25 = 0.40 between 0 and 1; 0.15 + 0.15 = 0.30 between 0 and 2.
    run = walk(
        {0: (0, [(0.0, 0.0)]), 1: (0, [(0.39, 0.0)]), 2: (0, [(-0.31, 0.0)])},
        core_radius=np.array([0.15, 0.25, 0.15]),
    )
    report = check_safety(run, NO_WALLS)
    assert [(o.first, o.second) for o in report.overlapping_pairs] == [(0, 1)]
    assert report.min_distance_m == pytest.approx(0.31)


def test_the_smallest_distance_is_over_all_frames(walk):
    run = walk({0: (0, [(0.0, 0.0)] * 3), 1: (0, [(9.0, 0.0), (3.0, 4.0), (6.0, 8.0)])})
    assert check_safety(run, NO_WALLS).min_distance_m == pytest.approx(5.0)


def test_people_never_inside_together_have_no_distance(walk):
    run = walk({0: (0, [(0.0, 0.0)]), 1: (1, [(0.0, 0.0)])})
    report = check_safety(run, NO_WALLS)
    assert report.min_distance_m is None
    assert report.overlaps == 0


@settings(deadline=None)
@given(st.integers(0, 2**31), st.integers(2, 30))
def test_overlaps_are_those_of_each_pair(seed, people):
    rng = np.random.default_rng(seed)
    frames = 4
    places = rng.uniform(0, 3, (frames, people, 2))
    radii = rng.uniform(0.05, 0.4, people)
    run = Trajectories(
        frame=np.repeat(np.arange(frames, dtype=np.int32), people),
        person=np.tile(np.arange(people, dtype=np.int32), frames),
        x=places[:, :, 0].ravel(),
        y=places[:, :, 1].ravel(),
        heading=np.zeros(people * frames),
        core_radius=radii,
    )
    first, second = np.triu_indices(people, 1)
    distance = np.hypot(*(places[:, first] - places[:, second]).transpose(2, 0, 1))
    report = check_safety(run, NO_WALLS)
    assert report.overlaps == (distance < radii[first] + radii[second] - 1e-5).sum()
    assert report.min_distance_m == pytest.approx(distance.min())
