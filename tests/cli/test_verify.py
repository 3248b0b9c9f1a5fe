import json

import pytest


def test_json_names_what_was_measured_and_wanted(command):
    outcome = command("verify", "rimea-01", "imo-01", "--jobs", 1, "--json")
    assert outcome.status == 0
    answer = json.loads(outcome.out.splitlines()[-1])
    assert list(answer) == ["rimea-01", "imo-01"]
    for each in answer.values():
        assert each["passed"] is True
        assert each["verdict"] == "pass"
        assert each["seeds"] == [1]
        assert each["safety"]["overlaps"] == each["safety"]["wall_crossings"] == 0
    walk = answer["rimea-01"]
    assert "RiMEA" in walk["source"]
    assert "[26, 34]" in walk["criterion"]
    # 39.8 m at 1.33 m/s take 29.9 s, and half a second or so to start.
    assert walk["measured"]["travel time s"] == pytest.approx(30.2, abs=0.7)
    assert walk["measured"]["speed m/s"] == pytest.approx(1.33, rel=0.05)
    assert "2 passed, 0 failed" in outcome.err


def test_an_unknown_id_is_bad_input_in_one_line(command):
    outcome = command("verify", "rimea-01b")
    assert outcome.status == 2
    assert outcome.out == ""
    assert outcome.err.startswith("error: unknown test 'rimea-01b', did you mean 'rimea-01'?")
    assert len(outcome.err.splitlines()) == 1


def test_an_unknown_experiment_is_bad_input_in_one_line(command):
    outcome = command("validate", "corridors")
    assert outcome.status == 2
    assert outcome.err.startswith("error: unknown experiment 'corridors', did you mean 'corridor'?")
    assert len(outcome.err.splitlines()) == 1


@pytest.mark.parametrize("option", [("--seeds", 0), ("--jobs", 0), ("--seeds", "many")])
def test_numbers_out_of_range_are_bad_input(command, option):
    assert command("verify", "rimea-01", *option).status == 2
    assert command("validate", "walking", *option).status == 2


def test_a_test_that_fails_ends_with_status_1(command, monkeypatch):
    from mesa_mobility.verification import Verdict, VerificationTest, rimea
    from mesa_mobility.verification.checks import at_most

    fails = VerificationTest(
        rimea.TESTS["rimea-01"].cases, judge=lambda runs: Verdict((at_most("never", 1.0, 0.0),))
    )
    monkeypatch.setitem(rimea.TESTS, "rimea-01", fails)
    outcome = command("verify", "rimea-01", "--json")
    assert outcome.status == 1
    answer = json.loads(outcome.out.splitlines()[-1])
    assert answer["rimea-01"]["passed"] is False
    assert answer["rimea-01"]["failed"] == ["never: 1, wanted at most 0 (seed 1)"]
    assert "rimea-01: never: 1, wanted at most 0 (seed 1)" in outcome.err
