"""Figures and pictures of pages are made by the commands of docs/figures.toml, or marked."""

from pathlib import Path

import pytest

from docs.figures import manifest, pages
from docs.figures.checking import Stale, faults, marked_pages

PAGE = """# A page

<!-- flows -->

| width | flow |

<!-- end of flows -->

![Flow](images/flow.png)
Text.
"""
MANIFEST = """[flow]
commands = ["python flow.py {out}"]
depends = ["preset"]
blocks = ["flows"]
pictures = ["flow.png"]
digest = "abc"
version = "0.1.0"

[other]
commands = ["python other.py {out}"]
depends = ["map"]
blocks = ["others"]
"""


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """A repository with one page, one picture and one figure."""
    (tmp_path / "docs" / "images").mkdir(parents=True)
    (tmp_path / "docs" / "page.md").write_text(PAGE)
    (tmp_path / "docs" / "images" / "flow.png").touch()
    (tmp_path / "README.md").write_text("Nothing.\n")
    (tmp_path / manifest.MANIFEST).write_text(MANIFEST.partition("\n[other]")[0])
    return tmp_path


def stale(root: Path, *earlier: str) -> Stale:
    return Stale(root, manifest.read_manifest(root), earlier)


def test_figures_of_all_pages_are_of_this_version_or_marked():
    assert faults(Stale.now()) == []


def test_a_figure_of_an_earlier_version_is_marked_once_in_its_block_and_below_its_picture(
    root: Path,
):
    page = root / "docs" / "page.md"
    line = "*Made with an earlier version of the model (digest abc, mesa-mobility 0.1.0).*"

    assert faults(stale(root)) == []
    assert len(faults(stale(root, "flow"))) == 1

    for _ in range(2):
        page.write_text(marked_pages(stale(root, "flow"))[page])
    assert page.read_text() == PAGE.replace(
        "<!-- flows -->\n", f"<!-- flows -->\n\n{line}\n"
    ).replace("flow.png)\n", f"flow.png)\n\n{line}\n\n")
    assert faults(stale(root, "flow")) == []

    assert len(faults(stale(root))) == 1
    page.write_text(marked_pages(stale(root))[page])
    assert page.read_text() == PAGE.replace("flow.png)\n", "flow.png)\n\n")


def test_a_picture_within_the_marked_block_of_its_figure_is_not_marked_again():
    block = "<!-- a -->\n\n![A](images/a.png)\n\n<!-- end of a -->\n"
    page = Path("/docs/page.md")

    marked = pages.with_notes(block, page, {"a": "*Old.*"}, {Path("/docs/images/a.png"): "*Old.*"})

    assert marked.count("*Old.*") == 1


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda root: (root / "docs" / "images" / "new.png").touch(), "new.png is not in docs/fig"),
        (
            lambda root: (root / "docs" / "images" / "flow.png").unlink(),
            "flow.png is not in docs/i",
        ),
        (lambda root: (root / "README.md").write_text(PAGE), "block flows is in 2 pages"),
        (lambda root: (root / "docs" / "page.md").write_text("None.\n"), "flows is in no page"),
        (
            lambda root: (root / "README.md").write_text("<!-- a -->\n<!-- end of a -->\n"),
            "block a is not in docs/figures.toml",
        ),
    ],
)
def test_what_does_not_agree_is_named(root: Path, change, told: str):
    change(root)

    assert any(told in line for line in faults(stale(root)))


@pytest.mark.parametrize(
    "text", ["<!-- a -->\n", "<!-- end of a -->\n", "<!-- a -->\n<!-- b -->\n"]
)
def test_a_block_without_its_end_is_refused(text: str):
    with pytest.raises(manifest.FiguresError):
        pages.blocks_in(text)


def test_a_block_gets_other_content():
    assert pages.with_block(PAGE, "flows", "new\n") == PAGE.replace("| width | flow |", "new")
    with pytest.raises(manifest.FiguresError, match="block other"):
        pages.with_block(PAGE, "other", "new")


def test_what_a_figure_was_made_with_is_recorded(root: Path):
    (root / manifest.MANIFEST).write_text(MANIFEST)

    manifest.record("flow", "123", "0.2.0", root)
    manifest.record("other", "456", "0.2.0", root)

    found = manifest.read_manifest(root)
    assert [(f.digest, f.version) for f in found.values()] == [("123", "0.2.0"), ("456", "0.2.0")]
    assert found["flow"].commands == ("python flow.py {out}",)
    manifest.record("flow", "abc", "0.1.0", root)
    assert (root / manifest.MANIFEST).read_text().startswith(MANIFEST.partition("\n[other]")[0])
