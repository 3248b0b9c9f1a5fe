"""What has been read from a file is kept until the file changes."""

import os
from pathlib import Path
from typing import ClassVar

import pytest

from mesa_mobility.bodies import PoseBank
from mesa_mobility.errors import MapError
from mesa_mobility.files.read_once import read_once
from mesa_mobility.mobility import MobilityMap


class Number:
    """A number in a file, of which a class can be derived."""

    read_so_far: ClassVar[list[str]]

    def __init_subclass__(cls):
        cls.read_so_far = []

    @classmethod
    def read(cls, path):
        cls.read_so_far.append(path.read_text())
        return cls.__name__, int(cls.read_so_far[-1])


def test_a_file_is_read_again_only_if_it_has_changed(tmp_path):
    class Kind(Number):
        pass

    file = tmp_path / "numbers"
    file.write_text("12")
    assert read_once(file, Kind.read) == read_once(str(file), Kind.read) == ("Kind", 12)
    assert Kind.read_so_far == ["12"]
    file.write_text("34")
    os.utime(file, (0, 0))
    assert read_once(file, Kind.read) == ("Kind", 34)
    assert Kind.read_so_far == ["12", "34"]


def test_one_file_gives_each_class_and_reader_its_own(tmp_path):
    class One(Number):
        pass

    class Other(Number):
        pass

    file = tmp_path / "numbers"
    file.write_text("12")
    assert read_once(file, One.read) == ("One", 12)
    assert read_once(file, Other.read) == ("Other", 12)
    assert read_once(file, lambda path: path.name) == "numbers"
    assert (One.read_so_far, Other.read_so_far) == (["12"], ["12"])


def test_a_missing_file_is_the_reader_s_to_refuse(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_once(tmp_path / "none", Path.read_text)


@pytest.mark.parametrize("kind", [MobilityMap, PoseBank])
def test_maps_and_banks_that_are_missing_are_refused_in_one_line(tmp_path, kind):
    with pytest.raises(MapError, match=r"none: no such file, expected a .* \(.*npz\)$"):
        kind.load(tmp_path / "none")
