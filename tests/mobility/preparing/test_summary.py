"""What was read is said, with heights that show a wrong unit."""

from dataclasses import replace

import numpy as np
import pytest

from mesa_mobility.capture import find_clips, load_clips
from mesa_mobility.capture.recording import Recording
from mesa_mobility.capture.skeleton import Skeleton
from mesa_mobility.mobility.preparing.summary import summary_of
from tests.fixtures.walker import walker_bvh


def pole(height, name="a"):
    """A standing pole with a foot on the floor, three frames."""
    skeleton = Skeleton(("root", "top", "foot"), (-1, 0, 0), [(0, 0, 0), (0, 0, 1), (0, 0, -1)])
    skeleton = replace(skeleton, offsets=skeleton.offsets * height / 2)
    rotations = np.tile([0.0, 0.0, 0.0, 1.0], (3, 3, 1))
    return Recording(name, skeleton, 30.0, np.tile([0.0, 0.0, height / 2], (3, 1)), rotations)


@pytest.mark.parametrize(("height", "warned"), [(0.8, 1), (0.95, 0), (1.8, 0), (2.2, 0), (2.5, 1)])
def test_heights_that_nobody_has_are_warned_of(height, warned):
    summary = summary_of([pole(height)])
    assert summary.heights == {"person 1": pytest.approx(height)}
    assert len(summary.warnings) == warned
    if warned:
        assert f"comes out {height:.2f} m tall, expected 0.9 to 2.3 m" in summary.warnings[0]


def test_people_are_told_apart_by_their_skeletons():
    summary = summary_of([pole(1.5), pole(1.8, "b"), pole(1.5, "c")])
    assert (
        summary.lines[0]
        == "3 clips of 2 people, 1.50 to 1.80 m tall from the lowest joint to the highest"
    )


def test_guessed_units_are_named(tmp_path):
    (tmp_path / "walk.bvh").write_text(walker_bvh(60, 1.0))
    summary = summary_of(load_clips(find_clips(tmp_path), mirrored=False).recordings)
    assert summary.lines[1:] == ["unit of length: 1 m (metre), guessed", "frames a second: 30"]


@pytest.mark.captures
def test_units_of_a_manifest_are_named(captures_dir):
    clips = load_clips(find_clips(captures_dir), pedestrian_type="carrying", mirrored=False)
    summary = summary_of(clips.recordings)
    assert summary.units == {"0.01 m (centimetre), as the manifest says": 6}
    # One man of 1.8 m, by the sources of the recordings.
    assert list(summary.heights.values()) == [pytest.approx(1.8, abs=0.1)]
