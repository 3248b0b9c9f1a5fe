import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import LineString, Point, box

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import Trajectories, WallCrossing, check_safety, safety
from mesa_mobility.results.overlaps import NAMED

NO_WALLS = np.empty((0, 4))
# A wall along x = 0 with an opening between y = 1 and y = 2, and a corner at its lower end.
WALLS = [[0, 0, 0, 1], [0, 2, 0, 3], [0, 0, 3, 0]]


@pytest.mark.parametrize(
    ("track", "crossed"),
    [
        ([(-1.0, 0.5), (1.0, 0.5)], 1),  # through the lower part
        ([(-1.0, 1.5), (1.0, 1.5)], 0),  # through the opening
        ([(-1.0, 0.5), (-0.1, 0.5), (-1.0, 0.5)], 0),  # up to the wall and back
        ([(-1.0, 0.5), (1.0, 0.5), (-1.0, 0.5)], 2),  # there and back
        ([(-1.0, 0.5), (0.0, 0.5)], 1),  # onto the wall
        ([(-1.0, 1.0), (1.0, -1.0)], 1),  # through the corner of two walls
    ],
)
def test_steps_through_walls(walk, track, crossed):
    report = check_safety(walk({0: (0, track)}), WALLS)
    assert report.wall_crossings == crossed
    assert report.passed is (crossed == 0)


def test_a_crossing_says_where(walk):
    run = walk({4: (7, [(-1.0, 1.5), (1.0, 1.5), (1.0, 2.5), (-1.0, 2.5)])})
    assert check_safety(run, WALLS).crossings == (WallCrossing(frame=9, person=4, wall=1),)


def test_somebody_away_in_between_makes_no_step(walk):
    run = Trajectories(frame=[0, 2], person=[0, 0], x=[-1, 1], y=[0.5, 0.5], heading=[0, 0])
    assert check_safety(run, WALLS).wall_crossings == 0


def test_crossings_are_found_however_many_steps_there_are(walk, monkeypatch):
    monkeypatch.setattr(safety, "CHUNK", 2)
    run = walk({0: (0, [(1.0, 0.5)] * 5 + [(-1.0, 0.5)] * 2)})
    assert check_safety(run, WALLS).crossings == (WallCrossing(frame=4, person=0, wall=0),)


def test_one_leaving_and_another_coming_make_no_step(walk):
    run = walk({0: (0, [(-1.0, 0.5)] * 2), 1: (2, [(1.0, 0.5)] * 2)})
    assert check_safety(run, WALLS).wall_crossings == 0


def test_only_the_first_few_are_named(walk):
    run = walk({0: (0, [(0.0, 0.0)] * 50), 1: (0, [(0.1, 0.0)] * 50)})
    report = check_safety(run, [[0, -1, 0, 1]])
    assert (report.overlaps, len(report.overlapping_pairs)) == (50, NAMED)
    assert (report.wall_crossings, len(report.crossings)) == (49, NAMED)
    assert [crossing.frame for crossing in report.crossings] == list(range(NAMED))


@pytest.mark.parametrize("walls", [[[0, 0, 1]], [0, 0, 1, 1], [[0, 0, 1, math.nan]]])
def test_walls_of_another_shape_are_refused(walk, walls):
    with pytest.raises(ResultsError, match="walls have shape"):
        check_safety(walk({0: (0, [(0.0, 0.0)])}), walls)


ROOM = box(0, 0, 4, 4).difference(box(1, 1, 2, 2))


@pytest.mark.parametrize(
    ("track", "inside", "off"),
    [
        ([(0.5, 0.5), (3.0, 3.0)], True, 0),
        ([(0.5, 0.5), (1.5, 1.5), (1.5, 1.6), (3.0, 3.0)], True, 2),  # in an obstacle
        ([(3.5, 0.5), (4.5, 0.5), (4.6, 0.5)], True, 2),  # out of the building
        ([(3.5, 0.5), (4.5, 0.5), (4.6, 0.5)], False, 1),  # the last place is beyond an exit
        ([(3.9, 0.5), (4.01, 0.5), (4.015, 0.5)], True, 0),  # an exit may be beside the edge
        ([(1.0, 0.5), (1.0, 1.0)], True, 0),  # on the edge
    ],
)
def test_places_off_the_floor(walk, track, inside, off):
    run = walk({3: (2, track)}, inside_at_end=np.array([3] if inside else [], dtype=np.int32))
    report = check_safety(run, NO_WALLS, ROOM)
    assert report.off_floor == off
    assert report.passed is (off == 0)


def test_off_the_floor_is_counted_only_with_a_floor(walk):
    report = check_safety(walk({0: (0, [(9.0, 9.0)])}), NO_WALLS)
    assert (report.off_floor, report.passed) == (None, True)


