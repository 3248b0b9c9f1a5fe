"""A map that has been read before is the same when it comes from the kept arrays."""

from dataclasses import fields, replace

import numpy as np
import pytest

from mesa_mobility import MobilityMap
from mesa_mobility.compiled import cache, kept_arrays
from mesa_mobility.errors import MapError
from mesa_mobility.mobility.map import LENDER
from mesa_mobility.mobility.mapfile import shipped_map_path
from tests.fixtures.damage.kept_files import KeptContents
from tests.fixtures.maps import strider


@pytest.fixture
def place(tmp_path, monkeypatch):
    folder = tmp_path / "kept" / "mesa-mobility-1-ab"
    folder.mkdir(parents=True)
    monkeypatch.setattr(cache, "folder", lambda: folder)
    monkeypatch.setattr(kept_arrays, "LEAST", 0)
    return folder / "arrays"


def same(one, other):
    for field in fields(one):
        mine, others = getattr(one, field.name), getattr(other, field.name)
        if isinstance(mine, np.ndarray):
            assert (mine.dtype, mine.shape) == (others.dtype, others.shape), field.name
            assert mine.tobytes() == others.tobytes(), field.name
            assert not mine.flags.writeable
            assert not others.flags.writeable
        elif field.name != "file":
            assert mine == others, field.name
    return True


def read(path):
    return MobilityMap._read(path)


@pytest.mark.parametrize("name", ["wheelchair_manual", "cane"])
def test_a_shipped_map_is_the_same_from_kept_arrays(place, name):
    path = shipped_map_path(name)
    first = read(path)
    assert list(place.glob("map-*.npy"))
    second = read(path)
    assert isinstance(second, MobilityMap)
    assert same(first, second)
    assert first.digest == second.digest
    assert first.info() == second.info()


def test_a_map_is_read_once(place, tmp_path, monkeypatch):
    path = tmp_path / "map.npz"
    strider().save(path)
    first = read(path)
    monkeypatch.setattr("mesa_mobility.mobility.kept_map.read_map", None)
    assert same(first, read(path))


@pytest.mark.parametrize(
    ("name", "at", "value"),
    [
        ("offsets", -1, 1000),
        ("durations", 0, 7),
        ("path_offsets", 1, 0),
        ("path_clusters", 0, 60_000),
        ("paths", (0, 1), np.nan),
        ("paths", (0, 0), 50.0),
        ("sizes", 0, 0),
        ("metadata", 0, ord("x")),
    ],
)
def test_a_kept_map_that_does_not_fit_is_made_again(place, tmp_path, name, at, value):
    path = tmp_path / "map.npz"
    strider().save(path)
    first = read(path)
    [file] = place.glob("map-*.npy")
    sound = KeptContents(file, "map")
    changed = np.array(sound.arrays[name])
    assert changed[at] != value
    changed[at] = value
    kept_arrays._write(file, sound.key, {**sound.arrays, name: changed})
    assert same(first, read(path))
    assert KeptContents(file, "map").arrays[name].tobytes() == sound.arrays[name].tobytes()


def test_another_file_is_another_map(place, tmp_path):
    path = tmp_path / "map.npz"
    map_ = strider()
    map_.save(path)
    first = read(path)
    replace(map_, metadata={**map_.metadata, "pedestrian_type": "other"}).save(path)
    second = read(path)
    assert (first.pedestrian_type, second.pedestrian_type) != ("other", "strider")
    assert second.pedestrian_type == "other"
    assert first.origin != second.origin


def test_maps_made_in_memory_have_no_origin(place, tmp_path):
    path = tmp_path / "map.npz"
    strider().save(path)
    assert strider().origin is None
    assert read(path).origin is not None
    assert replace(read(path), sizes=read(path).sizes + 1).origin is None


def test_a_file_that_is_replaced_while_it_is_read_is_not_kept(place, tmp_path, monkeypatch):
    path = tmp_path / "map.npz"
    strider().save(path)
    from mesa_mobility.mobility import kept_map

    whole = kept_map.read_map

    def replaced(*arguments):
        found = whole(*arguments)
        path.write_bytes(path.read_bytes() + b"more")
        return found

    monkeypatch.setattr(kept_map, "read_map", replaced)
    assert read(path).origin is None
    assert not place.exists()


def test_what_is_no_map_says_so_each_time(place, tmp_path):
    path = tmp_path / "map.npz"
    path.write_text("no map")
    for _ in range(2):
        with pytest.raises(MapError, match="not a readable mobility map"):
            read(path)
    with pytest.raises(MapError, match="no such file"):
        read(tmp_path / "none.npz")
    assert not place.exists()


def test_maps_borrow_from_the_able_bodied_map():
    assert shipped_map_path(LENDER).name == "able_bodied.npz"
