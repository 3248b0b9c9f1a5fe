"""Two crowds compared: figures of crowds small enough to work them out."""

import sys
import warnings

import numpy as np
import pytest
from shapely import box, contains_xy

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import Trajectories, individual_densities
from mesa_mobility.results.distances import View, compare
from mesa_mobility.results.distances.comparison import Envelope
from mesa_mobility.results.distances.samples import distance_headways, dwell_times
from mesa_mobility.results.distances.seen import Seen
from mesa_mobility.results.distances.view import smoothed

RATE = 10.0
FLOOR = box(0, 0, 20, 4)
VIEW = View(
    direction=(2.0, 0.0), area=box(5, 0, 15, 4), line=((10.0, 0.0), (10.0, 4.0)), floor=FLOOR
)


def crowd(walkers, seconds: float = 10.0) -> Trajectories:
    """People (x, y, speed along x) from t = 0 on, while they are on the floor."""
    frames = np.arange(round(seconds * RATE) + 1)
    rows = []
    for person, (x, y, speed) in enumerate(walkers):
        places = x + speed * frames / RATE
        on = (places > 0.0) & (places < 20.0)
        rows += [(f, person, place, y) for f, place in zip(frames[on], places[on], strict=True)]
    frame, person, x, y = (np.array(column) for column in zip(*rows, strict=True))
    return Trajectories(frame, person, x, y, np.zeros(len(rows)), frame_rate=RATE)


def queue(speed: float = 1.0, n: int = 5) -> Trajectories:
    """People 1.5 m apart, who cross x = 10 m one after the other; the first is at 9.95 m."""
    return crowd([(9.95 - 1.5 * k, 2.0, speed) for k in range(n)])


def test_passing_times_and_curves_over_a_line():
    run = Seen.of(queue(), VIEW)
    # PedPy counts the frame in which the step over the line ends.
    np.testing.assert_allclose(run.passing_times, [0.1, 1.6, 3.1, 4.6, 6.1])
    since = View(line=VIEW.line, after=1.0, since_first=True)
    np.testing.assert_allclose(Seen.of(queue(), since).passing_times, [0.0, 1.5, 3.0, 4.5])
    later = View(line=VIEW.line, after=1.0, until=5.0)
    np.testing.assert_allclose(Seen.of(queue(), later).passing_times, [0.6, 2.1, 3.6])
    found = compare(queue(), queue(), later, figures=["n_t"])["n_t"]
    np.testing.assert_array_equal(found.measured_curve, [0, 1, 1, 2, 3])


def test_equal_crowds_are_at_no_distance():
    walkers = [(1 + 1.3 * k, 0.5 + (0.7 * k) % 3, 0.9 + 0.05 * k) for k in range(12)]
    found = compare([crowd(walkers)] * 2, crowd(walkers), VIEW)
    assert not found.left_out
    assert len(found.distances) == 18
    for each in found.distances.values():
        # Some curves and samples are empty in so small a crowd, as bins of 20 people are.
        assert np.isnan(each.distance.middle) or each.distance.middle == pytest.approx(0.0), each
    assert [float(found[name].simulated.middle) for name in ("erd", "epc", "sc")] == [0, 1, 1]
    assert found["lateral_step"].measured == pytest.approx(0.0, abs=1e-12)


def test_half_as_fast_takes_twice_as_long():
    fast, slow = crowd([(9.95, 1, 1.0), (8.95, 2, 1.0)]), crowd([(9.95, 1, 0.5), (8.95, 2, 0.5)])
    found = compare(slow, fast, View(line=VIEW.line, since_first=True))
    # People leave at 0 and 1 s, and at 0 and 2 s after the first: ERD 1, EPC 1/2, SC 1.
    assert [float(found[name].simulated.middle) for name in ("erd", "epc", "sc")] == [1, 0.5, 1]
    assert [float(found[name].distance.middle) for name in ("erd", "epc", "sc")] == [1, 0.5, 0]
    headway = found["time_headway"]
    assert (headway.measured, float(headway.simulated.middle), headway.ratio) == (1, 2, 2)
    assert headway.distance.middle == pytest.approx(1.0)
    # N-t: 1 2 2 2 ... and 1 1 2 2 ...: one of ten seconds differs, by one person.
    assert found["n_t"].distance.middle == pytest.approx(np.sqrt(1 / 10))
    assert np.isnan(found["erd"].ratio)


