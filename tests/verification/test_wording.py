"""Names of figures in words, and checks over several seeds."""

import re

import pytest

from mesa_mobility.distributions import Uniform
from mesa_mobility.verification import Verdict, VerificationTest, case, judged
from mesa_mobility.verification.catalogue import catalogue, readings, standards, suite
from mesa_mobility.verification.checks import within
from mesa_mobility.verification.wording import figure_words, number_words


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("travel time s", "travel time (s)"),
        ("speed where 0.5 m/s is set m/s", "speed where 0.5 m/s is set (m/s)"),
        ("least y m", "least y of the way (m)"),
        ("flow at 1.2 m per s", "flow at 1.2 m (persons/s)"),
        ("density in front at 1.2 m", "density in front at 1.2 m (persons/m²)"),
        ("v at 0.5/m2", "speed at 0.5 persons/m² (m/s)"),
        ("J of 60 people per m s", "specific flow of 60 people (persons/(m s))"),
        ("dense: v at 1.9/m", "dense: speed at 1.9 persons/m (m/s)"),
        ("gamma: KS p", "gamma: probability in a Kolmogorov-Smirnov test"),
        ("T50/T0", "time against 50 people over that against none"),
        ("T0 s", "time against 0 people (s)"),
        ("wall_crossings", "steps through walls"),
        ("all out s", "time until everybody is out (s)"),
        ("corridor: acceleration m/s2, p50", "corridor: acceleration m/s2, p50"),
        ("time at a = 5 m s", "time at a goal at 5 m (s)"),
    ],
)
def test_figures_are_named_in_words(name, words):
    assert figure_words(name) == words


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("preferred", 0.853265, "preferred speed on a level floor 0.8533 m/s"),
        ("risers", 28, "28 risers"),
        ("up", False, "down"),
        ("goal", 2, "to level 2"),
        ("goal", 2.0, "goal 2 m behind"),
        ("times", Uniform(10.0, 100.0), "pre-movement times in s: uniform (low 10.0, high 100.0)"),
        ("turn_s", 3.0, "turn (s) 3"),
    ],
)
def test_numbers_of_cases_are_said_with_their_units(name, value, words):
    assert number_words(name, value) == words


def test_all_numbers_of_all_tests_have_words():
    for test in suite().values():
        for each in test.cases:
            assert not re.search(r"True|False|_|\w=", each.words), each.words


def nothing(seed):
    return {}


def test_checks_of_all_seeds_have_the_median_and_are_met_if_all_are():
    values = iter([1.0, 5.0, 2.0])
    test = VerificationTest(
        (case(nothing),),
        judge=lambda runs: Verdict((within("time s", next(values), 0.0, 4.0),)),
    )
    safe = {"overlaps": 0, "wall_crossings": 0, "person_s": 1.0, "fallback_time_share": 0.0}
    outcome = judged(test, [1, 2, 3], [[safe]] * 3)
    time, overlaps, walls = outcome.checks
    assert (time.figure, time.value, time.wanted, time.met) == ("time s", 2.0, "0 to 4", False)
    assert (overlaps.value, overlaps.met, walls.met) == (0.0, True, True)
    assert outcome.verdict == "fail"


def test_the_catalogue_reads_as_a_report_does():
    known, titles = readings(), standards()
    for each in catalogue().values():
        assert set(each.read) <= set(known)
        assert each.id.partition("-")[0] in {name.lower() for name in titles}
        for text in (each.source, each.geometry, each.criterion, each.chosen, each.population):
            assert not any(part in text for part in ("POLYGON", "LINESTRING", ".csv", "see chosen"))
