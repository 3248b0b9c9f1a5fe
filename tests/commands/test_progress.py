"""Progress where standard error is no terminal: a line now and then, whatever is being done."""

import re
import threading
import time
from pathlib import Path

import pytest
import typer

from mesa_mobility.commands import console
from mesa_mobility.commands.app import app
from mesa_mobility.commands.console import counting_bar, progress_bar, stoppable_progress


@pytest.fixture
def often(monkeypatch):
    monkeypatch.setattr(console, "EVERY_S", 0.05)


@pytest.mark.parametrize("progress", [progress_bar, counting_bar, stoppable_progress])
def test_a_line_comes_also_while_nothing_is_reported(progress, often, capsys):
    with progress() as report:
        time.sleep(0.12)
        report("3 of 12 runs", 3.0, 12.0)
        time.sleep(0.12)
        report("compiling")
        time.sleep(0.12)
    lines = capsys.readouterr().err.splitlines()
    said = list(dict.fromkeys(lines))
    assert said == ["starting, 0:00 min", "3 of 12 runs, 25%, 0:00 min", "compiling, 0:00 min"]
    assert 3 <= len(lines) <= 8
    assert "mesa-mobility progress" not in [each.name for each in threading.enumerate()]


@pytest.mark.parametrize("progress", [progress_bar, counting_bar, stoppable_progress])
def test_there_is_none_where_none_is_asked_for(progress, often, capsys):
    with progress(shown=False) as report:
        report("3 of 12 runs", 3.0, 12.0)
        time.sleep(0.12)
    assert capsys.readouterr().err == ""


def test_lines_come_at_least_every_ten_seconds():
    # The fixture of these tests sets it for them alone.
    text = Path(console.__file__).read_text(encoding="utf-8")
    assert re.search(r"^EVERY_S = 10\.0$", text, re.M)


@pytest.mark.parametrize(
    "words",
    [
        "run",
        "verify",
        "validate",
        "experiment run",
        "map build",
        "map bootstrap",
        "map coverage",
        "map poses",
        "animate",
        "render",
        "replay",
        "explain",
        "validate tracks",
    ],
)
def test_every_long_command_can_be_silent(words):
    command = typer.main.get_command(app)
    for word in [words] if words in command.commands else words.split():
        command = command.commands[word]
    assert "--no-progress" in [name for each in command.params for name in each.opts]


def test_verification_says_at_the_start_how_much_there_is(monkeypatch):
    from mesa_mobility.verification import cases

    monkeypatch.setattr(cases, "run_units", lambda todo, jobs, **_: ((*unit, {}) for unit in todo))
    told = []
    each = cases.case(time.sleep, effort=2.0)
    cases.run_cases([each], [1, 2], 1, lambda *report: told.append(report))
    assert told[0] == ("the first of 2 runs", 0.0, 4.0)
    assert told[-1][1:] == (4.0, 4.0)
