"""The options of several types are those of each, and the same from the kept arrays."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility import MobilityMap
from mesa_mobility.compiled import cache, kept_arrays
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.kept_options import DTYPES, check_options
from mesa_mobility.crowd.options.repertoire import _laid_out, repertoire
from mesa_mobility.crowd.options.table import stack_tables, unstacked
from mesa_mobility.errors import ContentError
from tests.fixtures.damage.contents import mangle_array
from tests.fixtures.maps import make_map, stand, straight, strider

DURATIONS = (12, 24, 45)
SHARES = ((0.5, 0.0),)


def other():
    return make_map([[stand()], [stand(), straight(0.75, 24, to=0), straight(1.5, 45)]])


def equal(one, another):
    for mine, others in zip(one, another, strict=True):
        assert (mine.dtype, mine.shape) == (others.dtype, others.shape)
        assert np.asarray(mine).tobytes() == np.asarray(others).tobytes()
    return True


@pytest.mark.parametrize("makes", [(strider,), (strider, other), (other, strider, other)])
def test_tables_are_those_that_were_stacked(makes):
    tables = [Capability(make(), DURATIONS, SHARES).table for make in makes]
    first_option = np.cumsum([0] + [len(each.options) for each in tables[:-1]])
    first_cluster = np.cumsum([0] + [len(each.farthest) for each in tables[:-1]]).astype("i4")
    found = unstacked(stack_tables(tables), first_option, first_cluster)
    assert all(equal(*both) for both in zip(found, tables, strict=True))


def test_capabilities_of_several_types_are_those_of_each():
    maps = strider(), other()
    found = repertoire(maps, DURATIONS, SHARES)
    for capability, map_ in zip(found.capabilities, maps, strict=True):
        alone = Capability(map_, DURATIONS, SHARES)
        assert capability.map is map_
        assert equal(capability.table, alone.table)
        assert equal(capability.parts, alone.parts)
        assert equal(capability.first_velocities, alone.first_velocities)
        assert capability.longest_reach == alone.longest_reach
        assert capability.n_clusters == alone.n_clusters


def test_a_repertoire_is_laid_out_once_for_a_file_and_the_numbers(tmp_path, monkeypatch):
    folder = tmp_path / "kept" / "mesa-mobility-1-ab"
    folder.mkdir(parents=True)
    monkeypatch.setattr(cache, "folder", lambda: folder)
    monkeypatch.setattr(kept_arrays, "LEAST", 0)
    paths = [tmp_path / f"{name}.npz" for name in ("one", "two")]
    for path, make in zip(paths, (strider, other), strict=True):
        make().save(path)

    def made(shares=SHARES):
        # Maps of other objects: the cache in memory does not know them.
        return repertoire(tuple(map(MobilityMap._read, paths)), DURATIONS, shares)

    def kept():
        return len(list((folder / "arrays").glob("options-*.npy")))

    fresh = made()
    assert kept() == 1
    monkeypatch.setattr("mesa_mobility.crowd.options.repertoire._laid_out", None)
    mapped = made()
    assert equal(fresh.table, mapped.table)
    assert equal(fresh.groups, mapped.groups)
    assert type(fresh.table.options) is type(mapped.table.options)
    assert fresh.table.options.dtype.isalignedstruct
    assert mapped.table.options.dtype.isalignedstruct
    names = ("first_cluster", "first_option", "standing", "reach", "extent")
    assert equal(*([getattr(each, name) for name in names] for each in (fresh, mapped)))
    for one, another in zip(fresh.capabilities, mapped.capabilities, strict=True):
        assert equal(one.table, another.table)
        assert equal(one.parts, another.parts)
    monkeypatch.undo()
    monkeypatch.setattr(cache, "folder", lambda: folder)
    monkeypatch.setattr(kept_arrays, "LEAST", 0)
    made(((0.25,),))
    assert kept() == 2


def test_maps_without_a_file_are_laid_out_in_memory(tmp_path, monkeypatch):
    monkeypatch.setattr(cache, "folder", lambda: tmp_path)
    monkeypatch.setattr(kept_arrays, "LEAST", 0)
    repertoire((strider(), other()), DURATIONS, SHARES)
    assert list(tmp_path.iterdir()) == []


def laid_out():
    maps = strider(), other()
    return maps, dict(_laid_out(maps, DURATIONS, SHARES, None))


def test_laid_out_options_are_what_a_file_of_them_must_hold():
    maps, arrays = laid_out()
    check_options(arrays, maps)
    assert {name: each.dtype for name, each in arrays.items()} == DTYPES


@pytest.mark.parametrize("name", sorted(DTYPES))
@given(seed=st.integers(0, 2**32))
@settings(max_examples=30, deadline=None)
def test_options_that_were_changed_are_refused_or_within_reach(name, seed):
    maps, arrays = laid_out()
    changed, said = mangle_array(arrays[name], np.random.default_rng(seed))
    same = (changed.dtype, changed.shape) == (arrays[name].dtype, arrays[name].shape)
    try:
        check_options({**arrays, name: changed}, maps)
    except ContentError:
        return
    assert same, said
    # All that numbers rows of other arrays is as it was; other numbers cannot lead far.
    flat = [changed[field] for field in changed.dtype.names or ()] or [changed]
    whole = [arrays[name][field] for field in changed.dtype.names or ()] or [arrays[name]]
    for found, expected in zip(flat, whole, strict=True):
        if found.dtype.kind in "iu" and name != "parts.rows" and len(found) > 1:
            differs = found != expected
            # Another option of the same group of those that stay, and of as many frames.
            assert not differs.any() or said.startswith("stay"), said
        elif found.dtype.kind == "f":
            assert np.isfinite(found).all()
            assert abs(found).max() <= 200.0


@pytest.mark.parametrize(
    ("name", "field", "at", "value"),
    [
        ("table.offsets", None, 0, 1),
        ("table.offsets", None, 1, 2),
        ("table.groups", None, 1, 2),
        ("groups.first", None, -1, 9),
        ("groups.clusters", "first", 1, 0),
        ("groups.clusters", "last", 0, 2),
        ("groups.clusters", "stay", 2, 0),
        ("table.options", "frames", 0, 45),
        ("table.options", "cluster", 0, 1),
        ("parts.rows", None, -1, 1000),
        ("parts.clusters", None, -1, 2),
        ("parts.share", None, 0, 1.5),
        ("table.path", None, (0, 1, 7), np.nan),
        ("table.path", None, (0, 1, 7), 101.0),
        ("extent", None, 1, -0.5),
    ],
)
def test_options_that_do_not_fit_each_other(name, field, at, value):
    maps, arrays = laid_out()
    changed = np.array(arrays[name])
    target = changed if field is None else changed[field]
    assert target[at] != value
    target[at] = value
    with pytest.raises(ContentError, match="options"):
        check_options({**arrays, name: changed}, maps)


def test_options_of_other_maps():
    maps, arrays = laid_out()
    for others in (maps[::-1], maps[:1], maps + maps[:1]):
        with pytest.raises(ContentError, match="options"):
            check_options(arrays, others)