def test_speeds_and_densities_of_people_who_walk_either_way():
    # In 10 m x 4 m for all 10 s: two ahead at 0.8 m/s, one back at 0.5 m/s, one outside of it.
    walkers = [(5.5, 1.0, 0.8), (6.0, 2.0, 0.8), (14.0, 3.0, -0.5), (1.0, 3.5, 0.2)]
    names = ["speed", "density", "speed_profile"]
    found = compare(crowd(walkers), crowd(walkers), VIEW, figures=names)
    # Once a second from 1 s to 9 s: in the first and last 0.75 s no speed is known.
    speeds = found["speed"].measured_sample
    np.testing.assert_allclose(np.sort(speeds), [0.5] * 9 + [0.8] * 18)
    np.testing.assert_array_equal(found["speed"].sample, speeds)
    assert found["speed"].measured == pytest.approx(0.7)
    assert found["density"].measured == pytest.approx(3 / 40)
    assert found["density"].curve is None
    # Nobody walks backwards.
    assert np.nanmin(found["speed_profile"].measured_curve) >= 0.5 - 1e-9


def test_dwell_times_are_of_people_who_came_and_left():
    walkers = [(4.0, 1.0, 2.0), (4.0, 2.0, 4.0), (7.0, 3.0, 2.0), (4.0, 3.5, 1.0)]
    found = compare(crowd(walkers, 7.0), crowd(walkers, 7.0), VIEW, figures=["dwell_time"])
    # 10 m at 2 and 4 m/s; the third began inside, and the fourth is still inside at the end.
    seen = Seen.of(crowd(walkers, 7.0), VIEW)
    times = dwell_times(seen.tracks, seen.view)
    assert len(times) == 2
    np.testing.assert_allclose(np.sort(times), [2.5, 5.0], atol=0.2)
    assert found["dwell_time"].measured == pytest.approx(np.median(times))


def test_headways_are_to_the_next_in_the_same_lane_and_way():
    walkers = [
        (6.0, 2.0, 0.5),
        (7.2, 2.3, 0.5),  # ahead of the first
        (6.5, 2.4, 0.5),  # to the side of the first, in the lane of the second
        (6.4, 2.0, -0.4),  # comes the other way
    ]
    seen = Seen.of(crowd(walkers, 2.0), VIEW)
    at_start = distance_headways(seen.moments[:1])
    np.testing.assert_allclose(np.sort(at_start), [0.7, 1.2])


def test_lanes_are_found_by_the_way_that_people_walk():
    tidy = [(x, y, speed) for y, speed in ((0.6, 1.0), (1.8, -1.0)) for x in (8.0, 10.0, 12.0)]
    mixed = [(x, 0.6, speed) for x, speed in ((8.0, 1.0), (9.0, -1.0), (10.0, 1.0), (11.0, -1.0))]
    view = View(direction=(1, 0), area=box(0, 0, 20, 4))
    found = compare(crowd(mixed, 2.0), crowd(tidy, 2.0), view, figures=["lane_order"])["lane_order"]
    assert (found.measured, float(found.simulated.middle)) == (1.0, 0.0)
    assert found.distance.middle == pytest.approx(1.0)


def test_speeds_and_densities_are_those_of_lattices():
    walkers = [(0.5 + k, 0.5 + j, 1.2) for k in range(8) for j in range(4)]
    run = Seen.of(crowd(walkers, 6.0), VIEW)
    rows = run.moving
    np.testing.assert_allclose(rows["speed"], 1.2)
    at = rows[rows["frame"] == 30]
    now = run.tracks.frame == 30
    points = np.column_stack([run.tracks.x[now], run.tracks.y[now]])
    own = individual_densities(points, FLOOR, contains_xy(VIEW.area, *points.T))
    np.testing.assert_allclose(np.sort(at["density"]), np.sort(own), rtol=1e-9)


def test_profiles_are_means_over_time_in_cells():
    # Two people walk through, one 0.4 m from the lower wall and one 2.2 m.
    run = Seen.of(crowd([(5.2, 0.4, 0.5), (5.2, 2.2, 1.0)], 9.0), VIEW)
    density, speed = (each.reshape(8, 20) for each in run.profiles)
    # Row 0 is the uppermost. Frames with 0.75 s before and after: at 1 to 8 s.
    np.testing.assert_allclose(np.flatnonzero(np.isfinite(speed).any(axis=1)), [3, 7])
    np.testing.assert_allclose(np.nanmean(speed[7]), 0.5)
    np.testing.assert_allclose(np.nanmean(speed[3]), 1.0)
    # The slow one is in a new cell each second, of 10 seconds: 1 / 0.25 m2 / 10.
    np.testing.assert_allclose(density[7][np.isfinite(speed[7])], 0.4)


def test_speeds_are_compared_by_density():
    def lattice(speed):
        return crowd([(0.5 + k, 0.5 + j, speed) for k in range(12) for j in range(4)], 4.0)

    found = compare(lattice(0.8), lattice(1.0), VIEW, figures=["speed_density"])["speed_density"]
    known = np.isfinite(found.measured_curve)
    # Inside the lattice, each has 1 m2.
    assert np.flatnonzero(known).tolist() == [4]
    assert found.measured_curve[4] == pytest.approx(1.0)
    assert found.distance.middle == pytest.approx(0.2)
    assert found.curve.middle[4] == pytest.approx(0.8)


