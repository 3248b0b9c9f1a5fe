"""Compiled code of a wheel: taken if all fits, never by a processor that lacks a feature."""

import hashlib
import json
import os
import pickle
import subprocess
import sys
from pathlib import Path

import pytest
from llvmlite import binding
from numba.core.caching import IndexDataCacheFile
from numba.core.registry import cpu_target

from mesa_mobility.compiled import cache as kernel_cache
from mesa_mobility.compiled import shipped
from mesa_mobility.crowd import precompile

VERSION = "0.0-of-the-test"
TRIPLE = "a-triple"
KEY = ("signature", (TRIPLE, "this processor", "+its,+features"), ("bytecode", ""))


class Marker:
    """Leaves a file behind where it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return Path.touch, (self.path,)


@pytest.fixture
def every_feature(monkeypatch):
    features = dict.fromkeys(shipped.LEVELS["x86-64-v4"], True)
    monkeypatch.setattr(shipped.binding, "get_host_cpu_features", lambda: features)
    return features


@pytest.fixture
def folder(tmp_path, monkeypatch, every_feature):
    """The folder of code for both levels; of each function its level is kept."""
    monkeypatch.setattr(shipped, "FOLDER", tmp_path)
    monkeypatch.setattr(shipped.config, "CPU_NAME", None)
    monkeypatch.setattr(shipped.config, "CPU_FEATURES", None)
    for level in shipped.LEVELS:
        place = tmp_path / level / "crowd.state"
        place.mkdir(parents=True)
        target = TRIPLE, shipped.CPU, shipped._switched_on(level)
        IndexDataCacheFile(str(place), "move", "").save((KEY[0], target, KEY[2]), level)
    write_index(tmp_path)
    yield tmp_path
    shipped.code_for.cache_clear()


def write_index(folder, **changed):
    files = {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in folder.rglob("*.nb?")
    }
    index = {"made_with": shipped._made_with(VERSION), "files": files} | changed
    (folder / "index.json").write_text(json.dumps(index))


def code():
    shipped.code_for.cache_clear()
    return shipped.code_for(VERSION)


def found(key=KEY, module="crowd.state", base="move"):
    return code().find(module, base, key)


def test_the_best_level_that_a_processor_can_run(folder, every_feature):
    assert (code().level, found()) == ("x86-64-v4", "x86-64-v4")
    every_feature["avx512vl"] = False
    assert (code().level, found()) == ("x86-64-v3", "x86-64-v3")


@pytest.mark.parametrize("level", shipped.LEVELS)
def test_no_code_for_a_processor_without_one_of_its_features(folder, every_feature, level):
    for feature in shipped.LEVELS[level]:
        for lacking in (False, None):
            held = every_feature.pop(feature)
            if lacking is not None:
                every_feature[feature] = lacking
            assert level not in list(shipped._runnable()), feature
            every_feature[feature] = held


def test_no_code_where_the_processor_is_not_known(folder, monkeypatch):
    def unknown():
        raise RuntimeError("no information")

    monkeypatch.setattr(shipped.binding, "get_host_cpu_features", unknown)
    assert code() is None


@pytest.mark.parametrize("name", ["CPU_NAME", "CPU_FEATURES"])
def test_no_code_where_somebody_says_for_what_to_compile(folder, monkeypatch, name):
    monkeypatch.setattr(shipped.config, name, "generic")
    assert code() is None


def test_llvm_knows_the_features_by_these_names():
    if not binding.get_default_triple().startswith("x86_64"):
        pytest.skip("not an x86 processor")
    for features in shipped.LEVELS.values():
        assert set(features) <= set(binding.get_host_cpu_features())


@pytest.mark.parametrize("part", range(4))
def test_no_code_of_another_version(folder, part):
    made_with = shipped._made_with(VERSION)
    made_with[part] = "another"
    write_index(folder, made_with=made_with)
    assert code() is None


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", '{"made_with": 3}', '{"files": 3}'])
def test_no_code_where_the_index_is_damaged(folder, text):
    (folder / "index.json").write_text(text)
    assert code() is None


def test_no_code_in_a_checkout():
    assert not shipped.FOLDER.exists()


@pytest.mark.parametrize(
    "key",
    [
        ("other", KEY[1], KEY[2]),
        (KEY[0], ("another-triple", *KEY[1][1:]), KEY[2]),
        (KEY[0], KEY[1], ("other", "")),
    ],
)
def test_no_code_for_another_key(folder, key):
    assert found() is not None
    assert found(key) is None


def test_no_code_of_another_function(folder):
    assert found(module="crowd.people") is None
    assert found(base="stay") is None


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
def test_a_changed_file_is_not_read(folder, suffix):
    (path,) = (folder / "x86-64-v4").rglob("*" + suffix)
    mark = folder / "read"
    held = path.read_bytes()
    path.write_bytes(pickle.dumps(Marker(mark)))
    assert found() is None
    assert not mark.exists()
    path.write_bytes(held)
    assert found() is not None
    write_index(folder, files={})
    assert code() is None


def test_a_missing_file_is_nothing_to_say(folder):
    for path in folder.rglob("*.nbc"):
        path.unlink()
    assert found() is None


SOURCE = """
from mesa_mobility.compiled.decorators import kept

