import math

import pytest

from mesa_mobility.verification import Check, Verdict, VerificationTest, case, judged
from mesa_mobility.verification.checks import (
    at_least,
    at_most,
    exactly,
    falling,
    less_than,
    more_than,
    rising,
    within,
)


@pytest.mark.parametrize(
    ("check", "met"),
    [
        (within("f", 1.0, 1.0, 2.0), True),
        (within("f", 2.0001, 1.0, 2.0), False),
        (within("f", 0.9999, 1.0, 2.0), False),
        (within("f", None, 1.0, 2.0), False),
        (within("f", math.nan, 1.0, 2.0), False),
        (at_most("f", 3.0, 3.0), True),
        (at_most("f", 3.1, 3.0), False),
        (at_most("f", None, 3.0), False),
        (at_most("f", math.nan, 3.0), False),
        (at_least("f", 3.0, 3.0), True),
        (at_least("f", 2.9, 3.0), False),
        (at_least("f", None, 3.0), False),
        (less_than("f", 2.9, 3.0), True),
        (less_than("f", 3.0, 3.0), False),
        (more_than("f", 3.1, 3.0), True),
        (more_than("f", 3.0, 3.0), False),
        (more_than("f", None, 3.0), False),
        (exactly("f", 0, 0), True),
        (exactly("f", 1, 0), False),
        (exactly("f", None, 0), False),
    ],
)
def test_a_check_is_met_within_its_bounds_only(check, met):
    assert check.met is met


@pytest.mark.parametrize(
    ("values", "strictly", "least", "rises"),
    [
        ([1.0, 2.0, 4.0], True, 1.0, True),
        ([1.0, 4.0, 3.0], True, -1.0, False),
        ([1.0, 1.0, 3.0], True, 0.0, False),
        ([1.0, 1.0, 3.0], False, 0.0, True),
        ([1.0, None, 3.0], False, None, False),
        ([1.0], False, None, False),
    ],
)
def test_rising_and_falling_look_at_each_step(values, strictly, least, rises):
    up = rising("f", values, strictly=strictly)
    down = falling("f", values[::-1], strictly=strictly)
    assert (up.value, up.met) == (least, rises)
    assert (down.value, down.met) == (least, rises)


def test_a_verdict_without_a_gate_has_not_passed():
    assert not Verdict(()).passed
    assert not Verdict((at_most("f", 1.0, 2.0, gates=False),)).passed
    assert Verdict((at_most("f", 1.0, 2.0), at_most("g", 3.0, 2.0, gates=False))).passed
    assert not Verdict((at_most("f", 1.0, 2.0), at_most("g", 3.0, 2.0))).passed


def scenario(seed: int, *, value: float) -> dict:
    return {"value": value + seed}


def figures(value: float, **changes: object) -> dict:
    return {
        "value": value,
        "overlaps": 0,
        "wall_crossings": 0,
        "person_s": 10.0,
        "fallback_time_share": 0.1,
        **changes,
    }


def below_three(runs) -> Verdict:
    return Verdict((less_than("value", runs[0]["value"], 3.0),), {"twice": 2 * runs[0]["value"]})


TEST = VerificationTest((case(scenario, value=1.0),), judge=below_three)


def test_a_test_passes_when_each_seed_does():
    outcome = judged(TEST, [1, 2, 3], [[figures(1.0)], [figures(2.0)], [figures(2.5)]])
    assert outcome.passed
    assert outcome.verdict == "pass"
    assert outcome.measured == {"value": 2.0, "twice": 4.0, "overlaps": 0, "wall_crossings": 0}
    assert [each["seed"] for each in outcome.per_seed] == [1, 2, 3]
    assert outcome.safety == {
        "runs": 3,
        "overlaps": 0,
        "wall_crossings": 0,
        "fallback_time_share": pytest.approx(0.1),
    }


def test_one_seed_that_fails_fails_the_test():
    outcome = judged(TEST, [1, 2], [[figures(1.0)], [figures(3.0)]])
    assert not outcome.passed
    assert outcome.verdict == "fail"
    assert outcome.failed == ["value: 3, wanted less than 3 (seed 2)"]


@pytest.mark.parametrize("count", ["overlaps", "wall_crossings"])
def test_an_overlap_or_a_wall_crossing_fails_any_test(count):
    outcome = judged(TEST, [1], [[figures(1.0, **{count: 1})]])
    assert outcome.failed == [f"{count}: 1, wanted 0 (seed 1)"]
    assert outcome.safety[count] == 1


def test_a_scenario_that_breaks_fails_its_test():
    outcome = judged(TEST, [1], [[{"error": "FloorPlanError: no room"}]])
    assert outcome.verdict == "fail"
    assert "no room" in outcome.failed[0]


def over_cap(runs) -> Verdict:
    value = runs[0]["value"]
    return Verdict((within("value", value, 1.0, 3.0), at_most("cap", value, 1.5, gates=False)))


CAPPED = VerificationTest((case(scenario, value=1.0),), judge=over_cap)


@pytest.mark.parametrize(
    ("value", "verdict"), [(1.2, "pass"), (2.0, "cap"), (4.0, "fail"), (0.5, "fail")]
)
def test_a_design_cap_is_named_and_does_not_hide_a_failure(value, verdict):
    outcome = judged(CAPPED, [1], [[figures(value)]], is_cap=True)
    assert outcome.verdict == verdict
    assert outcome.passed is (verdict == "pass")


def test_a_cap_only_counts_for_tests_that_have_one():
    assert judged(CAPPED, [1], [[figures(2.0)]]).verdict == "pass"


def test_a_pooled_test_sees_all_seeds_at_once():
    def judge(seeds) -> Verdict:
        values = [run["value"] for (run,) in seeds]
        return Verdict((Check("sum", sum(values), "6", sum(values) == 6.0),))

    pooled = VerificationTest((case(scenario, value=1.0),), pooled=judge)
    outcome = judged(pooled, [1, 2], [[figures(2.0)], [figures(4.0)]])
    assert outcome.passed
    assert [each["seed"] for each in outcome.per_seed] == [None]
    assert not judged(pooled, [1], [[figures(2.0)]]).passed
