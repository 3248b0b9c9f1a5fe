"""What has been read from a file is kept until the file changes."""

import os

import pytest

from mesa_mobility.bodies import PoseBank
from mesa_mobility.errors import MapError
from mesa_mobility.files.read_once import read_once
from mesa_mobility.mobility import MobilityMap


@pytest.fixture
def counted():
    """A reader, and what it has read."""
    seen = []

    def read(path, make):
        seen.append(path.read_text())
        return make(seen[-1])

    return read, seen


def test_a_file_is_read_again_only_if_it_has_changed(tmp_path, counted):
    read, seen = counted
    file = tmp_path / "numbers"
    file.write_text("12")
    assert read_once(file, read, int) == read_once(str(file), read, int) == 12
    assert seen == ["12"]
    file.write_text("34")
    os.utime(file, (0, 0))
    assert read_once(file, read, int) == 34
    assert seen == ["12", "34"]


def test_one_file_gives_each_reader_its_own(tmp_path, counted):
    read, seen = counted
    file = tmp_path / "numbers"
    file.write_text("12")
    assert read_once(file, read, int) == 12
    assert read_once(file, read, str) == "12"
    assert read_once(file, lambda path, make: path.name, str) == "numbers"
    assert seen == ["12", "12"]


def test_a_missing_file_is_the_reader_s_to_refuse(tmp_path, counted):
    with pytest.raises(FileNotFoundError):
        read_once(tmp_path / "none", counted[0], int)


@pytest.mark.parametrize("kind", [MobilityMap, PoseBank])
def test_maps_and_banks_that_are_missing_are_refused_in_one_line(tmp_path, kind):
    with pytest.raises(MapError, match=r"none: no such file, expected a .* \(.*npz\)$"):
        kind.load(tmp_path / "none")