@settings(deadline=None)
@given(st.integers(0, 2**31), st.integers(1, 12))
def test_places_off_the_floor_are_those_of_each_person(seed, people):
    rng = np.random.default_rng(seed)
    tracks = {
        p: (int(rng.integers(4)), rng.uniform(-1, 5, (int(rng.integers(1, 6)), 2)).tolist())
        for p in range(people)
    }
    end = max(first + len(track) - 1 for first, track in tracks.values())
    there = [p for p, (first, track) in tracks.items() if first + len(track) - 1 == end]
    stay = [p for p in there if rng.random() < 0.5]
    run = Trajectories(
        frame=[f + k for f, t in tracks.values() for k in range(len(t))],
        person=[p for p, (_, t) in tracks.items() for _ in t],
        x=[x for _, t in tracks.values() for x, _ in t],
        y=[y for _, t in tracks.values() for _, y in t],
        heading=np.zeros(sum(len(t) for _, t in tracks.values())),
        inside_at_end=np.array(stay, dtype=np.int32),
    )
    expected = sum(
        ROOM.distance(Point(place)) > 0.02
        for p, (_, t) in tracks.items()
        for place in (t if p in stay else t[:-1])
    )
    assert check_safety(run, NO_WALLS, ROOM).off_floor == expected


cell = st.integers(0, 6)
people = st.lists(st.lists(st.tuples(cell, cell), min_size=4, max_size=4), min_size=1, max_size=5)
segments = st.lists(
    st.tuples(cell, cell, cell, cell).filter(lambda s: s[:2] != s[2:]), min_size=1, max_size=4
)


@given(people=people, walls=segments, radius=st.sampled_from([0.4, 0.5, 0.75, 1.1]))
@settings(max_examples=60)
def test_agrees_with_counting_one_by_one(people, walls, radius):
    run = Trajectories(
        frame=np.tile(np.arange(4), len(people)),
        person=np.repeat(np.arange(len(people)), 4),
        x=[p[0] for track in people for p in track],
        y=[p[1] for track in people for p in track],
        heading=np.zeros(4 * len(people)),
        core_radius=radius,
    )
    squared = [
        (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2
        for frame in range(4)
        for i, first in enumerate(people)
        for second in people[:i]
        for a, b in [(first[frame], second[frame])]
    ]
    report = check_safety(run, walls)
    # Squares of whole distances against (2 r - 1e-5)^2: 0.64, 1, 2.25, 4.84 less a little.
    assert report.overlaps == sum(d2 < (2 * radius - 1e-5) ** 2 for d2 in squared)
    assert report.wall_crossings == sum(
        any(meets(track[k], track[k + 1], wall[:2], wall[2:]) for wall in walls)
        for track in people
        for k in range(3)
    )


def meets(p, q, a, b):
    """Whether two segments with whole coordinates share a point, exactly."""

    def side(u, v, w):
        turn = (v[0] - u[0]) * (w[1] - u[1]) - (v[1] - u[1]) * (w[0] - u[0])
        return (turn > 0) - (turn < 0)

    def between(u, v, w):
        return all(min(u[k], v[k]) <= w[k] <= max(u[k], v[k]) for k in range(2))

    ends = (side(p, q, a), side(p, q, b), side(a, b, p), side(a, b, q))
    if p != q and ends[0] * ends[1] < 0 and ends[2] * ends[3] < 0:
        return True
    on_line = ((p, q, a, ends[0]), (p, q, b, ends[1]), (a, b, p, ends[2]), (a, b, q, ends[3]))
    return any(turn == 0 and between(u, v, w) for u, v, w, turn in on_line)


@settings(deadline=None)
@given(st.integers(0, 2**31), st.floats(0.01, 3.0))
def test_crossings_are_those_of_each_step_against_each_wall(seed, stride):
    # Steps from a hundredth of a square to twelve of them, walls of all directions and lengths.
    rng = np.random.default_rng(seed)
    frames, people = 6, 8
    tracks = rng.uniform(-5, 5, (people, 1, 2)) + np.cumsum(
        rng.normal(0, stride, (people, frames, 2)), axis=1
    )
    ends = rng.uniform(-6, 6, (10, 2))
    walls = np.concatenate([ends, ends + rng.normal(0, 2, (10, 2))], axis=1)
    run = Trajectories(
        frame=np.tile(np.arange(frames, dtype=np.int32), people),
        person=np.repeat(np.arange(people, dtype=np.int32), frames),
        x=tracks[:, :, 0].ravel(),
        y=tracks[:, :, 1].ravel(),
        heading=np.zeros(people * frames),
    )
    lines = [LineString([w[:2], w[2:]]) for w in walls]
    expected = sum(
        any(LineString(track[k : k + 2]).intersects(line) for line in lines)
        for track in tracks
        for k in range(frames - 1)
    )
    assert check_safety(run, walls).wall_crossings == expected
