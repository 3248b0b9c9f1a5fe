"""Blocks of figures in pages, and the lines that say that figures are of an earlier version.

A block lies between ``<!-- NAME -->`` and ``<!-- end of NAME -->``, each on a line of its own. The
line about an earlier version comes first in a block, and below a picture outside of blocks.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from docs.figures.manifest import ROOT, UNKNOWN, Figure, FiguresError

IMAGES = Path("docs/images")

_BEGIN = re.compile(r"<!-- (?!end of )([\w-]+) -->")
_END = re.compile(r"<!-- end of ([\w-]+) -->")
_PICTURE = re.compile(r"!\[[^]]*\]\(([^)\s]+)\)")
_NOTE = re.compile(r"\n\n\*Made with an earlier version of the model \([^\n]*\)\.\*(?=\n|$)")


def pages(root: Path = ROOT) -> list[Path]:
    """The pages that may hold figures."""
    built = root / "docs" / "_build"
    found = sorted((root / "docs").rglob("*.md"))
    return [root / "README.md", *(page for page in found if built not in page.parents)]


def note(figure: Figure) -> str:
    """The line about a figure that was made with an earlier version."""
    known = f"digest {figure.digest}, mesa-mobility {figure.version}"
    told = "digest not known" if figure.digest == UNKNOWN else known
    return f"*Made with an earlier version of the model ({told}).*"


def blocks_in(text: str, where: str = "") -> list[str]:
    """Names of the blocks of a page, in order.

    Raises:
        FiguresError: a block does not end, or lies within another.
    """
    found: list[str] = []
    inside: str | None = None
    for line in text.splitlines():
        begins, ends = _BEGIN.fullmatch(line), _END.fullmatch(line)
        if begins and inside is None:
            inside = begins[1]
            found.append(inside)
        elif ends and ends[1] == inside:
            inside = None
        elif begins or ends:
            raise FiguresError(f"{where}: {line} is out of place")
    if inside is not None:
        raise FiguresError(f"{where}: block {inside} does not end")
    return found


def pictures_in(text: str, page: Path) -> list[Path]:
    """Files of the pictures of a page."""
    return [(page.parent / link).resolve() for link in _PICTURE.findall(text)]


def with_block(text: str, name: str, content: str) -> str:
    """The page with other content of one block."""
    begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->"
    head, found, rest = text.partition(begin)
    _, closed, tail = rest.partition(end)
    if not (found and closed):
        raise FiguresError(f"block {name} is in no page")
    return f"{head}{begin}\n{content.strip()}\n\n{end}{tail}"


def with_notes(
    text: str, page: Path, blocks: Mapping[str, str], pictures: Mapping[Path, str]
) -> str:
    """The page with a line about each block and picture of an earlier version, and no others.

    Args:
        text: of the page.
        page: its path, from which links to pictures start.
        blocks: the line for each such block.
        pictures: the line for each such picture, by its file.
    """
    lines: list[str] = []
    inside, after_note = "", False
    for line in _NOTE.sub("", text).split("\n"):
        if after_note and line:
            lines.append("")
        lines.append(line)
        begins = _BEGIN.fullmatch(line)
        if begins:
            inside = blocks.get(begins[1], "")
            said = [inside] if inside else []
        else:
            links = pictures_in(line, page)
            said = sorted({pictures[each] for each in links if each in pictures} - {inside})
        if _END.fullmatch(line):
            inside = ""
        for each in said:
            lines += ["", each]
        after_note = bool(said)
    return "\n".join(lines)
