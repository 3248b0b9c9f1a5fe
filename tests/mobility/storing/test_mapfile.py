"""The map file: round trips, identical bytes, and every way it can be broken."""

import contextlib
import dataclasses
import io
import json
import tracemalloc
import zipfile

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mesa_mobility.errors import MapError
from mesa_mobility.mobility import MobilityMap
from tests.fixtures.maps import MAP_ARRAYS


@st.composite
def maps(draw):
    """Maps of any size with paths on the grid of the file."""
    seed = draw(st.integers(0, 2**32 - 1))
    rng = np.random.default_rng(seed)
    k = draw(st.integers(1, 6))
    counts = rng.integers(1, 6, k)
    m = int(counts.sum())
    durations = rng.choice([3, 12, 24, 45], m).astype(np.int16)
    samples = durations.astype(int) // 3
    p = int(samples.sum())
    whole = np.cumsum(rng.integers(-1500, 1500, (p, 3)), axis=0)
    whole -= np.repeat(whole[np.cumsum(samples) - samples], samples, axis=0)
    return MobilityMap(
        offsets=np.concatenate([[0], np.cumsum(counts)]),
        durations=durations,
        costs=(rng.integers(0, 60_000, m) * 1e-4).astype(np.float32),
        path_offsets=np.concatenate([[0], np.cumsum(samples)]),
        paths=(whole * np.array([0.0005, 0.0005, 0.0002])).astype(np.float32),
        path_clusters=rng.integers(0, k, p).astype(np.uint16),
        mean_poses=rng.normal(size=(k, 9, 3)).astype(np.float32),
        centres=rng.normal(size=(k, 36)).astype(np.float32),
        sizes=rng.integers(1, 100, k),
        mean_speeds=rng.uniform(0, 2, k).astype(np.float32),
        metadata={"pedestrian_type": draw(st.text(min_size=1)), "n": draw(st.integers())},
    )


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(map_=maps())
def test_a_saved_map_reads_back_unchanged(map_, tmp_path_factory):
    folder = tmp_path_factory.mktemp("map")
    map_.save(folder / "a.npz")
    back = MobilityMap.load(folder / "a.npz")
    for name in MAP_ARRAYS:
        np.testing.assert_array_equal(getattr(back, name), getattr(map_, name), err_msg=name)
    assert back.metadata == map_.metadata
    back.save(folder / "b.npz")
    assert (folder / "a.npz").read_bytes() == (folder / "b.npz").read_bytes()
    assert sorted(p.name for p in folder.iterdir()) == ["a.npz", "b.npz"]


