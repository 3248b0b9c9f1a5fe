"""Sources whose rate varies in time."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from mesa_mobility import PedestrianModel, Source
from mesa_mobility.crowd.insertion.inflow import Inflow
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import corridor, model_of

WEST = box(0.5, 0.5, 3.0, 3.5)


def integral(steps, time: float) -> float:
    """People expected by a time, added up step by step."""
    ends = [begin for begin, _ in steps[1:]] + [math.inf]
    return sum(
        rate * max(min(time, end) - begin, 0.0)
        for (begin, rate), end in zip(steps, ends, strict=True)
    )


def arrivals(source: Source, seed: int, frames) -> list[int]:
    """Arrivals by each of some frames, in a model without people."""
    inflow = Inflow(source, {0: None}, {0: None}, None, 0, np.random.default_rng(seed))
    counts = []
    for frame in frames:
        inflow.count(frame)
        counts.append(inflow.arrived)
    return counts


STEPS = st.lists(st.tuples(st.floats(0.5, 60.0), st.floats(0.0, 20.0)), min_size=1, max_size=8)


@given(STEPS, st.floats(0.0, 30.0), st.integers(0, 10**6))
def test_arrivals_follow_the_integral_of_the_rate(spans, first, seed):
    """The time transformed by the integral is that of a Poisson process of rate 1."""
    begins = first + np.cumsum([0.0, *(span for span, _ in spans[:-1])])
    steps = [(float(t), rate) for t, (_, rate) in zip(begins, spans, strict=True)]
    if not any(rate for _, rate in steps):
        steps[0] = (steps[0][0], 1.0)
    frames = range(0, 3000, 37)
    found = arrivals(Source(area=WEST, rate=steps), seed, frames)
    exponential = np.random.default_rng(seed).standard_exponential(30_000)
    unit = np.cumsum(exponential)
    for frame, count in zip(frames, found, strict=True):
        expected = integral(steps, frame / 30)
        assert np.sum(unit <= expected - 1e-6) <= count <= np.sum(unit <= expected + 1e-6)


@settings(max_examples=25)
@given(STEPS, st.integers(0, 10**6))
def test_the_number_of_arrivals_is_near_the_integral(spans, seed):
    begins = np.cumsum([0.0, *(span for span, _ in spans[:-1])])
    steps = [(float(t), rate) for t, (_, rate) in zip(begins, spans, strict=True)]
    steps[0] = (0.0, steps[0][1] + 0.5)
    expected = integral(steps, 200.0)
    [found] = arrivals(Source(area=WEST, rate=steps, until=300.0), seed, [6000])
    # Seven standard deviations of a Poisson distribution.
    assert abs(found - expected) <= 7 * math.sqrt(expected) + 7


def test_a_single_step_is_a_constant_rate_to_the_last_bit():
    frames = range(0, 2000, 11)
    for seed in range(20):
        one = arrivals(Source(area=WEST, rate=1.7), seed, frames)
        assert one == arrivals(Source(area=WEST, rate=[(0, 1.7)]), seed, frames)
    # As a plain process adds up waits drawn one by one.
    rng, time, expected = np.random.default_rng(5), 0.0, 0
    while (time := time + rng.exponential(1 / 1.7)) <= 60.0:
        expected += 1
    assert arrivals(Source(area=WEST, rate=1.7), 5, [1800]) == [expected]


def test_nobody_comes_while_the_rate_is_0():
    source = Source(area=WEST, rate=[(10, 5.0), (20, 0.0), (40, 5.0), (50, 0.0)])
    at = arrivals(source, 1, [299, 600, 601, 1200, 1500, 9000])
    assert at[0] == 0
    assert at[1] == at[2] == at[3] > 20
    assert at[4] == at[5] > at[3]
    assert not source.endless
    assert Source(area=WEST, rate=[(0, 0.0), (5, 1.0)]).endless


def test_start_and_until_bound_a_rate_that_varies():
    source = Source(area=WEST, rate=[(0, 2.0), (30, 4.0)], start=10.0, until=40.0)
    at = arrivals(source, 3, [300, 1200, 9000])
    assert at[0] == 0
    assert at[1] == at[2] == pytest.approx(2.0 * 20 + 4.0 * 10, abs=40)


def test_a_function_of_time_is_looked_up_second_by_second():
    source = Source(area=WEST, rate=lambda t: 0.1 * t, until=60.0)
    frames = range(0, 1900, 13)
    steps = [(second, 0.1 * (second + 0.5)) for second in range(60)]
    for seed in range(5):
        found = arrivals(source, seed, frames)
        assert found == arrivals(Source(area=WEST, rate=steps, until=60.0), seed, frames)
    # The integral of 0.1 t up to 60 s is 180.
    assert np.mean([arrivals(source, seed, [1800])[0] for seed in range(40)]) == pytest.approx(
        180, abs=4 * math.sqrt(180 / 40)
    )
    flat = Source(area=WEST, rate=lambda t: 1.5 if t < 30 else 0.0, until=60.0)
    assert flat.rate.tolist() == [[0.0, 1.5], [30.0, 0.0]]


def stream(frames_per_step: int) -> PedestrianModel:
    model = model_of(corridor(length=8.0), shipped_map(), rng=6, frames_per_step=frames_per_step)
    area = box(0.5, 0.5, 2.0, 3.5)
    model.add_source(Source(area=area, rate=[(0, 1.0), (3, 6.0), (6, 0.0)]))
    return model


def test_trajectories_do_not_depend_on_the_length_of_a_step():
    found = []
    for frames_per_step in (1, 3, 7):
        model = stream(frames_per_step)
        while model.frame < 294:
            model.step()
        rows = model.recorder.arrays()
        keep = rows["frame"] <= 290
        found.append({name: column[keep] for name, column in rows.items()})
    assert len(np.unique(found[0]["person"])) > 10
    for other in found[1:]:
        for name, column in found[0].items():
            np.testing.assert_array_equal(column, other[name])


def test_checkpoints_go_on_with_a_rate_that_varies(tmp_path):
    model, other = stream(3), stream(3)
    for _ in range(30):
        other.step()
    other.save(tmp_path / "checkpoint.zip")
    loaded = PedestrianModel.load(
        tmp_path / "checkpoint.zip", pedestrian_types=other.pedestrian_types
    )
    for _ in range(100):
        model.step()
    for _ in range(70):
        loaded.step()
    assert model.sources[0].arrived == loaded.sources[0].arrived > 10
    one, two = model.recorder.arrays(), loaded.recorder.arrays()
    for name, column in one.items():
        np.testing.assert_array_equal(column, two[name])


def test_entered_are_those_who_arrived_once_there_was_room():
    model = model_of(corridor(length=30.0, width=8.0), strider(), preset="paper", record=False)
    steps = [(0, 1.0), (10, 3.0), (20, 0.0)]
    inflow = model.add_source(Source(area=box(1, 1, 6, 7), rate=steps))
    model.run(max_seconds=120)
    assert not model.running
    assert inflow.entered == inflow.arrived == pytest.approx(40, abs=30)


@pytest.mark.parametrize(
    "rate",
    [
        [],
        [(0, 1.0, 2.0)],
        [(0, -1.0)],
        [(0, 0.0)],
        [(0, 1e9)],
        [(5, 1.0), (5, 2.0)],
        [(5, 1.0), (4, 2.0)],
        [(-1, 1.0)],
        [(0, 1.0), (1e9, 2.0)],
        [(0, np.nan)],
        [(np.nan, 1.0)],
        [(0, "many")],
        "0, 1",
        lambda t: 1.0,
    ],
)
def test_rates_that_cannot_be(rate):
    with pytest.raises(ModelError, match="source") as refused:
        Source(area=WEST, rate=rate)
    assert "\n" not in str(refused.value)


def test_functions_must_give_rates():
    for value in ("many", None, -1.0, np.nan):
        with pytest.raises(ModelError, match="source: rate"):
            Source(area=WEST, rate=lambda t, value=value: value, until=10.0)
