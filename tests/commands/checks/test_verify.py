import json
import re

import pytest


@pytest.mark.thorough
def test_json_names_what_was_measured_and_wanted(command):
    outcome = command("verify", "rimea-01", "imo-01", "--jobs", 1, "--json")
    assert outcome.status == 0
    answer = json.loads(outcome.out.splitlines()[-1])
    assert list(answer) == ["rimea-01", "imo-01"]
    for each in answer.values():
        assert each["passed"] is True
        assert each["verdict"] == "pass"
        assert each["seeds"] == [1]
        assert each["preset"] == "default"
        assert each["safety"]["overlaps"] == each["safety"]["wall_crossings"] == 0
    walk = answer["rimea-01"]
    assert "RiMEA" in walk["source"]
    assert "26 to 34 s" in walk["criterion"]
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


@pytest.mark.thorough
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


def text_of(page):
    """A page's text, after a look whether it needs another file."""
    text = page.read_text(encoding="utf-8")
    assert not re.search(r"(?:src|href)=\"(?!data:|#)", text)
    return text


@pytest.mark.thorough
def test_the_report_of_a_test_has_all_that_authorities_ask_for(command, tmp_path):
    page = tmp_path / "report.html"
    outcome = command("verify", "rimea-01", "--jobs", 1, "--report", page, "--json")
    assert outcome.status == 0
    assert f"written to {page}" in outcome.err
    measured = json.loads(outcome.out.splitlines()[-1])["rimea-01"]["measured"]
    text = text_of(page)
    title = "one person walks along a corridor at their own speed"
    assert f'<h3 id="rimea-01">3.1 rimea-01: {title}</h3>' in text
    assert "<td>source</td><td>RiMEA guideline 3.0 and 4.1.1, test 1</td>" in text
    assert "The person walks the 40 m in 26 to 34 s" in text
    time = f"{measured['travel time s']:.4g}"
    assert f'<td>travel time (s)</td><td class="number">{time}</td><td>26 to 34</td>' in text
    assert '<td>verdict</td><td><span class="pass">pass</span></td>' in text
    assert text.count("data:image/png;base64,") == 1
    assert "Ways of 1 person" in text
    words = re.search(r'<pre class="command">(.*?)</pre>', text)[1]
    assert re.sub("<[^>]+>", "", words) == "mesa-mobility verify rimea-01 --seeds 1"
    assert re.search(r"<td>mesa-mobility</td><td>\d", text)
    assert re.search(r"<td>recorded movements: able bodied</td>.{0,40}[0-9a-f]{64}", text)


def test_a_report_that_cannot_be_written_is_found_out_before_the_runs(command, tmp_path):
    (tmp_path / "file").touch()
    for name in ("verify", "validate"):
        outcome = command(name, "--report", tmp_path / "file" / "report.html")
        assert outcome.status == 2
        assert outcome.err.startswith("error: ")
        assert len(outcome.err.splitlines()) == 1
