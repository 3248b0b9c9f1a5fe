import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from mesa_mobility.cli import main
from mesa_mobility.commands import console
from mesa_mobility.plugins.formats import _load
from mesa_mobility.plugins.registry import known
from tests.fixtures.walker import walker_bvh

PLUGIN = Path(__file__).parents[1] / "fixtures" / "plugin" / "corridor_plugin.py"
ENTRY_POINTS = """\
[mesa_mobility.models]
corridor = corridor_plugin:Corridor
forgetful = corridor_plugin:WithoutRecord
picky = corridor_plugin:Picky
seedless = corridor_plugin:Seedless
absent = no_such_module:Model
nameless = corridor_plugin:Missing
number = corridor_plugin:not_a_class

[mesa_mobility.behaviors]
broken_term = no_such_module:Term
"""


@dataclass(frozen=True)
class Outcome:
    status: int
    out: str
    err: str


@pytest.fixture(autouse=True)
def no_lines_of_progress(monkeypatch) -> None:
    """However slow the machine is: tests look at every line of standard error."""
    monkeypatch.setattr(console, "EVERY_S", 1e6)


@pytest.fixture
def install(tmp_path, monkeypatch) -> Iterator[Callable[[str, str], None]]:
    """Installs a package of a given name that offers entry points."""

    def make(package: str, entry_points: str) -> None:
        folder = tmp_path / "site" / package
        metadata = folder / f"{package}-1.2.dist-info"
        metadata.mkdir(parents=True)
        (metadata / "METADATA").write_text(
            f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.2\n"
        )
        (metadata / "entry_points.txt").write_text(entry_points)
        monkeypatch.syspath_prepend(str(folder))

    # What is installed does not change while a process runs, but here it does.
    for cached in (known, _load):
        cached.cache_clear()
    yield make
    for cached in (known, _load):
        cached.cache_clear()


@pytest.fixture
def plugins(install, tmp_path, monkeypatch) -> None:
    """A plug-in package with good and broken models, as pip would have installed it."""
    install("corridors", ENTRY_POINTS)
    shutil.copy(PLUGIN, tmp_path / "site" / "corridors")
    monkeypatch.delitem(sys.modules, "corridor_plugin", raising=False)


@pytest.fixture
def command(monkeypatch, capfd) -> Callable[..., Outcome]:
    """Runs `mesa-mobility ARGUMENTS...` in this process."""

    def call(*arguments: object) -> Outcome:
        monkeypatch.setattr(sys, "argv", ["mesa-mobility", *map(str, arguments)])
        before = signal.getsignal(signal.SIGINT)
        try:
            with pytest.raises(SystemExit) as ended:
                main()
        finally:
            signal.signal(signal.SIGINT, before)
        code = ended.value.code
        output = capfd.readouterr()
        return Outcome(0 if code is None else int(code), output.out, output.err)

    return call


@pytest.fixture(scope="session")
def recordings(tmp_path_factory) -> Path:
    """A folder of three recordings: two long enough and a short one."""
    folder = tmp_path_factory.mktemp("recordings")
    (folder / "slow.bvh").write_text(walker_bvh(150, 1.0))
    (folder / "brisk.bvh").write_text(walker_bvh(150, 1.3))
    whole = walker_bvh(0, 1.0).splitlines()
    motion = whole.index("MOTION")
    short = [
        *whole[: motion + 1],
        "Frames: 40",
        whole[motion + 2],
        *whole[motion + 3 : motion + 43],
    ]
    (folder / "short.bvh").write_text("\n".join(short) + "\n")
    return folder


@pytest.fixture(scope="session")
def map_file(recordings, tmp_path_factory) -> Path:
    """A small map of those recordings."""
    path = tmp_path_factory.mktemp("map") / "small.npz"
    arguments = ["map", "build", str(recordings), "-o", str(path), "--clusters", "12"]
    done = subprocess.run(
        [sys.executable, "-m", "mesa_mobility", *arguments], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return path
