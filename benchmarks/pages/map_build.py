"""Seconds and memory of each stage of a map build, against the number of poses.

python benchmarks/pages/map_build.py captures/manifest.tsv [--shares 0.25 0.5 1] [--clusters 350]
    [--out FOLDER]

Each share of the clips is built in a process of its own. Memory is the process's peak by
the end of the stage. The first build, of the first share, compiles and is not counted.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from blocks import give, machine, table

from mesa_mobility.capture import load_clips, read_manifest
from mesa_mobility.mobility import build_map

STAGES = ("recordings", "poses", "motion graph", "clusters", "options", "map")


class Clock:
    """Processor seconds, seconds and peak memory between calls."""

    def __init__(self) -> None:
        self.stages: dict[str, dict[str, float]] = {}
        self._cpu, self._wall = time.process_time(), time.perf_counter()

    def lap(self, stage: str) -> None:
        """Count the time since the last lap for a stage."""
        cpu, wall = time.process_time(), time.perf_counter()
        entry = self.stages.setdefault(stage, {"cpu_s": 0.0, "wall_s": 0.0, "peak_mb": 0.0})
        entry["cpu_s"] += cpu - self._cpu
        entry["wall_s"] += wall - self._wall
        entry["peak_mb"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
        self._cpu, self._wall = cpu, wall


def measure(manifest: str, pedestrian_type: str, share: float, clusters: int) -> dict[str, Any]:
    """One build in this process."""
    clock = Clock()
    recordings = load_clips(read_manifest(manifest), pedestrian_type=pedestrian_type).recordings
    clock.lap("recordings")
    kept = [r for k, r in enumerate(recordings) if int((k + 1) * share) > int(k * share)]
    built = build_map(kept, clusters=clusters, progress=lambda stage, done, total: clock.lap(stage))
    clock.lap("map")
    poses = int(built.sizes.sum())
    return {"share": share, "poses": poses, "options": built.n_options, "stages": clock.stages}


def main() -> None:
    """Build from growing shares of the clips; print a table and one JSON line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("manifest")
    parser.add_argument("--type", default="able_bodied")
    parser.add_argument("--shares", type=float, nargs="*", default=[0.25, 0.5, 1.0])
    parser.add_argument("--clusters", type=int, default=350)
    parser.add_argument("--out", type=Path, help="folder for the block")
    parser.add_argument("--child", type=float, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.child is not None:
        print(json.dumps(measure(given.manifest, given.type, given.child, given.clusters)))
        return
    rows = []
    for counted, share in enumerate([given.shares[0], *given.shares]):
        command = [
            sys.executable, __file__, given.manifest, "--type", given.type, "--clusters",
            str(max(2, round(share * given.clusters))), "--child", str(share),
        ]  # fmt: skip
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        result = json.loads(done.stdout.splitlines()[-1])
        if not counted:
            continue
        stages = [result["stages"].get(stage, {"wall_s": 0.0}) for stage in STAGES]
        wall = sum(stage["wall_s"] for stage in result["stages"].values())
        peak = max(stage["peak_mb"] for stage in result["stages"].values())
        seconds = (f"{stage['wall_s']:.1f}" for stage in stages)
        rows.append((f"{result['poses']:,}", *seconds, f"{wall:.1f}", f"{peak:,.0f}"))
    heads = ("poses in the component", *(f"{each}, s" for each in STAGES), "together, s", "peak MB")
    give(given.out, "map-builds", f"{machine()}\n\n{table(heads, rows)}")


if __name__ == "__main__":
    main()
