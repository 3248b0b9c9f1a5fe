"""Texts of files in a zip or a folder."""

import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.files.archives import reading
from mesa_mobility.floorplan.formats.assembling.texts import LARGEST_FILE, decoded, read_bytes

MOST = 10_000
"""Files of an archive."""


def names_in(path: Path) -> list[str]:
    """Names of the files in an archive or a folder, without those of folders in it.

    Raises:
        FloorPlanError: it cannot be read.
    """
    if path.is_dir():
        try:
            return sorted(each.name for each in path.iterdir())
        except OSError as error:
            raise FloorPlanError(f"{path}: cannot be read ({error.strerror})") from None
    with _opened(path) as archive:
        return [_base(each) for each in archive.infolist()]


def members(path: Path, needed: Sequence[str], others: Sequence[str] = ()) -> dict[str, str]:
    """Texts of files in an archive, in any folder of it, or in a folder.

    Args:
        path: the archive or the folder.
        needed: names that must be there once.
        others: names that may be missing.

    Raises:
        FloorPlanError: a file that is needed is missing, or one that cannot be read or is no text.
    """
    if path.is_dir():
        names = [*needed, *(each for each in others if (path / each).is_file())]
        data = {name: read_bytes(path / name) for name in names}
    else:
        with _opened(path) as archive:
            there = [_base(each) for each in archive.infolist()]
            names = [*needed, *(each for each in others if each in there)]
            data = {name: _member(archive, name, path) for name in names}
    return {name: decoded(each, f"{path}: {name}", "text") for name, each in data.items()}


@contextmanager
def _opened(path: Path) -> Iterator[zipfile.ZipFile]:
    with reading(path, "zip", FloorPlanError), zipfile.ZipFile(path) as archive:
        if len(archive.infolist()) > MOST:
            raise FloorPlanError(f"{path}: more than {MOST:,} files, expected fewer")
        yield archive


def _base(info: zipfile.ZipInfo) -> str:
    return info.filename.rpartition("/")[2]


def _member(archive: zipfile.ZipFile, name: str, path: Path) -> bytes:
    """A file that is in an archive once, in any folder."""
    names = [each for each in archive.infolist() if _base(each) == name]
    if len(names) != 1:
        raise FloorPlanError(f"{path}: has {len(names)} files {name}, expected one")
    with archive.open(names[0]) as file:
        data = file.read(LARGEST_FILE + 1)
    if len(data) > LARGEST_FILE:
        raise FloorPlanError(f"{path}: {name}: more than {LARGEST_FILE / 1e6:g} MB")
    return data
