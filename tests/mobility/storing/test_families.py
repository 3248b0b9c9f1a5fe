"""Distributions of options: files of recorded options alone give the same map as all options do."""

import contextlib
import io
import math
import zipfile

import numpy as np
import pytest

from mesa_mobility.errors import MapError
from mesa_mobility.mobility import (
    MobilityMap,
    OptionFamilies,
    cluster_poses,
    map_of_families,
    motion_graph,
    reachable_options,
)
from mesa_mobility.mobility.edits import EDITS, STRIDES, TURNS_DEG
from tests.fixtures.maps import MAP_ARRAYS
from tests.fixtures.poses import random_poses

MOTION_STEP = 2e-5


@pytest.fixture(scope="module")
def built():
    poses = random_poses(np.random.default_rng(3), clips=4, length=60, wobble=0.05)
    # As poses of recordings are.
    poses.step[:] = np.rint(poses.step / MOTION_STEP) * MOTION_STEP
    graph = motion_graph(poses)
    clusters = cluster_poses(graph, 6)
    options = reachable_options(graph, clusters, EDITS)
    edits = {"turns_deg_in_45_frames": list(TURNS_DEG), "strides": list(STRIDES)}
    metadata = {"pedestrian_type": "test", "build": {"edits": edits}}
    return graph, options, OptionFamilies.of(poses.step, clusters, options, metadata)


def test_the_file_gives_the_whole_map(built, tmp_path):
    _, _, families = built
    whole = map_of_families(families)
    families.save(tmp_path / "a.npz")
    whole.save(tmp_path / "whole.npz")
    read = MobilityMap.load(tmp_path / "a.npz")
    stored = MobilityMap.load(tmp_path / "whole.npz")
    for name in MAP_ARRAYS:
        np.testing.assert_array_equal(getattr(read, name), getattr(whole, name), err_msg=name)
        np.testing.assert_array_equal(getattr(read, name), getattr(stored, name), err_msg=name)
    assert read.metadata == whole.metadata
    assert read.digest == stored.digest == whole.digest
    families.save(tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    size = (tmp_path / "a.npz").stat().st_size
    assert size <= (tmp_path / "whole.npz").stat().st_size / 5


def test_recorded_options_are_those_of_the_builder(built):
    """The same places from the way through the poses, followed by hand."""
    graph, options, families = built
    step, n = graph.poses.step, len(graph.poses)
    again = families.options()
    np.testing.assert_array_equal(again.edits, options.edits)
    rows = np.flatnonzero(options.edits == 0)[::29]
    jumped = 0
    for row in rows.tolist():
        jumps = {int(j) // n: int(j) % n for j in options.jumps[row] if j >= 0}
        jumped += len(jumps)
        x = y = heading = 0.0
        pose = int(options.sources[row])
        for frame in range(1, int(options.durations[row]) + 1):
            via = jumps.get(frame, pose)
            c, s = math.cos(heading), math.sin(heading)
            x, y = x + c * step[via, 0] - s * step[via, 1], y + s * step[via, 0] + c * step[via, 1]
            heading += step[via, 2]
            pose = via + 1
            if frame % 3 == 0:
                found = again.paths[row, frame // 3 - 1]
                np.testing.assert_allclose(found, [x, y, heading], atol=1e-5)
                np.testing.assert_array_equal(found, options.paths[row, frame // 3 - 1])
    assert jumped > len(rows) / 2


def changed(source, target, name, change):
    """A copy of a map file with one array changed."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for entry in old.infolist():
            data = old.read(entry)
            if entry.filename == f"{name}.npy":
                buffer = io.BytesIO()
                np.save(buffer, change(np.load(io.BytesIO(data))))
                data = buffer.getvalue()
            new.writestr(entry.filename, data)


@pytest.mark.parametrize(
    ("name", "change", "says"),
    [
        ("counts", lambda a: a * 2, "'counts': .* options, expected"),
        ("costs", lambda a: a[:-1], "'sources': shape"),
        ("sources", lambda a: a * 0 + 60_000, "'sources': expected poses of the option's cluster"),
        ("jump_poses", lambda a: a * 0 + 60_000, "expected clusters and poses that exist"),
        ("jump_poses", lambda a: a[1:], "'jump_poses': shape"),
        ("labels", lambda a: a * 0 + 100, "expected clusters and poses that exist"),
        ("steps", lambda a: a.astype(np.int32), "'steps': type int32, expected int16"),
        ("steps", lambda a: a[:2], "'steps': shape"),
        ("mean_speeds", lambda a: a[1:], "'mean_speeds': shape"),
        ("metadata", lambda a: a[1:], "not JSON"),
    ],
)
def test_what_does_not_fit_together_is_one_line(built, tmp_path, name, change, says):
    built[2].save(tmp_path / "sound.npz")
    changed(tmp_path / "sound.npz", tmp_path / "spoilt.npz", name, change)
    with pytest.raises(MapError, match=rf"spoilt\.npz: .*{says}") as error:
        MobilityMap.load(tmp_path / "spoilt.npz")
    assert len(str(error.value).splitlines()) == 1


@pytest.mark.thorough
def test_spoilt_numbers_are_an_error_or_a_sound_map(built, tmp_path):
    """A random number changed in each array: a map that can be used, or one line."""
    built[2].save(tmp_path / "sound.npz")
    rng = np.random.default_rng(5)

    def spoil(array):
        array = array.copy().reshape(-1)
        array[rng.integers(len(array))] = rng.integers(0, 250)
        return array

    with zipfile.ZipFile(tmp_path / "sound.npz") as archive:
        names = [entry.filename.removesuffix(".npy") for entry in archive.infolist()]
    for name in names * 3:
        changed(
            tmp_path / "sound.npz",
            tmp_path / "spoilt.npz",
            name,
            lambda array: spoil(array).reshape(array.shape),
        )
        with contextlib.suppress(MapError):
            assert MobilityMap.load(tmp_path / "spoilt.npz").n_options > 0
