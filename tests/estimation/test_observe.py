"""Choices of people in a corridor, from tracks written by hand."""

from dataclasses import replace

import numpy as np
import pytest
from mesa_mobility.behaviors import Headway, PreferredVelocity, TargetDistance, VelocityChange

from mesa_mobility import CostTerm, FloorPlan, Gate
from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.estimation import Sampling, estimate, leave_out, observe, profile
from mesa_mobility.estimation.choices.free_speeds import FreeSpeeds
from mesa_mobility.estimation.choices.places import places_of
from mesa_mobility.estimation.problem import Problem
from tests.estimation.tracks import RATE, corridor, rows_of, tracks_of, walking
from tests.fixtures.engine import ENGINE

pytestmark = pytest.mark.thorough

FEW = Sampling(frames=(24,), interval=0.8, alternatives=40, poses=2)


class Constant(CostTerm):
    name = "constant"

    def cost(self, candidates):
        return np.full(len(candidates), 3.0)


class Twice(CostTerm):
    name = "twice"

    def cost(self, candidates):
        return 2.0 * VelocityChange().cost(candidates)


class Rightwards(CostTerm):
    name = "rightwards"

    def cost(self, candidates):
        return -candidates.points[:, 0]


class Uneven(CostTerm):
    name = "uneven"

    def cost(self, candidates):
        return np.full(len(candidates), np.nan)


@pytest.fixture(scope="module")
def steady():
    return observe(corridor(), walking(people=9, seconds=8.0), name="a.txt", sampling=FEW)


def test_people_who_walk_on_have_options_near_enough(steady):
    """Nine people, at 0.8, 1.6, ... 6.4 s: 0.8 s after they came and before they leave."""
    assert steady.coverage.choices == 9 * 8
    assert len(steady) == 9 * 8
    assert steady.coverage.share > 0.95
    np.testing.assert_allclose(np.unique(steady.second), np.arange(1, 9) * 0.8)


def test_people_stand_where_they_were_and_choose_towards_their_exit(steady):
    batch = steady.batches[0]
    own = np.unique(batch.candidates.positions, axis=0)

    np.testing.assert_allclose(own[:3, 0], [1.96, 2.18, 2.56], atol=1e-9)
    np.testing.assert_allclose(batch.candidates.velocities[:, 0].max(), 1.2)
    assert (batch.candidates.targets[:, 0] > 19.0).all()
    # Whoever chooses was, 0.8 s later, where they had walked to.
    went = batch.ends[batch.choice] - batch.candidates.positions
    np.testing.assert_allclose(went[:, 0], 0.8 * batch.candidates.velocities[:, 0], atol=1e-9)


def test_near_options_end_within_12_cm_and_drawn_ones_do_not(steady):
    for batch in steady.batches:
        own = batch.choice[batch.candidates.owner]
        away = np.hypot(*(batch.candidates.points - batch.ends[own]).T)
        np.testing.assert_allclose(away, np.hypot(*batch.off.T), atol=1e-5)
        assert (away[batch.near] <= 0.12).all()
        drawn = np.bincount(batch.candidates.owner[~batch.near])
        assert (drawn == FEW.alternatives).all()


def test_no_attribute_depends_on_later_frames_but_the_end():
    """From 4.0 s on people walk elsewhere; what those choose from who choose then is the same."""
    before, rows = walking(people=9), rows_of(walking(people=9))
    later = rows[:, 0] > 40
    rows[later, 3] += 0.02 * (rows[later, 0] - 40)
    chosen = replace(FEW, interval=4.0, most=9)
    terms = [VelocityChange(), Headway(), PreferredVelocity(), TargetDistance()]

    def attributes(tracks):
        batch = observe(corridor(), tracks, sampling=chosen).batches[0]
        return batch.candidates, [term.cost(batch.candidates) for term in terms]

    one, costs = attributes(before)
    other, others = attributes(tracks_of(rows))

    assert one.time == other.time
    np.testing.assert_array_equal(one.neighbour_velocities, other.neighbour_velocities)
    np.testing.assert_array_equal(one.neighbour_positions, other.neighbour_positions)
    np.testing.assert_array_equal(one.velocities, other.velocities)
    np.testing.assert_array_equal(one.facings, other.facings)
    at = {int(o): k for k, o in enumerate(one.options[one.owner == 0])}
    same = [k for k, o in enumerate(other.options[other.owner == 0]) if int(o) in at]
    assert len(same) > 5
    for mine, theirs in zip(costs, others, strict=True):
        picked = [at[int(other.options[k])] for k in same]
        np.testing.assert_allclose(mine[picked], theirs[same], atol=1e-12)