def test_end_points_and_options(small_map):
    np.testing.assert_allclose(small_map.end_points, [[0, 0], [0.4, 0], [1.2, 0.08]], atol=1e-6)
    np.testing.assert_allclose(small_map.end_headings, [0, 0, 0.16], atol=1e-6)
    np.testing.assert_array_equal(small_map.end_clusters, [0, 1, 0])
    assert small_map.options_of(0) == range(2)
    assert small_map.options_of(1) == range(2, 3)
    info = small_map.info()
    assert info["options_by_frames"] == {"12": 2, "24": 1}
    assert info["pedestrian_type"] == "test"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"offsets": np.array([0, 3, 3])}, "'offsets': expected to rise strictly from 0 to 3"),
        ({"offsets": np.array([0, 2, 4])}, "'offsets': expected to rise strictly"),
        ({"offsets": np.array([0, 3])}, r"'offsets': shape \(2,\), expected \(3,\)"),
        ({"costs": np.array([0, np.nan, 1], dtype=np.float32)}, "'costs': not finite"),
        ({"durations": np.array([12, 12, 12], dtype=np.int16)}, "option 2: 8 samples for 12"),
        ({"path_clusters": np.full(16, 2, dtype=np.uint16)}, "'path_clusters': 2, expected less"),
        ({"sizes": np.array([0, 4])}, "cluster 0: no poses"),
        ({"metadata": {}}, "no 'pedestrian_type'"),
        ({"paths": np.full((16, 3), np.inf, dtype=np.float32)}, "'paths': not finite"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(small_map, changes, message):
    with pytest.raises(MapError, match=message):
        dataclasses.replace(small_map, **changes)


@pytest.fixture
def saved(small_map, tmp_path):
    path = tmp_path / "map.npz"
    small_map.save(path)
    return path


def rewrite(path, name, array):
    with np.load(path) as archive:
        arrays = {key: archive[key] for key in archive.files}
    arrays[name] = array
    np.savez(path, **arrays)


def metadata_bytes(**values):
    return np.frombuffer(json.dumps(values).encode(), dtype=np.uint8)


@pytest.mark.parametrize(
    ("name", "array", "message"),
    [
        ("end_points", np.array([[0, 0], [800, 0], [2400, 161]], np.int16), "option 2: its path"),
        ("end_headings", np.array([1, 0, 800], np.int16), "option 0: its path ends elsewhere"),
        ("end_clusters", np.array([0, 0, 0], np.uint16), "option 1: its path ends in another"),
        ("path_steps", np.zeros((3, 15), np.int16), "'path_steps': shape"),
        ("costs", np.zeros(3), "'costs': type float64, expected uint16"),
        ("metadata", metadata_bytes(format_version=99), "format version 99, expected 1"),
        ("metadata", np.frombuffer(b"{", np.uint8), "'metadata': not JSON"),
        ("metadata", np.frombuffer(b"[]", np.uint8), "format version None"),
        ("durations", np.array([0, 12, 24], np.int16), "shape|at least one option"),
        ("offsets", np.array([0, -2, 3]), "rise strictly"),
    ],
)
def test_a_file_that_contradicts_itself_is_refused(saved, name, array, message):
    rewrite(saved, name, array)
    with pytest.raises(MapError, match=message) as caught:
        MobilityMap.load(saved)
    assert str(caught.value).startswith(str(saved))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("block", [1, 2, 1024])
@pytest.mark.parametrize("sample", [0, 4, 9])
def test_a_file_with_an_option_that_outruns_everybody_is_refused(saved, sample, block, monkeypatch):
    """Out by 1.3 m in 0.1 s and back, at the start of an option or later on its path."""
    monkeypatch.setattr("mesa_mobility.mobility.map_data._BLOCK", block)
    with np.load(saved) as archive:
        steps = archive["path_steps"].copy()
    row = 0 if sample < 4 else 1 if sample < 8 else 2
    steps[1, sample] += 2600
    steps[1, sample + 1] -= 2600
    rewrite(saved, "path_steps", steps)
    with pytest.raises(MapError, match=rf"map.npz: .*option {row}: moves at 1\d.\d m/s") as refused:
        MobilityMap.load(saved)
    assert "\n" not in str(refused.value)


def test_an_option_may_be_as_fast_as_the_fastest_sprint(small_map):
    paths = np.array(small_map.paths)
    paths[:4] = [[1.234 * k, 0.0, 0.0] for k in (1, 2, 1, 0)]
    dataclasses.replace(small_map, paths=paths)
    paths[0, 0] += 0.002
    with pytest.raises(MapError, match=r"option 0: moves at 12\.4 m/s, expected at most 12\.34"):
        dataclasses.replace(small_map, paths=paths)


def test_object_arrays_are_refused(saved):
    rewrite(saved, "costs", np.array([{}, None, 1], dtype=object))
    with pytest.raises(MapError, match=r"array 'costs': its header says object in shape \(3,\)"):
        MobilityMap.load(saved)


def replace_entry(path, name, content, method=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path) as archive:
        entries = {each: archive.read(each) for each in archive.namelist()}
    entries[f"{name}.npy"] = content
    with zipfile.ZipFile(path, "w", method) as archive:
        for each, data in entries.items():
            archive.writestr(each, data)


def npy_header(shape, dtype="<i2"):
    buffer = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        buffer, {"descr": dtype, "fortran_order": False, "shape": shape}
    )
    return buffer.getvalue()


@pytest.mark.parametrize(
    "shape", [(2**33,), (3, 2**40), (2**62, 2**62), (-1, -16), (16,), (0,), (1000, 0)]
)
def test_a_header_that_says_more_than_there_is_is_refused(saved, shape):
    replace_entry(saved, "path_steps", npy_header(shape) + bytes(36))
    with pytest.raises(MapError, match=r"'path_steps': .*, but 36 bytes follow|not a readable"):
        MobilityMap.load(saved)


