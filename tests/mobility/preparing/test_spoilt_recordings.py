"""Maps of recordings with a few spoilt frames: refused or split, said, small and human.

``python -m tests.fixtures.damage.spoiling FOLDER FIRST_SEED COUNT`` goes through as many as
one likes.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
MEGABYTES = 1500
METRES_PER_SECOND = 4.0


def outcomes(folder, first, count):
    """Read ``count`` recordings in a separate process, which reports its memory."""
    command = [
        sys.executable,
        "-m",
        "tests.fixtures.damage.spoiling",
        str(folder),
        str(first),
        str(count),
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(lines) == count
    return lines


def check(outcome):
    (name, reason), *_ = outcome["said"]
    assert name == "spoilt", outcome
    frame = int(reason.split("jumps at frame ")[1].split()[0])
    # The frame before or behind a spoilt one is where the jump happens.
    assert min(abs(frame - spoilt) for spoilt in outcome["frames"]) <= 1, outcome
    assert "\n" not in outcome["error"], outcome
    assert outcome["error"] or outcome["speed"] <= METRES_PER_SECOND, outcome
    assert outcome["megabytes"] <= MEGABYTES, outcome


@pytest.mark.thorough
def test_spoilt_recordings(tmp_path):
    for outcome in outcomes(tmp_path / "made" / "for it", 0, 6):
        check(outcome)


@pytest.mark.slow
def test_500_spoilt_recordings(tmp_path):
    built = 0
    for outcome in outcomes(tmp_path, 1000, 500):
        check(outcome)
        built += not outcome["error"]
    assert built > 400
