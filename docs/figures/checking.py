"""Whether manifest, pages and pictures agree, and which figures are of an earlier version."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from docs.figures.digests import digest_of
from docs.figures.manifest import MANIFEST, ROOT, Figure, read_manifest
from docs.figures.pages import IMAGES, blocks_in, note, pages, pictures_in, with_notes


@dataclass(frozen=True)
class Stale:
    """The figures, and which of them are of an earlier version.

    Attributes:
        root: folder of the repository.
        figures: by name.
        earlier: names of those that were made with another digest than that of now.
    """

    root: Path
    figures: dict[str, Figure]
    earlier: tuple[str, ...]

    @classmethod
    def now(cls, root: Path = ROOT) -> Stale:
        """As the code is now."""
        figures = read_manifest(root)
        earlier = (name for name, each in figures.items() if each.digest != digest_of(each.depends))
        return cls(root, figures, tuple(earlier))


def marked_pages(stale: Stale) -> dict[Path, str]:
    """Each page as it should be, with lines about figures of earlier versions."""
    blocks, pictures = {}, {}
    for name in stale.earlier:
        figure = stale.figures[name]
        blocks |= dict.fromkeys(figure.blocks, note(figure))
        files = ((stale.root / IMAGES / each).resolve() for each in figure.pictures)
        pictures |= dict.fromkeys(files, note(figure))
    return {
        page: with_notes(page.read_text(encoding="utf-8"), page, blocks, pictures)
        for page in pages(stale.root)
    }


def faults(stale: Stale) -> list[str]:
    """What is wrong, one line each."""
    return [*_unlisted(stale), *_unmarked(stale)]


def _unlisted(stale: Stale) -> list[str]:
    root = stale.root
    texts = {page: page.read_text(encoding="utf-8") for page in pages(root)}
    there = Counter(b for page, text in texts.items() for b in blocks_in(text, str(page)))
    listed = Counter(b for each in stale.figures.values() for b in each.blocks)
    drawn = Counter(p for each in stale.figures.values() for p in each.pictures)
    folder = (root / IMAGES).resolve()
    files = {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()}
    shown = {p for page, text in texts.items() for p in pictures_in(text, page)}
    within = {p.relative_to(folder).as_posix() for p in shown if p.is_relative_to(folder)}
    return [
        *(f"block {b} is in {n} pages, expected one" for b, n in there.items() if n > 1),
        *(f"block {b} is not in {MANIFEST}" for b in there if b not in listed),
        *(f"block {b} is in no page" for b in listed if b not in there),
        *(f"block {b} is in {MANIFEST} {n} times" for b, n in listed.items() if n > 1),
        *(f"picture {p} is not in {MANIFEST}" for p in sorted((files | within) - set(drawn))),
        *(f"picture {p} is not in {IMAGES}" for p in sorted((set(drawn) | within) - files)),
        *(f"picture {p} is in no page" for p in sorted(files - within)),
        *(f"picture {p} is in {MANIFEST} {n} times" for p, n in drawn.items() if n > 1),
    ]


def _unmarked(stale: Stale) -> list[str]:
    found: list[str] = []
    for page, wanted in marked_pages(stale).items():
        text, where = page.read_text(encoding="utf-8"), page.relative_to(stale.root).as_posix()
        if text == wanted:
            continue
        figures = [stale.figures[name] for name in stale.earlier]
        lacking = [each for each in figures if text.count(note(each)) != wanted.count(note(each))]
        found += [
            f"{each.name}: made with digest {each.digest}, which is not that of this version, and "
            f"not marked so in {where}; run `python -m docs.figures --make {each.name}` or `--mark`"
            for each in lacking
        ]
        if not lacking:
            found.append(f"{where}: a line about an earlier version is out of place; run `--mark`")
    return found
