"""A file that is written is complete, or what was there before."""

import errno

import pytest

from mesa_mobility.errors import FloorPlanError, MapError, ResultsError
from mesa_mobility.files.atomic import replacing


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_an_interrupted_writer_leaves_the_old_file(tmp_path):
    path = tmp_path / "old.txt"
    path.write_text("old")

    def write():
        with replacing(path, ResultsError) as temporary:
            temporary.write_text("half")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        write()
    assert path.read_text() == "old"
    assert names(tmp_path) == ["old.txt"]


@pytest.mark.parametrize("error", [FloorPlanError, MapError, ResultsError])
def test_a_full_disk_is_one_line(tmp_path, error):
    with pytest.raises(error) as caught, replacing(tmp_path / "new.txt", error):
        raise OSError(errno.ENOSPC, "No space left on device")
    assert str(caught.value) == f"{tmp_path}/new.txt: cannot be written: No space left on device"
    assert names(tmp_path) == []
