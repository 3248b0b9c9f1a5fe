import math
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from mesa_mobility.cli import main

PLUGIN = Path(__file__).parents[1] / "fixtures" / "plugin" / "corridor_plugin.py"
ENTRY_POINTS = """\
[mesa_mobility.models]
corridor = corridor_plugin:Corridor
forgetful = corridor_plugin:WithoutRecord
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


@pytest.fixture
def install(tmp_path, monkeypatch) -> Callable[[str, str], None]:
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

    return make


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
        with pytest.raises(SystemExit) as ended:
            main()
        code = ended.value.code
        output = capfd.readouterr()
        return Outcome(0 if code is None else int(code), output.out, output.err)

    return call


BONES = ("UpLeg", "Leg", "Foot", "ToeBase")
LENGTHS = (0.0, 0.42, 0.42, 0.12)


def walker_bvh(walking: int, stride: float) -> str:
    """A stick figure in metres at 30 Hz: it stands 2 s, walks, stands 2 s; the legs swing."""
    lines = ["HIERARCHY", "ROOT Hips", "{", "OFFSET 0 0 0"]
    lines.append("CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation")
    for side, x in (("Left", 0.1), ("Right", -0.1)):
        for bone, length in zip(BONES, LENGTHS, strict=True):
            offset = f"{x} 0 0" if bone == "UpLeg" else f"0 {-length} 0"
            lines += [f"JOINT {side}{bone}", "{", f"OFFSET {offset}"]
            lines.append("CHANNELS 3 Zrotation Xrotation Yrotation")
        lines += ["End Site", "{", "OFFSET 0 0 0.05", "}"] + ["}"] * len(BONES)
    frames, travelled = [], 0.0
    for frame in range(120 + walking):
        # Starting and stopping take half a second.
        ease = min(max(frame - 60, 0), max(60 + walking - frame, 0), 15) / 15
        travelled += ease * stride / 30
        phase = 2 * math.pi * travelled / (1.1 * stride)
        angles = [0.0, 0.0, 0.0]
        for turn in (0.0, math.pi):
            swing = 22 * ease * math.sin(phase + turn)
            bend = 30 * ease * max(0.0, math.cos(phase + turn))
            angles += [0, swing, 0, 0, bend, 0, 0, -0.3 * swing, 0, 0, 0, 0]
        frames.append(f"0 0.9 {travelled:.5f} " + " ".join(f"{angle:.4f}" for angle in angles))
    lines += ["}", "MOTION", f"Frames: {len(frames)}", f"Frame Time: {1 / 30:.7f}", *frames]
    return "\n".join(lines) + "\n"


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
