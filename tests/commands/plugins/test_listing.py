import os
import subprocess
import sys

import pytest


@pytest.mark.usefixtures("plugins")
def test_models_lists_plug_ins_beside_the_shipped_ones(command):
    outcome = command("models")
    assert outcome.status == 0
    (line,) = (line for line in outcome.out.splitlines() if line.startswith("corridor "))
    assert "People in lanes." in line
    assert "corridors 1.2" in line


@pytest.mark.usefixtures("plugins")
def test_broken_plug_ins_are_named_and_break_nothing(command):
    outcome = command("models")
    broken = [line for line in outcome.err.splitlines() if line.startswith("broken: ")]
    for name in ("absent", "nameless", "number"):
        assert any(line.startswith(f"broken: model {name} ") for line in broken)
    assert "corridor" in outcome.out


@pytest.mark.usefixtures("plugins")
def test_behaviors_are_listed_likewise(command):
    outcome = command("behaviors")
    assert outcome.status == 0
    assert "broken: behavior broken_term (no_such_module:Term, from corridors 1.2)" in outcome.err


def test_settings_of_a_behaviour_are_listed(command):
    outcome = command("behaviors", "headway")
    assert outcome.status == 0
    lines = outcome.out.splitlines()
    assert lines[0] == "Keeps a distance from people ahead that grows with speed."
    assert [line.split()[:2] for line in lines[2:4]] == [["weight", "1.5"], ["distance", "0.36"]]
    (time,) = (line for line in lines if line.startswith("time "))
    assert time.split() == ["time", "1.2", "more", "than", "0", "s", "T,", "seconds."]
    assert command("behaviors", "headwy").status == 2


def test_help_imports_nothing_slow():
    script = (
        "import sys; sys.argv = ['mesa-mobility', 'run', '--help']\n"
        "from mesa_mobility.cli import main\n"
        "try:\n    main()\n"
        "except SystemExit: pass\n"
        "slow = {'mesa', 'numba', 'scipy', 'matplotlib', 'pyarrow', 'pandas', 'numpy', 'shapely',\n"
        "        'fsspec', 'filelock', 'distributed', 'dask', 'SALib'}\n"
        "print(sorted(slow & set(sys.modules)))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        text=True,
        timeout=60,
        env=os.environ | {"COLUMNS": "100"},
    )
    assert done.stdout.splitlines()[-1] == "[]"
    assert "--set" in done.stdout


def test_without_arguments_it_shows_what_there_is(command):
    outcome = command()
    text = outcome.out + outcome.err
    for name in ("run", "map", "models", "behaviors"):
        assert name in text
