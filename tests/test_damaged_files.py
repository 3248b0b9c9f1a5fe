"""Damaged files of every format: refused in one line, or read as what was written.

``python -m tests.fixtures.damage.mutating FOLDER FIRST_SEED COUNT`` goes through as many as
one likes.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FORMATS = {"bvh", "asf", "amc", "manifest", "map", "geojson", "wkt", "parquet"}


def outcomes(folder, first, count):
    """Read mutants of each format in a separate process, which reports its memory."""
    command = [
        sys.executable,
        "-m",
        "tests.fixtures.damage.mutating",
        str(folder),
        str(first),
        str(count),
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(lines) == count * len(FORMATS)
    assert {line["format"] for line in lines} == FORMATS
    return lines


def check(outcome):
    assert outcome["traceback"] == "", outcome
    assert outcome["nonsense"] == "", outcome
    assert "\n" not in outcome["error"], outcome
    assert len(outcome["error"]) < 1000, outcome
    # No more than 10 s of processor time and 1 GB each, whatever has been damaged.
    assert outcome["seconds"] < 10, outcome
    assert outcome["megabytes"] < 1000, outcome
    if outcome["format"] == "parquet":
        assert outcome["error"] or outcome["same"], outcome


def test_damaged_files(tmp_path):
    for outcome in outcomes(tmp_path, 0, 12):
        check(outcome)


@pytest.mark.slow
def test_hundreds_of_damaged_files(tmp_path):
    refused = 0
    for outcome in outcomes(tmp_path, 1000, 300):
        check(outcome)
        refused += outcome["error"] != ""
    assert refused > 1000
