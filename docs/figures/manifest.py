"""The list of figures: which command makes which blocks and pictures, and what they depend on."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
MANIFEST = Path("docs/figures.toml")
UNKNOWN = "unknown"


class FiguresError(Exception):
    """What is wrong with the manifest, a page or a command, in one line."""


@dataclass(frozen=True)
class Figure:
    """What one command, or a few in order, makes.

    Attributes:
        name: in the manifest.
        commands: to run, in order; {out} is a folder and {seeds} a number.
        depends: names of the parts that its digest covers; see `digests`.
        seeds: how many seeds or runs the figures in the pages are made with, if any.
        blocks: names of blocks in pages; the commands write {out}/NAME.md for each.
        pictures: files below docs/images; the commands write {out}/FILE, without folders.
        digest: what it was made with, or "unknown".
        version: of the package then, or "unknown".
    """

    name: str
    commands: tuple[str, ...]
    depends: tuple[str, ...]
    seeds: int | None
    blocks: tuple[str, ...]
    pictures: tuple[str, ...]
    digest: str
    version: str


def read_manifest(root: Path = ROOT) -> dict[str, Figure]:
    """All figures by name.

    Raises:
        FiguresError: an entry is not as described.
    """
    tables = tomllib.loads((root / MANIFEST).read_text(encoding="utf-8"))
    return {name: _figure(name, table) for name, table in tables.items()}


def _figure(name: str, table: Mapping[str, Any]) -> Figure:
    known = set(Figure.__dataclass_fields__) - {"name"}
    odd = sorted(set(table) - known)
    missing = sorted({"commands", "depends"} - set(table))
    if odd or missing:
        raise FiguresError(f"{MANIFEST}: [{name}]: unknown keys {odd}, missing keys {missing}")
    lists = {
        key: tuple(table.get(key, ())) for key in ("commands", "depends", "blocks", "pictures")
    }
    if not (lists["blocks"] or lists["pictures"]):
        raise FiguresError(f"{MANIFEST}: [{name}]: neither blocks nor pictures")
    return Figure(
        name=name,
        seeds=table.get("seeds"),
        digest=table.get("digest", UNKNOWN),
        version=table.get("version", UNKNOWN),
        **lists,
    )


def record(name: str, digest: str, version: str, root: Path = ROOT) -> None:
    """Note in the manifest what a figure was made with."""
    path = root / MANIFEST
    text = path.read_text(encoding="utf-8")
    entry = re.search(rf"^\[{re.escape(name)}\]\n(?:(?!\[).*\n?)*", text, re.M)
    if entry is None:
        raise FiguresError(f"{MANIFEST}: no entry [{name}]")
    kept = re.sub(r"^(?:digest|version) = .*\n", "", entry[0], flags=re.M).rstrip("\n")
    ending = "\n\n" if entry.end() < len(text) else "\n"
    new = f'{kept}\ndigest = "{digest}"\nversion = "{version}"{ending}'
    path.write_text(text[: entry.start()] + new + text[entry.end() :], encoding="utf-8")
