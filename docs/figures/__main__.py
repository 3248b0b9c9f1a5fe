"""Check, make or mark the figures and pictures of the documentation.

    python -m docs.figures                          # check: status 1, one line for each fault
    python -m docs.figures --list
    python -m docs.figures --make plugins tracks    # run commands, fill in pages and pictures
    python -m docs.figures --make verify --seeds 1  # try a command; pages stay as they are
    python -m docs.figures --mark                   # mark figures of earlier versions in pages

docs/figures.toml lists the figures. Commands run in the root of the repository. What they write
stays in out/figures/NAME-DIGEST, so that an interrupted command of many runs goes on.
"""

from __future__ import annotations

import argparse
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from docs.figures import pages
from docs.figures.checking import Stale, faults, marked_pages
from docs.figures.digests import PARTS, digest_of, part
from docs.figures.manifest import ROOT, Figure, FiguresError, read_manifest, record
from mesa_mobility import __version__


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(
        prog="python -m docs.figures",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--list", action="store_true", help="list figures and digests")
    what.add_argument("--make", nargs="+", metavar="NAME", help="make figures again")
    what.add_argument("--mark", action="store_true", help="mark figures of earlier versions")
    parser.add_argument("--seeds", type=int, help="with --make: only try, with so many seeds")
    given = parser.parse_args()
    try:
        if given.list:
            show()
            return 0
        for name in given.make or ():
            make(name, given.seeds)
        if given.mark or (given.make and given.seeds is None):
            for page, text in marked_pages(Stale.now()).items():
                page.write_text(text, encoding="utf-8")
            return 0
        return 0 if given.make else check()
    except FiguresError as error:
        print(error, file=sys.stderr)
        return 1


def check() -> int:
    """Print what is wrong, and how many figures are marked; the exit status."""
    stale = Stale.now()
    found = faults(stale)
    for line in found:
        print(line)
    print(
        f"{len(stale.figures)} figures, {len(stale.earlier)} of an earlier version: "
        f"{', '.join(stale.earlier) or 'none'}"
    )
    return 1 if found else 0


def show() -> None:
    """Print each figure with what it depends on, and the digests of now."""
    where = {block: page for page in pages.pages() for block in pages.blocks_in(page.read_text())}
    for figure in read_manifest().values():
        state = "present" if figure.digest == digest_of(figure.depends) else "earlier"
        named = [f"{where[b].relative_to(ROOT)}: {b}" for b in figure.blocks if b in where]
        print(f"{figure.name} ({state}, {figure.digest}; {', '.join(figure.depends)})")
        for line in (*named, *figure.pictures):
            print(f"    {line}")
    for name in PARTS:
        print(f"now: {name} {part(name)[:12]}")


def make(name: str, seeds: int | None) -> None:
    """Run the commands of a figure and fill in its blocks and pictures.

    Args:
        name: of the figure.
        seeds: None for as many as the manifest says; otherwise pages stay as they are.

    Raises:
        FiguresError: there is no such figure, or a command did not write what it should.
    """
    figures = read_manifest()
    if name not in figures:
        raise FiguresError(f"figure {name!r} is unknown, expected one of {', '.join(figures)}")
    figure = figures[name]
    digest = digest_of(figure.depends)
    folder = ROOT / "out" / "figures" / f"{name}-{digest}"
    run(figure, folder, figure.seeds if seeds is None else seeds)
    if seeds is not None:
        print(f"{name}: see {folder}")
        return
    for block in figure.blocks:
        content = (folder / f"{block}.md").read_text(encoding="utf-8")
        page = page_of(block)
        page.write_text(pages.with_block(page.read_text("utf-8"), block, content), "utf-8")
    for picture in figure.pictures:
        shutil.copyfile(folder / Path(picture).name, ROOT / pages.IMAGES / picture)
    record(name, digest, __version__)


def run(figure: Figure, folder: Path, seeds: int | None) -> None:
    """Run the commands, which write into the folder.

    A command may end with another status than 0 because the model fails a test. What counts is
    that all files are there.
    """
    folder.mkdir(parents=True, exist_ok=True)
    files = [folder / f"{block}.md" for block in figure.blocks]
    files += [folder / Path(picture).name for picture in figure.pictures]
    for file in files:
        file.unlink(missing_ok=True)
    captures = os.environ.get("MESA_MOBILITY_CAPTURES", str(ROOT.parent / "shared" / "captures"))
    programs = {
        "python": [sys.executable],
        "mesa-mobility": [sys.executable, "-m", "mesa_mobility"],
    }
    for command in figure.commands:
        first, *words = shlex.split(command.format(out=folder, seeds=seeds, captures=captures))
        path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
        subprocess.run(
            [*programs.get(first, [first]), *words],
            cwd=ROOT,
            env={**os.environ, "PYTHONPATH": path},
        )
    missing = [file.name for file in files if not file.exists()]
    if missing:
        raise FiguresError(f"{figure.name}: its commands did not write {', '.join(missing)}")


def page_of(block: str) -> Path:
    """The page that has a block."""
    for page in pages.pages():
        if block in pages.blocks_in(page.read_text("utf-8"), str(page)):
            return page
    raise FiguresError(f"block {block} is in no page")


if __name__ == "__main__":
    sys.exit(main())