def test_a_small_file_with_large_arrays_is_refused_before_they_are_read(saved, monkeypatch):
    replace_entry(saved, "path_steps", npy_header((3, 20_000_000)) + bytes(120_000_000))
    assert saved.stat().st_size < 1_000_000
    monkeypatch.setattr(zipfile.ZipFile, "open", None)
    with pytest.raises(MapError, match="arrays of 120 MB, expected at most 100 MB"):
        MobilityMap.load(saved)


def test_a_directory_that_says_less_than_there_is_does_not_unpack_more(saved):
    replace_entry(saved, "costs", npy_header((3,)) + bytes(50_000_000))
    content = bytearray(saved.read_bytes())
    size = len(npy_header((3,)) + bytes(50_000_000)).to_bytes(4, "little")
    at = content.rindex(size)
    content[at : at + 4] = (134).to_bytes(4, "little")
    saved.write_bytes(content)
    tracemalloc.start()
    with pytest.raises(MapError):
        MobilityMap.load(saved)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 5_000_000


@pytest.mark.parametrize("method", [zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])
def test_other_compressions_are_refused(saved, method):
    replace_entry(saved, "costs", b"", method)
    with pytest.raises(MapError, match=r"compressed by method 1[24], expected deflate"):
        MobilityMap.load(saved)


@pytest.mark.parametrize("content", [b"", b"not a map", b"\x00\xff" * 500, b"PK\x03\x04rest"])
def test_other_files_are_refused(tmp_path, content):
    path = tmp_path / "x.npz"
    path.write_bytes(content)
    with pytest.raises(MapError, match=r"x\.npz"):
        MobilityMap.load(path)


def test_missing_files_folders_and_single_arrays_are_refused(tmp_path):
    with pytest.raises(MapError, match="no such file"):
        MobilityMap.load(tmp_path / "none.npz")
    with pytest.raises(MapError, match="cannot be read"):
        MobilityMap.load(tmp_path)
    np.save(tmp_path / "one.npy", np.zeros(3))
    with pytest.raises(MapError, match="a single array"):
        MobilityMap.load(tmp_path / "one.npy")
    with zipfile.ZipFile(tmp_path / "zip.npz", "w") as archive:
        archive.writestr("readme.txt", "hello")
    with pytest.raises(MapError, match="arrays missing"):
        MobilityMap.load(tmp_path / "zip.npz")


@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(data=st.data())
def test_a_truncated_or_damaged_file_never_fails_otherwise(saved, data):
    content = bytearray(saved.read_bytes())
    if data.draw(st.booleans()):
        content = content[: data.draw(st.integers(0, len(content) - 1))]
    else:
        for _ in range(data.draw(st.integers(1, 4))):
            content[data.draw(st.integers(0, len(content) - 1))] ^= data.draw(st.integers(1, 255))
    damaged = saved.with_name("damaged.npz")
    damaged.write_bytes(content)
    # Damage that decompresses to the same arrays is none; anything else is one MapError.
    with contextlib.suppress(MapError):
        MobilityMap.load(damaged)


def test_a_map_that_cannot_be_written_leaves_nothing(small_map, tmp_path):
    with pytest.raises(MapError, match="cannot be written"):
        small_map.save(tmp_path / "missing" / "map.npz")
    paths = np.zeros((16, 3), dtype=np.float32)
    paths[:14, 0] = 1.2 * np.arange(1, 15)
    far = dataclasses.replace(
        small_map,
        paths=paths,
        path_offsets=np.array([0, 14, 15, 16]),
        durations=np.array([42, 3, 3], dtype=np.int16),
    )
    turning = dataclasses.replace(small_map, paths=small_map.paths + np.float32([0, 0, 7]))
    with pytest.raises(MapError, match=r"an option turns by more than 6\.5 rad"):
        turning.save(tmp_path / "turning.npz")
    with pytest.raises(MapError, match="further than 16 m"):
        far.save(tmp_path / "far.npz")
    assert list(tmp_path.iterdir()) == []
