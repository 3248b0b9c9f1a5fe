"""Arrays kept on disk are those that were computed, whatever becomes of their files."""

import json
import os
import signal
import subprocess
import sys
import zlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility.compiled import cache, kept_arrays
from mesa_mobility.errors import ContentError

RECORD = np.dtype([("a", "i8"), ("b", "f4", (3,)), ("c", "u2")], align=True)
DTYPES = {"floats": np.dtype("f4"), "records": RECORD, "none": np.dtype("i8")}


def made():
    records = np.zeros(5, RECORD)
    records["a"], records["b"][:, 1], records["c"] = np.arange(5), 0.5, 7
    floats = np.arange(30.0, dtype=np.float32).reshape(5, 2, 3)
    return {"floats": floats, "records": records, "none": np.empty((0, 4), dtype=np.int64)}


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    folder = tmp_path / "mesa-mobility-1-ab"
    folder.mkdir()
    monkeypatch.setattr(cache, "folder", lambda: folder)
    monkeypatch.setattr(kept_arrays, "LEAST", 0)
    cache.say_once.cache_clear()
    return folder / "arrays"


def get(key="key", dtypes=DTYPES, take=lambda arrays: arrays):
    """The arrays, and whether they were computed."""
    computed = []

    def make():
        computed.append(True)
        return made(), made()

    return kept_arrays.kept_arrays("things", key, dtypes, make, take), bool(computed)


def the_file(place):
    [path] = place.glob("*.npy")
    return path


def same(found):
    expected = made()
    assert list(found) == list(expected)
    for name, each in found.items():
        assert type(each) is np.ndarray
        assert (each.dtype, each.dtype.isalignedstruct) == (DTYPES[name], name == "records")
        assert each.shape == expected[name].shape
        assert each.tobytes() == expected[name].tobytes()
        assert each.flags.c_contiguous
        assert each.flags.writeable
    return True


def test_arrays_are_computed_once_and_are_the_same():
    assert [get()[1] for _ in range(3)] == [True, False, False]
    assert same(get()[0])


def test_mapped_arrays_begin_in_lines_of_the_cache():
    get()
    assert [each.ctypes.data % 64 for each in get()[0].values() if each.size] == [0, 0]


def test_the_file_is_an_npy_of_bytes_with_a_checksum(place):
    get()
    whole = np.load(the_file(place), allow_pickle=False)
    assert (whole.dtype, whole.ndim) == (np.dtype("u1"), 1)
    assert whole[:120].view("f4").tolist() == list(range(30))
    assert zlib.crc32(whole[:-4]) == int.from_bytes(whole[-4:].tobytes(), "little")


def test_what_one_writes_no_other_reads():
    get()
    first, second = get()[0], get()[0]
    first["floats"][:] = -1.0
    assert same(second)
    assert same(get()[0])


@pytest.mark.parametrize(
    "key",
    ["other", ("key",), ["key"], 1, 1.0, None],
)
def test_each_key_has_its_own_arrays(place, key):
    assert get()[1]
    assert get(key)[1]
    assert not get(key)[1]
    assert len(list(place.iterdir())) == 2


def test_other_types_have_another_file():
    assert get()[1]
    aligned_otherwise = np.dtype([("a", "i8"), ("b", "f4", (3,)), ("c", "i2")], align=True)
    # They are not those that are computed, and so are not kept.
    assert [get(dtypes={**DTYPES, "records": aligned_otherwise})[1] for _ in range(2)] == [True] * 2


def test_a_file_of_another_key_under_this_name_is_made_again(place):
    get()
    mine = the_file(place)
    foreign = mine.read_bytes()
    mine.unlink()
    get("other")
    the_file(place).rename(mine)
    assert mine.read_bytes() != foreign
    found, computed = get()
    assert computed
    assert same(found)
    assert mine.read_bytes() == foreign
    assert not get()[1]