def test_the_same_seed_gives_the_same_choices_and_another_does_not(steady):
    again = observe(corridor(), walking(people=9, seconds=8.0), sampling=FEW)
    other = observe(corridor(), walking(people=9, seconds=8.0), sampling=replace(FEW, seed=2))

    def options(of):
        return np.concatenate([each.candidates.options for each in of.batches])

    np.testing.assert_array_equal(options(again), options(steady))
    assert not np.array_equal(options(other)[:100], options(steady)[:100])


def test_free_speeds_are_taken_from_other_frames_of_those_with_nobody_ahead():
    tracks = places_of(walking(people=2, seconds=12.0), corridor())  # side by side, 1.1 m apart
    speeds = FreeSpeeds(tracks, 0.8)

    np.testing.assert_allclose(speeds.own(60, 0.8, 0.8), [1.2, 1.1], atol=1e-9)
    # Within 0.5 s of the choice and its seconds nothing counts: 11.9 s less 10 s are too few.
    assert np.isnan(speeds.own(60, 5.0, 5.0)).all()


def test_somebody_behind_another_has_no_free_speed():
    rows = rows_of(walking(people=2, seconds=10.0))
    rows[rows[:, 1] == 1, 2:] = rows[rows[:, 1] == 0, 2:] + [1.0, 0.0]
    speeds = FreeSpeeds(places_of(tracks_of(rows), corridor()), 0.8)

    own = speeds.own(50, 0.8, 0.8)
    assert np.isnan(own[0])
    assert own[1] == pytest.approx(1.2)


def test_a_term_constant_over_all_options_is_named(steady):
    with pytest.raises(ModelError, match="'constant': costs the same for all options"):
        estimate([VelocityChange(), Constant()], steady)


def test_a_collinear_term_is_named_with_the_other(steady):
    with pytest.raises(ModelError, match="'velocity_change': is collinear with 'twice'"):
        estimate([PreferredVelocity(), VelocityChange(), Twice()], steady)


def test_costs_that_are_no_numbers_are_named(steady):
    with pytest.raises(ModelError, match="'uneven': gave a cost of nan"):
        estimate([Uneven()], steady)


@pytest.mark.parametrize(
    ("terms", "message"),
    [
        ([], "got nothing"),
        ([VelocityChange(), VelocityChange()], "'velocity_change' twice"),
        ([3], "got 3, expected cost terms"),
        (["no_such_term"], "no_such_term"),
    ],
)
def test_what_are_no_terms_is_refused(steady, terms, message):
    with pytest.raises(ModelError, match=message):
        Problem.of(terms, steady)


def test_unknown_and_all_fixed_terms_are_refused(steady):
    with pytest.raises(ModelError, match="fixed: no term 'headway'"):
        estimate([VelocityChange()], steady, fixed=["headway"])
    with pytest.raises(ModelError, match="all terms"):
        estimate([VelocityChange()], steady, fixed=["velocity_change"])


