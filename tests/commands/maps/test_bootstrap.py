"""`mesa-mobility map bootstrap`."""

import json

import numpy as np
import pytest

from mesa_mobility.capture import find_clips
from mesa_mobility.errors import MapError
from mesa_mobility.mobility import MobilityMap, draw_clips, prepare_recordings


@pytest.fixture(scope="module")
def prepared(recordings):
    return prepare_recordings(find_clips(recordings), "able_bodied").recordings


def test_clips_are_drawn_as_numpy_draws_with_their_mirror_images(prepared):
    names = [recording.name for recording in prepared]
    assert names == ["brisk", "brisk~mirror", "slow", "slow~mirror"]
    for number in range(1, 20):
        drawn, said = draw_clips(prepared, 5, number)
        taken = np.random.default_rng([5, number]).integers(2, size=2)
        times = [int((taken == k).sum()) for k in range(2)]
        expected = [n for k in range(2) for n in names[2 * k : 2 * k + 2] * times[k]]
        assert [recording.name for recording in drawn] == expected
        assert said["clips"] == sum(n > 0 for n in times)
        assert sum(said["drawn"].values()) == 2


def test_draws_differ_and_leave_clips_out(prepared):
    """Of two clips each is missing from a quarter of the draws."""
    missing = sum("brisk.bvh" not in draw_clips(prepared, 1, k)[1]["drawn"] for k in range(400))
    assert 70 < missing < 130


def test_one_clip_is_too_few(prepared):
    with pytest.raises(MapError, match="1 clip: expected two or more to draw from"):
        draw_clips(prepared[:2], 1, 1)


@pytest.mark.slow
def test_maps_are_built_once_and_are_those_of_the_builder(command, recordings, tmp_path):
    out = tmp_path / "maps"
    arguments = ["map", "bootstrap", recordings, "--out", out, "--clusters", 12, "--json"]
    done = command(*arguments, "--maps", 2)
    assert done.status == 0, done.err
    rows = json.loads(done.out.splitlines()[-1])["maps"]
    files = [out / "able_bodied-1.npz", out / "able_bodied-2.npz"]
    assert [row["file"] for row in rows] == [str(file) for file in files]
    first = MobilityMap.load(files[0])
    assert first.metadata["bootstrap"]["number"] == 1
    assert sum(first.metadata["bootstrap"]["drawn"].values()) == 2
    content = [file.read_bytes() for file in files]
    files[1].unlink()
    more = command(*arguments, "--maps", 3)
    said = [row["said"] for row in json.loads(more.out.splitlines()[-1])["maps"]]
    assert said[0] == "there already"
    # The same bytes again, whatever the number of maps.
    assert [file.read_bytes() for file in files] == content
    other = command(*arguments, "--maps", 2, "--seed", 2)
    assert other.status == 2
    assert "able_bodied-1.npz: is another map, expected nothing there" in other.err
