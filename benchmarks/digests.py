"""Digests of trajectories: whether a change leaves how people walk as it was, to the last bit.

python benchmarks/digests.py [--threads 1 2] [--against digests.json]

Prints one JSON object, scene -> sha256 of positions, headings and decisions of everybody, and ends
with status 1 where it differs from the file, or between numbers of threads.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mesa_mobility.models import Auditorium, Doorway, MixedEvacuation
from peers import our_model
from scenarios import bottleneck, open_walk, room

from mesa_mobility import PedestrianModel

Scene = Callable[[], tuple[PedestrianModel, float]]

SCENES: dict[str, Scene] = {
    "doorway": lambda: (Doorway(rng=1), 60.0),
    "paper doorway": lambda: (Doorway(preset="paper", rng=1), 60.0),
    "bottleneck": lambda: (our_model(bottleneck()), 60.0),
    "open 1000": lambda: (our_model(open_walk(1_000)), 10.0),
    "open 3000": lambda: (our_model(open_walk(3_000)), 10.0),
    "room": lambda: (our_model(room()), 60.0),
    "auditorium": lambda: (Auditorium(rng=1), 30.0),
    "mixed evacuation": lambda: (MixedEvacuation(rng=1), 60.0),
}


def digest(model: PedestrianModel, seconds: float) -> str:
    """The sha256 of where everybody is and has decided, each second, in hexadecimal digits."""
    sha = hashlib.sha256()
    while model.running and model.elapsed < seconds:
        model.run(max_seconds=model.elapsed + 1.0)
        crowd, rows = model.crowd, model.rows
        sha.update(rows.tobytes())
        for values in (crowd.x, crowd.y, crowd.heading, crowd.decisions, crowd.option):
            sha.update(values[rows].tobytes())
    return sha.hexdigest()


def of_this_process() -> dict[str, str]:
    """Scene -> sha256, with the threads that the environment allows."""
    return {name: digest(*make()) for name, make in SCENES.items()}


def with_threads(count: int) -> dict[str, Any]:
    """The same in a process of its own."""
    environment = {**os.environ, "NUMBA_NUM_THREADS": str(count)}
    command = [sys.executable, __file__, "--here"]
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--against", type=Path)
    parser.add_argument("--here", action="store_true", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.here:
        print(json.dumps(of_this_process()))
        return 0
    found = [with_threads(count) for count in asked.threads]
    print(json.dumps(found[0], indent=1))
    if asked.against:
        found.append(json.loads(asked.against.read_text()))
    differ = sorted({name for each in found for name in each if each[name] != found[0].get(name)})
    for name in differ:
        print(f"{name}: {', '.join(str(each.get(name))[:12] for each in found)}", file=sys.stderr)
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