@kept()
def twice(number):
    return 2 * number

twice(4)
"""


def test_code_of_others_is_not_looked_for(tmp_path, monkeypatch):
    """A function outside of the package has the digest of its file for a stamp."""
    asked = []
    monkeypatch.setattr(kernel_cache, "shipped_code", lambda: asked.append(1))
    kernel_cache._Files(str(tmp_path), "twice", "a digest").load(KEY)
    assert asked == []
    kernel_cache._Files(str(tmp_path), "twice", "").load(KEY)
    assert asked == [1]


def test_what_is_compiled_natively_is_not_taken_from_a_wheel(folder, monkeypatch):
    monkeypatch.setattr(kernel_cache, "_own_only", False)  # another test may have compiled
    monkeypatch.setattr(kernel_cache, "folder", lambda: Path(kernel_cache.PREFIX + VERSION))
    shipped.code_for.cache_clear()
    assert kernel_cache.shipped_code() is not None
    monkeypatch.setattr(kernel_cache, "_own_only", True)
    assert kernel_cache.shipped_code() is None


@pytest.mark.parametrize("wanted", ["0", "1"])
def test_the_first_run_with_a_wheel_compiles_in_the_background(monkeypatch, wanted):
    started = []
    monkeypatch.setenv("MESA_MOBILITY_NATIVE", wanted)
    monkeypatch.setattr(precompile, "_is_kept", lambda: False)
    monkeypatch.setattr(precompile.cache, "shipped_code", lambda: "some")
    monkeypatch.setattr(precompile.subprocess, "Popen", lambda *a, **k: started.append((a, k)))
    with precompile.compiling_ahead():
        assert started == []
    assert len(started) == int(wanted)
    for (command,), given in started:
        assert "compile_natively()" in command[-1]
        assert given["start_new_session"]


def test_code_compiled_for_a_level_has_the_key_that_is_looked_for(tmp_path):
    level = next(shipped._runnable(), None)
    if level is None:
        pytest.skip("the processor has no level")
    script = tmp_path / "doubling.py"
    script.write_text(SOURCE)
    made_for = {"NUMBA_CPU_NAME": shipped.CPU, "NUMBA_CPU_FEATURES": shipped._switched_on(level)}
    run = [sys.executable, str(script)]
    given = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    subprocess.run(run, env=given | made_for, check=True, timeout=120)
    (index,) = tmp_path.glob("*/*/*.nbi")
    files = IndexDataCacheFile(str(index.parent), index.name.removesuffix(".nbi"), "")
    files._source_stamp = hashlib.sha256(script.read_bytes()).hexdigest()
    ((_, target, _),) = files._load_index()
    triple = cpu_target.target_context.codegen().magic_tuple()[0]
    assert target == (triple, shipped.CPU, shipped._switched_on(level))