def test_envelopes_are_over_seeds():
    runs = [queue(speed) for speed in (0.5, 1.0, 2.0)]
    found = compare(runs, queue(), View(line=VIEW.line), figures=["time_headway"])["time_headway"]
    # 3, 1.5 and 0.75 s (of frames): quantiles 0.05, 0.5 and 0.95 of them.
    low, middle, high = np.quantile([3.0, 1.5, 0.75], (0.05, 0.5, 0.95))
    np.testing.assert_allclose(
        [found.simulated.low, found.simulated.middle, found.simulated.high],
        [low, middle, high],
        atol=0.05,
    )
    assert found.simulated.seeds == 3


def test_seeds_without_a_value_do_not_count():
    found = Envelope.of(np.array([[1.0, np.nan], [3.0, np.nan], [np.nan, np.nan]]))
    assert found.middle[0] == 2.0
    assert np.isnan(found.middle[1])
    assert found.seeds == 3


def test_several_measured_runs_count_together():
    runs = [crowd([(9.95 - gap * k, 2, 1.0) for k in range(3)]) for gap in (1.0, 2.0)]
    found = compare(queue(), runs, View(line=VIEW.line))
    assert found["time_headway"].measured == pytest.approx(1.5)
    np.testing.assert_allclose(found["n_t"].measured_curve[:6], [0, 1, 1.5, 2.5, 2.5, 3])


def test_the_measured_crowd_may_have_a_view_of_its_own():
    found = compare(
        queue(), queue(), View(line=VIEW.line), measured_view=View(line=VIEW.line, after=3.0)
    )
    assert found["n_t"].measured == 3
    assert found["n_t"].simulated.middle == 5


def test_heads_are_smoothed_alike():
    frames = np.arange(200)
    sway = 0.05 * np.sin(2 * np.pi * frames / RATE)  # a cycle a second
    run = Trajectories(
        frames, np.zeros(200, int), frames / RATE, sway, np.zeros(200), frame_rate=RATE
    )
    # A Gaussian of s seconds leaves exp(-(2 pi s)^2 / 2) of a sine of 1 Hz.
    left = smoothed(run, 0.3).y[50:150]
    assert np.abs(left).max() == pytest.approx(0.05 * np.exp(-((0.6 * np.pi) ** 2) / 2), rel=0.05)
    assert View(smoothing=0.3).of(run).y[100] == smoothed(run, 0.3).y[100]


def test_tables_have_a_row_for_each_figure():
    found = compare([queue(0.9), queue(1.1)], queue(), VIEW)
    table = found.to_pandas()
    assert table["figure"].tolist() == list(found.distances)
    assert (table["seeds"] == 2).all()
    assert "time_headway" in str(found)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: compare(queue(), queue(), VIEW, figures=["n-t"]), "figure 'n-t': expected one of"),
        (lambda: compare([], queue(), VIEW), "simulated: no runs, expected one or more"),
        (lambda: compare(queue(), [], VIEW), "measured: no runs, expected one or more"),
        (
            lambda: compare(queue(), queue(), View(area=FLOOR), figures=["n_t"]),
            "figure 'n_t': the view has no line",
        ),
        (
            lambda: compare(queue(), queue(), View(area=FLOOR))["n_t"],
            "figure 'n_t': the view has no line",
        ),
        (lambda: compare(queue(), queue(), View(area=FLOOR))["x"], "figure 'x': expected one of"),
        (
            lambda: compare(queue(), queue(), View(after=60.0, line=VIEW.line)),
            "view: nobody is there from 60 s to the end",
        ),
        (lambda: View(after=3.0, until=2.0), "from 3.0 to 2.0 s, expected rising times"),
        (lambda: View(direction=(0.0, 0.0)), "expected one with a length"),
        (lambda: View(area=box(0, 0, 0, 1)), "view: area has no size"),
        (lambda: View(smoothing=-1.0), "view: smoothing is -1.0"),
    ],
)
def test_what_cannot_be_compared_is_refused(call, said):
    with pytest.raises(ResultsError, match=said):
        call()


def test_without_pedpy_it_says_so(monkeypatch):
    monkeypatch.setitem(sys.modules, "pedpy", None)
    with pytest.raises(ResultsError, match="PedPy is not installed: pip install pedpy"):
        compare(queue(), queue(), View(line=VIEW.line))


def test_nobody_in_the_area_is_no_error():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        far = View(direction=(1, 0), area=box(19, 0, 20, 1), line=VIEW.line, floor=FLOOR)
        found = compare(queue(), queue(), far)
    assert np.isnan(found["dwell_time"].distance.middle)
    assert found["density_profile"].measured == 0.0