@pytest.mark.parametrize("content", [b"", b"\x93NUMPY", b"no arrays at all", bytes(5000)], ids=len)
def test_what_is_no_such_file_is_made_again(place, content):
    get()
    the_file(place).write_bytes(content)
    found, computed = get()
    assert computed
    assert same(found)
    assert not get()[1]


def test_arrays_that_are_not_bytes_are_made_again(place):
    get()
    for array in (np.arange(40.0), np.zeros((8, 8), np.uint8), np.array([{}], dtype=object)):
        np.save(the_file(place), array, allow_pickle=True)
        assert get()[1]
        assert not get()[1]


def test_arrays_that_do_not_fit_are_made_again(place, caplog):
    def refusing(arrays):
        raise ContentError("no array of these")

    get()
    the_file(place).write_bytes(the_file(place).read_bytes())
    assert get(take=refusing)[1]
    assert [each.getMessage() for each in caplog.records] == [
        f"{the_file(place)}: damaged, and made again"
    ]
    assert not get()[1]


def rewritten(place, change):
    """Change the index of the file, and make its checksum fit."""
    path = the_file(place)
    memory = np.load(path).tobytes()
    end = len(memory) - 12
    begin = end - int.from_bytes(memory[end : end + 8], "little")
    index = json.loads(memory[begin:end])
    change(index)
    text = json.dumps(index).encode()
    content = memory[:begin] + text + len(text).to_bytes(8, "little")
    whole = content + zlib.crc32(content).to_bytes(4, "little")
    np.save(path, np.frombuffer(whole, np.uint8))


@pytest.mark.parametrize(
    "where",
    [
        None,
        [],
        [0],
        [0, 5],
        ["0", [5, 2, 3]],
        [0, [5, 2, -3]],
        [0, [-5, 2, -3]],
        [-128, [5, 2, 3]],
        [4, [5, 2, 3]],
        [0, [5, 2, 3.0]],
        [0, [10**9, 2, 3]],
        [0, [2**62, 4]],
        [1 << 62, [5, 2, 3]],
    ],
)
def test_arrays_that_lie_elsewhere_are_made_again(place, where):
    get()
    rewritten(place, lambda index: index["arrays"].update(floats=where))
    assert get()[1]
    assert not get()[1]
    rewritten(place, lambda index: index["arrays"].pop("floats"))
    assert get()[1]


def test_what_is_mapped_stays_when_the_file_is_replaced_or_deleted(place):
    get()
    before = get()[0]
    foreign = {**made(), "floats": np.full((5, 2, 3), -1.0, np.float32)}
    kept_arrays._write(the_file(place), "another key", foreign)
    the_file(place).unlink()
    assert same(before)


@given(at=st.floats(0.0, 1.0, exclude_max=True), bit=st.integers(0, 7), cut=st.booleans())
@settings(max_examples=60, deadline=None)
def test_whatever_is_flipped_or_cut(tmp_path_factory, at, bit, cut):
    folder = tmp_path_factory.mktemp("kept") / "mesa-mobility-1-ab"
    folder.mkdir()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cache, "folder", lambda: folder)
        get()
        path = the_file(folder / "arrays")
        content = bytearray(path.read_bytes())
        where = int(at * len(content))
        if cut:
            del content[where:]
        else:
            content[where] ^= 1 << bit
        path.write_bytes(content)
        assert same(get()[0])
        # A header may say the same in other words; all else is made again.
        assert not get()[1]


def test_a_folder_that_cannot_be_written_serves_what_it_has(place):
    get()
    # Root may write everywhere, so the place of new files is taken by a file.
    kept = the_file(place).read_bytes(), the_file(place).name
    assert not get()[1]
    the_file(place).unlink()
    place.rmdir()
    place.write_text("not a folder")
    assert [get()[1] for _ in range(2)] == [True, True]
    place.unlink()
    place.mkdir()
    (place / kept[1]).write_bytes(kept[0])
    place.chmod(0o500)
    try:
        assert not get()[1]
        assert same(get()[0])
    finally:
        place.chmod(0o700)


