"""Compiled code on disk is never in the way: whatever becomes of its files, code runs."""

import importlib.util
import logging
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numba
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility.compiled import cache as kernel_cache
from tests.fixtures.interrupting import wait_for_group

SOURCE = """
from mesa_mobility.compiled.decorators import kept

@kept()
def twice(number):
    return 2 * number
"""


@pytest.fixture(scope="module")
def module(tmp_path_factory):
    path = tmp_path_factory.mktemp("module") / "doubling.py"
    path.write_text(SOURCE)
    return path


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.setattr(kernel_cache, "folder", lambda: tmp_path / "kept")
    kernel_cache.say_once.cache_clear()
    return tmp_path / "kept"


def twice(module):
    """The function as another process would import it."""
    spec = importlib.util.spec_from_file_location("doubling", module)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded.twice


def hits(function):
    return sum(function.stats.cache_hits.values())


def files(place):
    return sorted(path for path in place.rglob("*") if path.is_file())


def test_what_was_compiled_is_not_compiled_again(module, place):
    first, second = twice(module), twice(module)
    assert (first(4), first(0.5), hits(first)) == (8, 1.0, 0)
    assert (second(4), second(0.5), hits(second)) == (8, 1.0, 2)
    assert [path.suffix for path in files(place)].count(".nbc") == 2


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("damage", ["empty", "half", "zeros", "text"])
def test_damaged_files_are_made_anew_and_said_once(module, place, caplog, suffix, damage):
    assert twice(module)(4) == 8
    (path,) = [path for path in files(place) if path.suffix == suffix]
    whole = path.read_bytes()
    path.write_bytes(
        {
            "empty": b"",
            "half": whole[: len(whole) // 2],
            "zeros": bytes(len(whole)),
            "text": b"no code at all",
        }[damage]
    )
    with caplog.at_level(logging.WARNING):
        for _ in range(2):
            assert twice(module)(4) == 8
    assert [record.message for record in caplog.records] == [
        f"{place}: compiled code there is damaged, and compiled again"
    ]
    last = twice(module)
    assert (last(4), hits(last)) == (8, 1)


@settings(max_examples=15, deadline=None)
@given(data=st.data())
def test_whatever_is_flipped_or_cut(module, data):
    with tempfile.TemporaryDirectory() as name, pytest.MonkeyPatch.context() as patch:
        place = Path(name)
        patch.setattr(kernel_cache, "folder", lambda: place)
        assert twice(module)(4) == 8
        index, code = sorted(files(place), key=lambda path: path.suffix, reverse=True)
        path = index if data.draw(st.booleans()) else code
        content = bytearray(path.read_bytes())
        at = int(data.draw(st.floats(0, 1, exclude_max=True)) * len(content))
        if data.draw(st.booleans()):
            content[at] ^= 1 << data.draw(st.integers(0, 7))
        else:
            del content[at:]
        path.write_bytes(content)
        assert twice(module)(4) == 8
        assert twice(module)(4) == 8


def test_a_disk_without_room_is_said_once(module, place, caplog, monkeypatch):
    def full(self, path):
        raise OSError(28, "No space left on device", path)

    monkeypatch.setattr(kernel_cache.IndexDataCacheFile, "_open_for_write", full)
    with caplog.at_level(logging.WARNING):
        function = twice(module)
        assert (function(4), function(0.5)) == (8, 1.0)
    assert [record.message for record in caplog.records] == [
        f"{place}: compiled code cannot be kept there: No space left on device; "
        "what is missing is compiled at each start"
    ]


@pytest.fixture
def places(tmp_path, monkeypatch):
    """Stands for the package, home and the folder of temporary files."""
    for name in ("package", "home", "tmp"):
        (tmp_path / name).mkdir()
    (tmp_path / "package" / "module.py").write_text("1")
    monkeypatch.setattr(kernel_cache, "PACKAGE", tmp_path / "package")
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    monkeypatch.setattr(kernel_cache.tempfile, "gettempdir", lambda: str(tmp_path / "tmp"))
    kernel_cache.say_once.cache_clear()
    return tmp_path


def folder():
    return kernel_cache.folder.__wrapped__()


def block(path):
    """A file instead of a folder, where not even the superuser can write."""
    if path.is_dir():
        path.rmdir()
    path.write_text("")


def test_the_first_place_that_can_be_written_is_taken(places, caplog):
    name = f"mesa-mobility-{kernel_cache._version()}"
    assert folder() == places / "package" / "__pycache__" / name
    (places / "package" / "__pycache__" / name).rmdir()
    block(places / "package" / "__pycache__")
    assert folder() == places / "home" / "mesa-mobility" / name
    assert caplog.records == []
    block_home(places)
    temporary = folder()
    assert temporary == places / "tmp" / f"mesa-mobility-{os.getuid()}" / name
    assert (temporary.parent.stat().st_mode & 0o777) == 0o700
    assert folder() == temporary
    assert [record.message for record in caplog.records] == [
        f"compiled code is kept in {temporary}: nothing can be written to "
        f"{places / 'package' / '__pycache__'} or {places / 'home' / 'mesa-mobility'}"
    ]


def block_home(places):
    for path in sorted((places / "home").rglob("*"), reverse=True):
        path.rmdir()
    block(places / "home")


@pytest.mark.parametrize("what", ["a file", "a link", "open to others"])
def test_code_is_not_run_from_a_folder_that_others_can_write_to(places, caplog, what):
    block(places / "package" / "__pycache__")
    block(places / "home")
    shared = places / "tmp" / f"mesa-mobility-{os.getuid()}"
    if what == "a file":
        shared.write_text("")
    elif what == "a link":
        (places / "theirs").mkdir(mode=0o700)
        shared.symlink_to(places / "theirs")
    else:
        shared.mkdir()
        shared.chmod(0o777)
    assert folder() is None
    assert [record.message for record in caplog.records] == [
        "compiled code is not kept, and compiled at each start: no folder can be written"
    ]


def test_what_was_compiled_once_is_used_where_nothing_can_be_written(places, monkeypatch):
    kept = folder()
    (kept / "crowd").mkdir()
    (kept / "crowd" / "decide.nbc").write_bytes(b"code")
    monkeypatch.setattr(kernel_cache, "_make", lambda place: False)
    assert folder() == kept


def test_another_source_has_another_folder_and_leaves_that_of_before(places):
    before = folder()
    (before / "crowd").mkdir()
    (before / "crowd" / "decide.nbc").write_bytes(b"code")
    (places / "package" / "module.py").write_text("2")
    after = folder()
    assert after != before
    assert (before / "crowd" / "decide.nbc").read_bytes() == b"code"


def test_of_other_versions_the_last_ones_are_left(places):
    parent = places / "package" / "__pycache__"
    for k in range(12):
        other = parent / f"mesa-mobility-0.0.{k}-0123456789abcdef"
        other.mkdir(parents=True)
        os.utime(other, (k, k))
    (parent / "module.pyc").write_text("")
    folder()
    left = {path.name.split("-")[2] for path in parent.iterdir() if path.is_dir()}
    assert left == {f"0.0.{k}" for k in range(4, 12)} | {kernel_cache.__version__}
    assert (parent / "module.pyc").exists()


LOADED = """
import sys
import numpy as np
from mesa_mobility.crowd.state.departed import merge
sys.path.insert(0, {folder!r})
from doubling import twice
nobody = np.empty(0, dtype=np.int64)
merge(nobody, nobody, nobody)
print("numba.np.linalg" in sys.modules, end=" ")
print(twice(4), "numba.np.linalg" in sys.modules)
"""


def test_what_ships_is_loaded_without_what_compiles(module):
    for _ in range(2):
        done = subprocess.run(
            [sys.executable, "-c", LOADED.format(folder=str(module.parent))],
            capture_output=True,
            text=True,
            check=True,
        )
    assert done.stdout == "False 8 True\n"


def test_every_function_is_kept_this_way():
    for path in kernel_cache.PACKAGE.rglob("*.py"):
        assert "cache=True" not in path.read_text(), path


FULL = """
import resource, sys
resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
sys.path.insert(0, {folder!r})
from doubling import twice
print(twice(4))
"""


def test_a_full_disk(module, tmp_path):
    """No file may get longer than 0 bytes; names can be made."""
    done = subprocess.run(
        [sys.executable, "-c", FULL.format(folder=str(module.parent))],
        capture_output=True,
        text=True,
        env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "x"), "TMPDIR": str(tmp_path)},
    )
    assert done.stdout == "8\n", done.stderr
    assert done.stderr == (
        "compiled code is not kept, and compiled at each start: no folder can be written\n"
    )


