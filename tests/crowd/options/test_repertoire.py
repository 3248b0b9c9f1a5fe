"""The options of several types are those of each, and the same from the kept arrays."""

import numpy as np
import pytest

from mesa_mobility import MobilityMap
from mesa_mobility.compiled import cache, kept_arrays
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.repertoire import repertoire
from mesa_mobility.crowd.options.table import stack_tables, unstacked
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