def test_a_full_disk_leaves_nothing_behind(place, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np.lib.format, "write_array_header_1_0", full)
    assert [get()[1] for _ in range(2)] == [True, True]
    assert same(get()[0])
    assert list(place.iterdir()) == []


def test_without_a_folder_arrays_are_computed_each_time(monkeypatch):
    monkeypatch.setattr(cache, "folder", lambda: None)
    assert [get()[1] for _ in range(2)] == [True, True]


def test_few_bytes_are_not_worth_a_file(place, monkeypatch):
    monkeypatch.setattr(kept_arrays, "LEAST", 1_000)
    assert [get()[1] for _ in range(2)] == [True, True]
    assert not place.exists()


def test_the_least_recently_used_files_of_all_versions_go(place, monkeypatch):
    get("first")
    size = the_file(place).stat().st_size
    monkeypatch.setattr(kept_arrays, "MOST", 3 * size + size // 2)
    older = place.parents[1] / "mesa-mobility-0-cd" / "arrays" / "map-x.npy"
    older.parent.mkdir(parents=True)
    older.write_bytes(bytes(size))
    os.utime(older, (1, 1))
    for key in ("second", "third"):
        get(key)
    assert not older.exists()
    for age, path in enumerate(sorted(place.glob("*.npy"), key=lambda each: each.stat().st_mtime)):
        os.utime(path, (10 + age, 10 + age))
    assert not get("first")[1]  # used again
    get("fourth")
    assert [get(key)[1] for key in ("first", "third", "fourth")] == [False] * 3
    assert get("second")[1]


_PROCESS = """
import sys
from pathlib import Path
sys.path.insert(0, {root!r})
from mesa_mobility.compiled import cache, kept_arrays
from tests.compiled.test_kept_arrays import DTYPES, made, same
cache.folder = lambda: Path({folder!r})
kept_arrays.LEAST = 0
for k in range(20):
    same(kept_arrays.kept_arrays("things", k % 2, DTYPES, lambda: (made(), made()), dict))
"""


@pytest.mark.thorough
def test_processes_that_write_at_the_same_time_read_whole_files(place):
    root = os.path.dirname(os.path.dirname(os.path.dirname(__file__)))
    command = _PROCESS.format(root=root, folder=str(place.parent))
    started = [subprocess.Popen([sys.executable, "-c", command]) for _ in range(2)]
    assert [each.wait() for each in started] == [0, 0]
    assert len(list(place.iterdir())) == 2


_KILLED = (
    _PROCESS.rpartition("for k")[0]
    + """
import os, signal
class zlib:  # of which the first part that has been written is summed
    def crc32(*_):
        os.kill(os.getpid(), signal.SIGKILL)
kept_arrays.zlib = zlib
kept_arrays.kept_arrays("things", "key", DTYPES, lambda: (made(), made()), dict)
"""
)


@pytest.mark.thorough
def test_a_process_that_is_killed_while_it_writes_leaves_no_file_that_is_read(place, monkeypatch):
    root = os.path.dirname(os.path.dirname(os.path.dirname(__file__)))
    command = _KILLED.format(root=root, folder=str(place.parent))
    killed = subprocess.run([sys.executable, "-c", command], check=False)
    assert killed.returncode == -signal.SIGKILL
    [left] = place.iterdir()
    found, computed = get()
    assert computed
    assert same(found)
    assert not get()[1]
    # What it has left goes with the files that have not been used for the longest time.
    os.utime(left, (1, 1))
    monkeypatch.setattr(
        kept_arrays, "MOST", 2 * max(each.stat().st_size for each in place.iterdir())
    )
    monkeypatch.setattr(kept_arrays, "_fit", lambda *_: True)
    for key in ("2nd", "3rd"):
        get(key)
    assert not left.exists()
