"""What an experiment costs beside its runs, on a Dask cluster on this machine.

    python benchmarks/experiments.py --runs 10000 --workers 2

prints the time of the runs, the time that the workers were there for them, the memory of this
process over time and the number of files in the store.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
import time
from pathlib import Path

import psutil
from distributed import LocalCluster

from mesa_mobility.experiments import Experiment, Progress, run_experiment

PEOPLE = 30


def main() -> None:
    """Run, and print the figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()
    experiment = Experiment(
        "doorway", {"door_width": [0.8, 1.0, 1.2, 1.6, 2.0]},
        replications=max(1, arguments.runs // 5), seed=1, fixed={"pedestrians": PEOPLE},
        max_seconds=120,
    )  # fmt: skip
    place = Path(tempfile.mkdtemp(prefix="mesa-mobility-"))
    process, memory, marks = psutil.Process(), [], []

    def watch(now: Progress) -> None:
        memory.append((now.ended, process.memory_info().rss / 1e6))
        if not marks or now.ended >= marks[-1] + arguments.runs / 10:
            marks.append(now.ended)
            print(f"{now.ended} of {now.total} runs, driver {memory[-1][1]:.0f} MB", flush=True)

    try:
        with LocalCluster(
            n_workers=arguments.workers, threads_per_worker=1, dashboard_address=None,
            env={"NUMBA_NUM_THREADS": "1"},
        ) as cluster:  # fmt: skip
            # Imports and the map are loaded once a worker, whatever the number of runs.
            run_experiment(
                Experiment("doorway", replications=4 * arguments.workers, max_seconds=10),
                place / "warm", executor=cluster,
            )  # fmt: skip
            began = time.perf_counter()
            store = run_experiment(experiment, place / "store", executor=cluster, progress=watch)
            elapsed = time.perf_counter() - began
        status = store.status()
        own, there = status["runs_s"], elapsed * arguments.workers
        first = next(m for ended, m in memory if ended >= arguments.runs / 10)
        print(f"runs' own time {own:.1f} s, workers were there for {there:.1f} s")
        print(f"overhead {(there - own) / own:.1%} of the runs' own time")
        print(f"driver: {memory[-1][1] - first:+.1f} MB since a tenth of the runs")
        files = [path for path in (place / "store").rglob("*") if path.is_file()]
        print(f"files in the store: {len(files)}")
        print(f"bytes of rows: {sum(store.shards().values())}")
    finally:
        shutil.rmtree(place)


if __name__ == "__main__":
    main()