def test_people_who_walk_on_are_estimated_to_shun_changes(steady):
    found = estimate([VelocityChange(), Rightwards(0.0)], steady, fixed=["rightwards"])

    assert found["velocity_change"] > 3.0
    assert found.intervals[0, 0] > 0.0
    assert found.errors[1] == 0.0
    assert found.likelihood_ratios[0] > 100.0
    assert np.isnan(found.likelihood_ratios[1])
    assert found.measures.uniform == pytest.approx(np.log(41.0))
    assert found.measures.nats < found.measures.uniform - 1.0
    assert "velocity_change" in str(found)
    with pytest.raises(ModelError, match="no term 'other'"):
        found["other"]


def test_a_term_on_the_ends_alone_is_not_marked_and_facing_is(steady):
    found = estimate(["velocity_change", "facing_deviation"], steady, tests=False)

    assert found.assumed[0] < 0.25
    assert found.assumed[1] > 0.25
    assert "assumed" in str(found).splitlines()[2]


def test_a_run_left_out_is_told_by_weights_of_the_others(steady):
    other = observe(
        corridor(), walking(people=9, seconds=8.0, speed=1.0), name="b.txt", sampling=FEW
    )
    both = steady + other
    assert len(both) == len(steady) + len(other)
    assert len(np.unique(both.person)) == 18

    found = leave_out([VelocityChange(), Headway()], both)

    alone = estimate([VelocityChange(), Headway()], other, tests=False)
    assert [each.fold for each in found] == ["a.txt", "b.txt"]
    np.testing.assert_allclose(found[0].weights, alone.weights, rtol=1e-3)
    assert found[0].measures.choices == len(steady)
    with pytest.raises(ModelError, match=r"got the fold 'a\.txt' alone"):
        leave_out([VelocityChange()], steady)


def test_a_profile_is_greatest_where_the_numbers_fit_and_leaves_the_term_as_it_was(steady):
    term = VelocityChange()
    found = profile("velocity_change.turning", [1.0, 1.5, 3.0], [term], steady)

    assert term.turning == 1.5
    turned = [
        estimate([VelocityChange(turning=each)], steady, tests=False).log_likelihood
        for each in (1.0, 1.5, 3.0)
    ]
    np.testing.assert_allclose(found.log_likelihoods, turned, atol=0.5)
    assert found.best == [1.0, 1.5, 3.0][int(np.argmax(turned))]
    assert found.within[0] <= found.best <= found.within[1]
    with pytest.raises(ModelError, match=r"velocity_change\.turning"):
        profile("velocity_change.no_such", [1.0], [term], steady)
    with pytest.raises(ModelError, match="no term 'headway'"):
        profile("headway.time", [1.0], [term], steady)


def test_durations_are_those_of_options():
    assert Sampling().with_frames((45, 12, 24)).frames == (24, 45)
    assert Sampling(frames=(12,)).with_frames((12, 24)).frames == (12,)
    with pytest.raises(ModelError, match=r"sampling: 36 frames, expected .*: 12, 24, 45$"):
        observe(
            corridor(),
            walking(),
            name="a.txt",
            sampling=Sampling(frames=(24, 36)),
            preset=ENGINE,
        )


def test_tracks_too_short_for_a_choice_are_refused():
    with pytest.raises(ResultsError, match=r"^c\.txt: no choice: nobody is seen for 0\.8 s before"):
        observe(corridor(), walking(seconds=1.0), name="c.txt", sampling=FEW)


def test_a_plan_without_exits_is_refused():
    plan = FloorPlan(
        "POLYGON ((0 0, 20 0, 20 4, 0 4, 0 0))",
        gates=[Gate("one", (5, 0), (5, 4)), Gate("two", (15, 0), (15, 4))],
    )
    with pytest.raises(ModelError, match="has no exit"):
        observe(plan, walking(), sampling=FEW)


def test_a_person_who_runs_faster_than_any_option_is_said_to_be_too_fast():
    rows = rows_of(walking(people=3, seconds=4.0))
    own = rows[:, 1] == 2
    rows[own, 2] = 1.0 + 4.4 * rows[own, 0] / RATE
    found = observe(corridor(), tracks_of(rows), sampling=FEW).coverage

    assert found.too_fast >= 2
    assert "went faster than any option" in str(found)
