"""Plain Numba equals hand-written code, and replaces it where that cannot be compiled."""

import os
import subprocess
import sys

import llvmlite
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from llvmlite import binding, ir
from numba import njit

from mesa_mobility.compiled import intrinsics, simd, twins, vectors
from mesa_mobility.compiled.simd import AT_ONCE

_plain = njit(simd._plain_place_of_least)


@njit
def _least(values, n):
    return simd.place_of_least(values, n)


@njit
def _between_threads(counts, place, value):
    taken = intrinsics.take_number(counts, place)
    seen = intrinsics.load_acquire(counts, place)
    intrinsics.store_release(counts, place + 1, value)
    intrinsics.prefetch(counts, place, 64)
    intrinsics.rest()
    return taken, seen


take, load, store = (
    njit(getattr(intrinsics, f"_plain_{name}"))
    for name in ("take_number", "load_acquire", "store_release")
)


@given(
    st.lists(
        st.floats(allow_nan=False) | st.sampled_from([0.0, -0.0, 1.0, np.inf, -np.inf]),
        min_size=1,
        max_size=100,
    )
)
@settings(deadline=None)
def test_the_place_of_the_least_is_that_of_its_twin(values):
    n = len(values)
    filled = np.full(n + AT_ONCE, np.inf)
    filled[:n] = values
    assert _least(filled, n) == _plain(filled, n) == values.index(min(values))


@given(
    st.lists(st.integers(-(2**62), 2**62), min_size=3, max_size=6),
    st.integers(-(2**62), 2**62),
    st.data(),
)
@settings(deadline=None)
def test_what_threads_need_of_one_another_is_what_its_twins_do(counts, value, data):
    place = data.draw(st.integers(0, len(counts) - 2))
    one, other = np.array(counts, dtype=np.int64), np.array(counts, dtype=np.int64)
    taken, seen = _between_threads(one, place, value)
    assert (taken, seen) == (take(other, place), load(other, place))
    store(other, place + 1, value)
    assert one.tolist() == other.tolist()
    expected = list(counts)
    expected[place : place + 2] = [counts[place] + 1, value]
    assert one.tolist() == expected


def test_hand_written_code_is_compiled_here():
    assert twins._compiles()
    assert twins.PLAIN == twins.PLAIN_WANTED


def _everything(numbers, counts):
    """A module of all that hand-written code is made of, for pointers of these types."""
    module = ir.Module()
    takes = ir.FunctionType(vectors.DOUBLE, [numbers, counts, vectors.LONG])
    function = ir.Function(module, takes, "everything")
    builder = ir.IRBuilder(function.append_basic_block())
    begin, count, at = function.args
    start = vectors.Start(begin, vectors.DOUBLE)
    loaded = vectors.load(builder, start, at, 8)
    more = vectors.more_of(builder, loaded, vectors.same(vectors.DOUBLE, 8, 0.0))
    one = vectors.spread(builder, vectors.load_one(builder, start, at), 8)
    vectors.store(builder, vectors.less_of(builder, more, one), start, at)
    place = vectors.place_in(builder, vectors.Start(count, vectors.LONG), at)
    vectors.store_release(builder, vectors.take_number(builder, place), place)
    vectors.load_acquire(builder, place)
    vectors.prefetch(builder, vectors.bytes_of(builder, begin).pointer)
    half = vectors.some_lanes(builder, loaded, range(4))
    builder.ret(builder.extract_element(half, ir.Constant(vectors.INT, 3)))
    return str(module)


@pytest.mark.parametrize(
    ("numbers", "counts"),
    [
        pytest.param(
            ir.PointerType(),
            ir.PointerType(),
            marks=pytest.mark.skipif(
                not getattr(llvmlite, "opaque_pointers_enabled", True),
                reason="this llvmlite has typed pointers",
            ),
        ),
        (vectors.DOUBLE.as_pointer(), vectors.LONG.as_pointer()),
    ],
    ids=["opaque", "typed"],
)
def test_pointers_may_be_typed_or_opaque(numbers, counts):
    binding.parse_assembly(_everything(numbers, counts)).verify()


@pytest.mark.parametrize("error", [AttributeError("as_pointer"), TypeError("typ")])
def test_where_llvmlite_has_another_interface_twins_are_taken(monkeypatch, error):
    def fail(*args, **options):
        raise error

    monkeypatch.setattr(vectors, "load", fail)
    assert not twins._compiles()


def test_where_llvm_does_not_take_the_code_twins_are_taken(monkeypatch):
    def of_another_width(builder, vector, lanes):
        return ir.Constant(ir.VectorType(vectors.LONG, 4), ir.Undefined)

    monkeypatch.setattr(vectors, "some_lanes", of_another_width)
    assert not twins._compiles()


def test_a_twin_is_compiled_in_place_of_hand_written_code(monkeypatch):
    def one(typingctx):
        raise AssertionError("hand-written code was used")

    monkeypatch.setattr(twins, "PLAIN", True)
    chosen = twins.with_twin(lambda: 1)(one)
    assert njit(lambda: chosen())() == 1


_WALK = """
import hashlib, sys
import numpy as np
from mesa_mobility.compiled.twins import PLAIN
from mesa_mobility.models import Doorway, OpenSpace
print(PLAIN)
for model, seconds in ((Doorway(rng=1), 20.0), (OpenSpace(pedestrians=320, rng=2), 4.0)):
    digest, n = hashlib.sha256(), model.population.count
    assert n < 256 or n > 300
    while model.running and model.elapsed < seconds:
        model.step()
        crowd = model.crowd
        for array in (crowd.x, crowd.y, crowd.heading, crowd.active):
            digest.update(np.ascontiguousarray(array[: model.population.count]).tobytes())
    print(digest.hexdigest())
"""


def _walk(folder, **variables):
    environment = {
        **{key: value for key, value in os.environ.items() if key != "MESA_MOBILITY_PLAIN"},
        "NUMBA_CACHE_DIR": str(folder),
        "NUMBA_NUM_THREADS": "2",
        **variables,
    }
    done = subprocess.run(
        [sys.executable, "-c", _WALK], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    plain, *digests = done.stdout.split()
    return plain, digests


@pytest.mark.slow
def test_trajectories_are_the_same_in_plain_numba(tmp_path):
    plain, expected = _walk(tmp_path)
    assert plain == "False"
    files = set(tmp_path.rglob("*.nbc"))
    plain, found = _walk(tmp_path, MESA_MOBILITY_PLAIN="1")
    assert plain == "True"
    assert found == expected
    # The compiled files of one are never used for the other.
    new = set(tmp_path.rglob("*.nbc")) - files
    assert new
    assert {path.relative_to(tmp_path).parts[0] for path in new} == {"plain"}
