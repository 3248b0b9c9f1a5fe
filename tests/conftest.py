import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from mesa_mobility.compiled import cache
from mesa_mobility.crowd import Preset
from tests.fixtures.engine import ENGINE
from tests.fixtures.walker import walker_bvh

VARIABLE = "MESA_MOBILITY_CAPTURES"
SHARED = Path(__file__).resolve().parents[2] / "shared"


# How long an example takes depends on what else the machine does.
settings.register_profile("mesa-mobility", deadline=None)
settings.load_profile("mesa-mobility")


def pytest_sessionstart(session: pytest.Session) -> None:
    """Before several processes run all tests, functions are compiled once.

    Otherwise each of them, and each command that they start, compiles most functions itself.
    """
    config = session.config
    several = len(getattr(config.option, "tx", None) or []) > 1
    everything = config.args_source is pytest.Config.ArgsSource.TESTPATHS
    kept = cache.folder()
    if not (several and everything) or kept is None or any(kept.glob("*/*.nbi")):
        return
    with tempfile.TemporaryDirectory() as temporary:
        recordings = Path(temporary) / "recordings"
        recordings.mkdir()
        (recordings / "walk.bvh").write_text(walker_bvh(150, 1.0))
        # The first compiles in two processes what the others need as well.
        _wait_for(["run", "doorway", "--seconds", "1"])
        _wait_for(
            ["run", "mixed_evacuation", "--seconds", "1"],
            ["map", "build", str(recordings), "-o", f"{temporary}/map.npz", "--clusters", "6"],
        )


def _wait_for(*commands: list[str]) -> None:
    """Run commands at the same time. Tests tell what is wrong with one that fails."""
    started = [
        subprocess.Popen(
            [sys.executable, "-m", "mesa_mobility", *each],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        for each in commands
    ]
    for each in started:
        each.wait()


def pytest_collection_modifyitems(items: Iterable[pytest.Item]) -> None:
    """Slow tests may take as long as their settings make them."""
    for item in items:
        if item.get_closest_marker("slow"):
            item.add_marker(pytest.mark.timeout(0))


BROWSER = "MESA_MOBILITY_BROWSER"
PROGRAMS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


@pytest.fixture(scope="session")
def playwright() -> Iterator[Any]:
    """Playwright, of which a process has one; tests are skipped without it."""
    api = pytest.importorskip(
        "playwright.sync_api", reason="no playwright: pip install 'mesa-mobility[test]'"
    )
    with api.sync_playwright() as driver:
        yield driver


@pytest.fixture(scope="session")
def browser_program() -> str:
    """Chromium or Chrome on this machine; tests are skipped where there is none."""
    program = os.environ.get(BROWSER) or next(filter(None, map(shutil.which, PROGRAMS)), None)
    if program is None:
        pytest.skip(f"no browser: none of {', '.join(PROGRAMS)} found ({BROWSER} can name one)")
    return program


def _captures(folder: Path) -> Path:
    if not (folder / "manifest.tsv").is_file():
        pytest.skip(
            f"no real recordings: {folder} has no manifest.tsv ({VARIABLE} can name a folder)"
        )
    return folder


@pytest.fixture
def whole() -> Preset:
    """That of the engine's tests with the options of the map and no part of them.

    Where options come in parts, to stay where one is is one of them, and always free.
    """
    return replace(ENGINE, name="whole", shares=())


@pytest.fixture
def in_parts() -> Preset:
    """That of the engine's tests with a half, a quarter and none of short options."""
    return replace(ENGINE, name="in_parts", shares=((0.5, 0.25, 0.0),))


@pytest.fixture(scope="session")
def captures_dir() -> Path:
    """Folder of the real recordings that may be shipped from."""
    return _captures(Path(os.environ.get(VARIABLE) or SHARED / "captures"))


@pytest.fixture(scope="session")
def captures_noncommercial_dir() -> Path:
    """Folder of the recordings for research use only."""
    captures = Path(os.environ.get(VARIABLE) or SHARED / "captures")
    return _captures(captures.parent / "captures_noncommercial")
