"""The same seed gives the same bytes: again, in another process, whatever the steps."""

import hashlib
import os
import subprocess
import sys
from functools import cache

import pytest
from mesa_mobility.models import Doorway

from mesa_mobility.mobility.mapfile import shipped_map_path
from tests.fixtures.maps import shipped_map

SECONDS = 12.0


def digest(model) -> str:
    rows = model.recorder.arrays()
    sha = hashlib.sha256()
    for name in ("frame", "person", "x", "y", "heading"):
        sha.update(rows[name].tobytes())
    assert len(rows["x"]) > 5000
    return sha.hexdigest()


def run(rng, frames_per_step=3, preset="default") -> str:
    model = Doorway(
        pedestrians=30,
        mobility_map=shipped_map(),
        preset=preset,
        record=True,
        frames_per_step=frames_per_step,
        rng=rng,
    )
    model.run(max_seconds=SECONDS)
    return digest(model)


@cache
def recorded_run(preset: str = "default") -> Doorway:
    """The run that others are compared with."""
    model = Doorway(pedestrians=30, mobility_map=shipped_map(), preset=preset, record=True, rng=11)
    model.run(max_seconds=SECONDS)
    return model


@pytest.mark.parametrize("preset", ["default", "paper"])
def test_again(preset):
    assert run(11, preset=preset) == digest(recorded_run(preset))


def test_another_seed_is_another_run():
    assert run(12) != digest(recorded_run())


@pytest.mark.parametrize("frames_per_step", [1, 4, 30])
def test_with_other_steps(frames_per_step):
    # 12 s are a whole number of each of these steps.
    assert run(11, frames_per_step) == digest(recorded_run())


SCRIPT = """
import hashlib
from mesa_mobility.models import Doorway
model = Doorway(pedestrians=30, record=True, rng=11)
model.run(max_seconds=12.0)
rows = model.recorder.arrays()
sha = hashlib.sha256()
for name in ("frame", "person", "x", "y", "heading"):
    sha.update(rows[name].tobytes())
print(sha.hexdigest())
"""


def test_in_another_process():
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        env={**os.environ, "PYTHONHASHSEED": "77"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == digest(recorded_run())


@pytest.mark.parametrize("preset", ["default", "paper"])
@pytest.mark.parametrize("frames_per_step", [1, 3, 30])
def test_recording_and_steps_change_nothing(frames_per_step, preset):
    # Frames that are not recorded need not be computed one by one.
    recorded = recorded_run(preset)
    model = Doorway(
        pedestrians=30,
        mobility_map=shipped_map(),
        preset=preset,
        frames_per_step=frames_per_step,
        rng=11,
    )
    model.run(max_seconds=SECONDS)
    assert model.recorder is None
    for name in ("x", "y", "heading", "active_frames", "fallback_frames", "decisions"):
        assert recorded.crowd.records[name].tobytes() == model.crowd.records[name].tobytes()
    assert recorded.statistics.last_left == model.statistics.last_left
    assert recorded.summary() == model.summary()


def test_with_the_file_of_the_map_or_the_map_itself():
    file = shipped_map_path("able_bodied")
    model = Doorway(pedestrians=30, mobility_map=str(file), record=True, rng=11)
    model.run(max_seconds=SECONDS)
    assert digest(model) == digest(recorded_run())
