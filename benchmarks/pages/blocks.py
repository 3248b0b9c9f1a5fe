"""Blocks of figures for pages: what `python -m docs.figures` puts between a page's marks."""

from __future__ import annotations

import os
import platform
from collections.abc import Iterable, Sequence
from pathlib import Path

import numba


def table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table in Markdown."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def give(folder: Path | None, name: str, text: str) -> None:
    """Write a block as NAME.md into a folder, or print it without one."""
    if folder is None:
        print(f"{text}\n")
        return
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.md").write_text(text + "\n", encoding="utf-8")


def machine() -> str:
    """What times were measured on, as a sentence for a page."""
    names = [
        line.partition(":")[2].strip()
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        if line.startswith("model name")
    ]
    load = os.getloadavg()[0]
    return (
        f"{len(names)} processors {names[0]} of a virtual machine, load {load:.1f}; "
        f"Python {platform.python_version()}, Numba {numba.__version__}."
    )
