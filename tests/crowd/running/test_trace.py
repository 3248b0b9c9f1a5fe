"""Where people have been in the last moments, compared with a recording of every frame."""

import numpy as np
import pytest

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Source
from mesa_mobility.crowd.running.trace import Trace

HALL = "POLYGON ((0 0, 10 0, 10 4, 0 4, 0 0))"

WEST = "POLYGON ((0.5 1, 1.5 1, 1.5 3, 0.5 3, 0.5 1))"


def model(frames_per_step=3, record=True, trace=True):
    plan = FloorPlan(HALL, exits=[Exit("east", (10, 1), (10, 3))])
    made = PedestrianModel(plan, frames_per_step=frames_per_step, record=record, rng=4)
    if trace:
        made.dynamics.trace = Trace()
    made.add_pedestrians([(9.0, 2.0), (7.5, 1.0), (6.0, 3.0)])
    made.add_source(Source(area=WEST, times=[0.5, 1.3, 2.2, 4.0, 6.1]))
    return made


def recorded(made):
    """Frame, row, x, y and heading of everybody in each frame, and the first and last of each."""
    arrays = made.recorder.arrays()
    rows = np.column_stack([arrays[each] for each in ("frame", "person", "x", "y", "heading")])
    tracks = [rows[rows[:, 1] == row] for row in np.unique(rows[:, 1])]
    return rows, np.array([each[0] for each in tracks]), np.array([each[-1] for each in tracks])


@pytest.mark.parametrize("frames_per_step", [1, 3, 45])
def test_samples_are_what_was_recorded(frames_per_step):
    made = model(frames_per_step)
    made.run(max_seconds=12.0)
    rows, first, last = recorded(made)
    found = made.dynamics.trace.until(made.frame)
    out = last[~made.crowd.active[last[:, 1].astype(int)]]
    assert len(out) > 3
    # People who cross an exit in a frame are recorded in it, but not inside any more.
    gone = {(frame, row) for frame, row in out[:, :2]}
    kept = [
        each
        for each in rows
        if each[0] % 6 == 0 and each[0] < made.frame and (each[0], each[1]) not in gone
    ]
    # Sources insert people in frames that were recorded before; they are told as newcomers.
    late = {(frame, row) for frame, row in first[3:, :2]}
    kept = np.array([each for each in kept if (each[0], each[1]) not in late])
    np.testing.assert_array_equal(np.column_stack(found.inside), kept)
    assert found.frames == list(range(0, made.frame, 6))
    assert sum(found.counts) == len(found.inside)
    came = np.column_stack(found.came)
    np.testing.assert_array_equal(came[np.argsort(came[:, 1])], first)
    left = np.column_stack(found.left)
    np.testing.assert_array_equal(left[np.argsort(left[:, 1])], out)


@pytest.mark.parametrize("frames_per_step", [3, 45])
def test_a_trace_changes_nothing(frames_per_step):
    some, other = (model(frames_per_step, False, trace) for trace in (False, True))
    for _ in range(8):
        some.step()
        other.step()
        assert some.frame == other.frame
        for name in ("x", "y", "heading", "start", "option"):
            np.testing.assert_array_equal(getattr(some.crowd, name), getattr(other.crowd, name))


def test_what_was_taken_over_is_forgotten():
    made = model()
    made.run(max_seconds=2.0)
    trace = made.dynamics.trace
    trace.drop(24)
    assert trace.until(made.frame).frames == [30, 36, 42, 48, 54]
    assert trace.until(made.frame).came.frame.min(initial=99) > 24
    trace.drop(made.frame)
    assert trace.until(made.frame + 1).frames == []
    made.run(max_seconds=3.0)
    assert trace.until(made.frame).frames == [66, 72, 78, 84]


def test_somebody_who_is_taken_out_has_left_then():
    made = model()
    made.run(max_seconds=1.0)
    place = made.crowd.x[1]
    made.remove_pedestrians([made.space.active_agents[1]])
    left = made.dynamics.trace.until(made.frame).left
    assert (left.frame.tolist(), left.person.tolist(), left.x.tolist()) == ([30], [1], [place])


def test_of_too_many_samples_every_second_one_is_left_out():
    plan = FloorPlan(HALL, exits=[Exit("east", (10, 1), (10, 3))])
    made = PedestrianModel(plan, rng=4)
    trace = made.dynamics.trace = Trace(most=10)
    made.add_pedestrians([(1.0, 2.0), (0.8, 1.0)])
    made.run(max_seconds=3.9)
    # Two people: five samples at most. 0, 6, .. 30 are six, so 0, 12, 24 stay; and so on.
    assert trace.every == 24
    assert trace.until(made.frame).frames == [0, 24, 48, 72, 96]
    trace.drop(96)
    made.run(max_seconds=4.9)
    assert trace.every == 6
    assert trace.until(made.frame).frames == [120, 126, 132, 138, 144]
