"""The Python in README.md, dashboard.md and how-to guides runs; links between documents work."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
RUN = [
    ROOT / "README.md",
    ROOT / "docs" / "dashboard.md",
    *sorted((ROOT / "docs" / "how-to").rglob("*.md")),
]
LINKED = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md"))]


def name(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


@pytest.mark.thorough
@pytest.mark.parametrize("page", RUN, ids=name)
def test_the_python_on_a_page_runs(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    space: dict[str, object] = {"__name__": "page"}
    for found in re.finditer(
        r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S
    ):
        exec(compile(found[1], f"{page.name}, {found[1].splitlines()[0]!r}", "exec"), space)


@pytest.mark.parametrize("page", LINKED, ids=name)
def test_links_to_files_lead_somewhere(page: Path) -> None:
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    links = re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", text)
    missing = [
        link
        for link in links
        if not re.match(r"[a-z]+:", link) and not (page.parent / link).exists()
    ]

    assert missing == []


@pytest.mark.parametrize("page", LINKED, ids=name)
def test_source_files_that_a_page_names_exist(page: Path) -> None:
    named = re.findall(r"`((?:\w+/)+[\w.]+\.(?:py|toml))`", page.read_text(encoding="utf-8"))
    missing = [
        file
        for file in named
        if not any((folder / file).exists() for folder in (ROOT, ROOT / "mesa_mobility"))
    ]

    assert missing == []
