from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import Trajectories

COLUMNS = ("frame", "person", "x", "y", "heading")


def columns(**changes):
    made = {
        "frame": [0, 0, 1, 1],
        "person": [0, 1, 0, 1],
        "x": [0.0, 5.0, 1.0, 6.0],
        "y": [0.0, 0.0, 0.5, 0.5],
        "heading": [0.0, 3.0, 0.1, 3.1],
    }
    return made | changes


def test_counts_people_frames_and_seconds():
    run = Trajectories(**columns(), frame_rate=30.0, last_frame=60)
    assert (len(run), run.people, run.frames) == (4, 2, 61)
    assert run.duration == 2.0


@given(order=st.permutations(range(4)))
def test_rows_come_out_by_frame_then_person(order):
    shuffled = {name: np.array(values)[list(order)] for name, values in columns().items()}
    run = Trajectories(**shuffled)
    for name, values in columns().items():
        assert getattr(run, name).tolist() == values


def test_arrays_are_read_only_and_the_callers_stay_writable():
    given_x = np.array(columns()["x"])
    run = Trajectories(**columns(x=given_x))
    with pytest.raises(ValueError, match="read-only"):
        run.x[0] = 1.0
    given_x[0] = 7.0


def test_one_radius_stands_for_everybody():
    assert Trajectories(**columns(), core_radius=0.2).radii.tolist() == [0.2, 0.2]


def test_rows_of_a_frame_and_steps_of_a_person(two_leave_one_stays):
    run = two_leave_one_stays
    assert run.frame_offsets.tolist() == [0, 2, 5, 8, 10, 12]
    start, end = run.steps(2)
    pairs = [
        (int(run.person[a]), int(run.frame[a]), int(run.frame[b]))
        for a, b in zip(start, end, strict=True)
    ]
    assert pairs == [(0, 0, 2), (1, 0, 2), (1, 1, 3), (1, 2, 4), (2, 1, 3), (2, 2, 4)]


def test_steps_do_not_bridge_a_gap(walk):
    run = Trajectories(
        frame=[0, 1, 3, 4], person=[0] * 4, x=[0.0] * 4, y=[0.0] * 4, heading=[0.0] * 4
    )
    start, _ = run.steps(1)
    assert run.frame[start].tolist() == [0, 3]


def test_who_left_when_and_how_many_were_inside(two_leave_one_stays):
    assert two_leave_one_stays.exit_frames.tolist() == [2, -1, 4]
    assert two_leave_one_stays.inside().tolist() == [2, 3, 2, 2, 1]


def test_everybody_in_the_last_frame_stays_unless_said_otherwise():
    assert Trajectories(**columns()).remaining.tolist() == [0, 1]
    assert Trajectories(**columns(), last_frame=2).remaining.tolist() == []


def test_taken_from_a_model_that_recorded():
    model = SimpleNamespace(
        recorder=SimpleNamespace(arrays=lambda: columns()),
        frame_rate=30.0,
        core_radii=np.array([0.15, 0.2]),
        elapsed=0.1,
        rows=np.array([], dtype=np.int64),
    )
    run = Trajectories.of(model)
    assert run.frames == 4
    assert run.remaining.tolist() == []
    assert run.radii.tolist() == [0.15, 0.2]


def test_model_without_recorder_says_what_to_do():
    with pytest.raises(ResultsError, match="record=True"):
        Trajectories.of(SimpleNamespace(recorder=None))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"x": [0.0, 1.0]}, "unequal length"),
        ({"x": [[0.0, 1.0, 2.0, 3.0]]}, r"x has shape \(1, 4\)"),
        ({"y": [0.0, np.nan, 0.0, 0.0]}, "y of row 1 is nan"),
        ({"heading": [0.0, 0.0, 0.0, np.inf]}, "heading of row 3 is inf"),
        ({"frame": [0, 0, 1, -1]}, "frame runs from -1 to 1"),
        ({"person": [0, 1, 0, 2**40]}, "person runs from 0 to 1099511627776"),
        ({"frame": [0.0, 0.0, 1.0, 1.5]}, "frame holds float64, expected whole numbers"),
        ({"frame": [0, 0, 1, 0]}, "person 1 is twice in frame 0"),
        ({"frame_rate": 0.0}, "frame_rate is 0.0"),
        ({"frame_rate": np.nan}, "frame_rate is nan"),
        ({"core_radius": [0.15]}, r"core_radius has shape \(1,\), expected one for each of 2"),
        ({"core_radius": [0.15, 0.0]}, "core_radius must be positive"),
        ({"last_frame": 0}, "last_frame is 0, but there are rows of frame 1"),
        ({"last_frame": 3, "inside_at_end": [1]}, "person 1 .* no row in frame 3"),
    ],
)
def test_what_cannot_be_a_run_is_refused(changes, message):
    with pytest.raises(ResultsError, match=message):
        Trajectories(**columns(**changes))


def test_an_empty_run_is_a_run():
    run = Trajectories(**{name: [] for name in COLUMNS})
    assert (len(run), run.people, run.frames) == (0, 0, 1)
    assert run.inside().tolist() == [0]
