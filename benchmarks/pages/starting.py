"""Seconds until a first and a later run are done, and what they are spent on.

python benchmarks/pages/starting.py [--out FOLDER]

The first run compiles into an empty folder, as it does after installation.
"""

from __future__ import annotations

import argparse
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from blocks import give, machine, table

REPEATS = 3

IMPORTS = """
import time
start = time.perf_counter()
from mesa_mobility import MobilityMap, PedestrianModel
from mesa_mobility.models import Doorway
imported = time.perf_counter()
MobilityMap.load(None)
read = time.perf_counter()
model = Doorway(rng=1)
made = time.perf_counter()
model.run(max_seconds=600)
print(imported - start, read - imported, made - read, time.perf_counter() - made)
"""


def run(cache: str, out: str) -> tuple[float, float]:
    """Seconds and processor seconds of one command that runs the doorway and draws it."""
    command = [
        sys.executable,
        "-m",
        "mesa_mobility",
        "run",
        "doorway",
        "--seed",
        "1",
        "--no-progress",
        "--out",
        out,
    ]
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
    subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return time.perf_counter() - start, cpu


def main() -> None:
    """Measure and write the block."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, help="folder for the block")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        cache = f"{folder}/cache"
        first, cpu = run(cache, f"{folder}/first")
        later = [run(cache, f"{folder}/later")[0] for _ in range(REPEATS)]
        parts = []
        for _ in range(REPEATS):
            done = subprocess.run(
                [sys.executable, "-c", IMPORTS],
                check=True,
                capture_output=True,
                text=True,
                env={**os.environ, "NUMBA_CACHE_DIR": cache},
            )
            parts.append([float(each) for each in done.stdout.split()])
    columns = zip(*parts, strict=True)
    imported, read, made, simulated = (f"{statistics.median(each):.1f}" for each in columns)
    rows = [
        (
            "first run of the doorway after installation, compiling",
            f"{first:.0f} ({cpu:.0f} of CPU)",
        ),
        ("later runs of the doorway, with pictures", f"{statistics.median(later):.1f}"),
        ("- the package and its libraries imported", imported),
        ("- the map mapped into memory", read),
        ("- its options as well, and the model made", made),
        ("- the run itself", simulated),
    ]
    told = f"{machine()} Medians of {REPEATS}, except for the first run."
    give(given.out, "starting", f"{told}\n\n{table(('', 'seconds'), rows)}")


if __name__ == "__main__":
    main()