RUN = ["-m", "mesa_mobility", "run", "straight_walk", "--seconds", "1", "--seed", "1", "--json"]


def run(cache: Path, **keywords):
    return subprocess.Popen(
        [sys.executable, *RUN],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"NUMBA_CACHE_DIR": str(cache)} | keywords,
        start_new_session=True,
    )


@pytest.mark.slow
def test_two_first_runs_at_once(tmp_path):
    both = [run(tmp_path / "cache") for _ in range(2)]
    for process in both:
        out, err = process.communicate(timeout=600)
        assert (process.returncode, err) == (0, ""), err
        assert '"pedestrians": 50' in out


@pytest.mark.slow
@pytest.mark.parametrize("after", [4.0, 9.0, 15.0, 22.0])
def test_killed_while_it_compiles(tmp_path, after):
    process = run(tmp_path / "cache")
    try:
        process.communicate(timeout=after)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        process.communicate()
    wait_for_group(process.pid)
    process = run(tmp_path / "cache")
    _, err = process.communicate(timeout=600)
    assert (process.returncode, err) == (0, ""), err


@pytest.mark.slow
def test_nowhere_to_write(tmp_path):
    """Not below the requested folder, nor home, nor for temporary files."""
    nowhere = "/dev/null/nowhere"
    process = run(Path(nowhere), HOME=nowhere, TMPDIR=nowhere, XDG_CACHE_HOME=nowhere)
    _, err = process.communicate(timeout=600)
    assert process.returncode == 0, err
    assert len(err.splitlines()) == 1
