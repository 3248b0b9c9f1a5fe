"""Versions of packages, machine and sha256 of files with which results were computed."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from mesa_mobility.errors import ResultsError
from mesa_mobility.reports.html import Page

_PACKAGES = ("mesa-mobility", "mesa", "numpy", "scipy", "numba", "llvmlite", "shapely", "pyarrow")


def versions() -> dict[str, str]:
    """Versions of Python and of the packages that results depend on, by name."""
    found = {"python": platform.python_version()}
    for name in _PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def machine() -> str:
    """Operating system and kind of processor."""
    return f"{platform.system()} {platform.machine()}"


def sha256_of(path: Path) -> str:
    """The sha256 of a file.

    Raises:
        ResultsError: the file cannot be read.
    """
    try:
        with path.open("rb") as source:
            return hashlib.file_digest(source, "sha256").hexdigest()
    except OSError as error:
        raise ResultsError(f"{path}: cannot be read: {error.strerror or error}") from error


def add_versions(
    page: Page, found: Mapping[str, str], inputs: Mapping[str, str], on: str, note: str = ""
) -> None:
    """Add a table of what results were computed with, to a section that has begun.

    Args:
        page: to add it to.
        found: versions by name.
        inputs: sha256 of files by name.
        on: the machine.
        note: a paragraph below.
    """
    rows = [[name, number] for name, number in found.items()]
    rows.append(["machine", on])
    rows += [[name.replace("_", " "), digest] for name, digest in inputs.items()]
    page.table("Versions, and digests (sha256) of inputs", ["what", "which"], rows, note)
