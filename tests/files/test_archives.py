"""Zip archives of arrays: equal bytes on any day, and errors of one line."""

import zipfile

import numpy as np
import pytest

from mesa_mobility.errors import MapError, ModelError
from mesa_mobility.files.archives import add_array, add_bytes, reading


def test_the_same_content_has_the_same_bytes(tmp_path):
    for name in ("one", "two"):
        with zipfile.ZipFile(tmp_path / name, "w") as archive:
            add_array(archive, "numbers", np.arange(5)[::2], level=6)
            add_bytes(archive, "text", b"abc", level=9)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()
    with zipfile.ZipFile(tmp_path / "one") as archive:
        assert archive.namelist() == ["numbers.npy", "text"]
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
    assert np.load(tmp_path / "one")["numbers"].tolist() == [0, 2, 4]


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        (FileNotFoundError(2, "x"), "f: no such file, expected a map (.npz)"),
        (PermissionError(13, "Permission denied"), "f: cannot be read (Permission denied)"),
        (zipfile.BadZipFile("not a zip\nat all"), "f: not a readable map (not a zip)"),
        (EOFError(), "f: not a readable map (EOFError)"),
        (KeyError("a" * 300), "f: not a readable map ('" + "a" * 199 + ")"),
    ],
)
def test_whatever_goes_wrong_is_one_line(tmp_path, fault, message):
    with pytest.raises(MapError) as caught, reading("f", "map", MapError, ".npz"):
        raise fault
    assert str(caught.value) == message


def test_errors_of_the_reader_s_own_pass():
    with pytest.raises(ModelError, match=r"^said already$"), reading("f", "map", MapError):
        raise ModelError("said already")


def test_a_kind_without_a_suffix():
    with (
        pytest.raises(ModelError, match=r"^f: no such file, expected a checkpoint$"),
        reading("f", "checkpoint", ModelError),
    ):
        raise FileNotFoundError(2, "x")
