"""What an experiment costs beside its runs, and how often its intervals hold.

    python benchmarks/experiments.py overhead --runs 10000 --workers 2 --store STORE
    python benchmarks/experiments.py coverage --store STORE

The first runs people through a door on a Dask cluster on this machine. It prints the time of the
runs, the time that the workers were there for them, processor time likewise, the memory of this
process over time, and the files and messages. The second takes the runs of the store's first point
for the truth, repeats an experiment with `replications="auto"` on runs drawn from them with
replacement, and counts how often the interval that it states holds their mean.
"""

from __future__ import annotations

import argparse
import os
import pickle
import shutil
import time
from pathlib import Path

import numpy as np
import psutil
from distributed import Client, LocalCluster

from mesa_mobility.experiments import (
    Experiment,
    OccupancyConvergence,
    Precision,
    Progress,
    open_store,
    run_experiment,
)
from mesa_mobility.experiments.convergence import assess
from mesa_mobility.experiments.driver import BATCH_SECONDS

WIDTHS = [1.0, 1.2]


def main() -> None:
    """Run, and print the figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=("overhead", "coverage"))
    parser.add_argument("--store", type=Path, required=True)
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--people", type=int, default=30)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--repetitions", type=int, default=100)
    arguments = parser.parse_args()
    if arguments.what == "overhead":
        overhead(arguments.store, arguments.runs, arguments.people, arguments.workers)
    else:
        coverage(arguments.store, arguments.repetitions)


def overhead(place: Path, runs: int, people: int, workers: int) -> None:
    """Run an experiment and compare the time of its runs with that of everything."""
    experiment = Experiment(
        "doorway", {"door_width": WIDTHS}, replications=runs // len(WIDTHS), seed=1,
        fixed={"pedestrians": people}, max_seconds=120, keep=("occupancy",),
    )  # fmt: skip
    process = psutil.Process()
    memory: list[tuple[int, float]] = []
    marks: list[int] = []

    def watch(now: Progress) -> None:
        memory.append((now.ended, process.memory_info().rss / 1e6))
        if not marks or now.ended >= marks[-1] + runs / 10:
            marks.append(now.ended)
            print(f"{now.ended} of {now.total} runs, driver {memory[-1][1]:.0f} MB", flush=True)

    with LocalCluster(
        n_workers=workers, threads_per_worker=1, dashboard_address=None,
        env={"NUMBA_NUM_THREADS": "1"},
    ) as cluster, Client(cluster) as client:  # fmt: skip
        # Imports and the map are loaded once a worker, whatever the number of runs.
        warm = place.with_name(f"{place.name}-warm")
        run_experiment(
            Experiment("doorway", replications=4 * workers, max_seconds=10), warm, executor=client
        )
        shutil.rmtree(warm)
        others = [psutil.Process(pid) for pid in client.run(os.getpid).values()]
        before = [cpu_seconds(each) for each in (process, *others)]
        began = time.perf_counter()
        store = run_experiment(experiment, place, executor=client, progress=watch)
        elapsed = time.perf_counter() - began
        driver, *spent = np.subtract([cpu_seconds(each) for each in (process, *others)], before)
    frame = store.frame()
    own, own_cpu, there = frame.wall_s.sum(), frame.cpu_s.sum(), elapsed * workers
    used = driver + sum(spent)
    first = next(m for ended, m in memory if ended >= runs / 10)
    files = [path for path in place.rglob("*") if path.is_file()]
    size = sum(store.shards().values())
    message = len(pickle.dumps(tuple((experiment.point(0), k) for k in range(100)))) / 100
    print(f"load of the machine {os.getloadavg()}, {os.cpu_count()} processors")
    print(f"wall clock: runs {own:.1f} s, workers there for {there:.1f} s: "
          f"overhead {(there - own) / own:.1%}")  # fmt: skip
    print(f"processor: runs {own_cpu:.1f} s, workers {sum(spent):.1f} s, driver and scheduler "
          f"{driver:.1f} s: overhead {(used - own_cpu) / own_cpu:.1%}")  # fmt: skip
    print(f"driver: {memory[-1][1] - first:+.1f} MB since a tenth of the runs")
    print(f"driver and scheduler: {1e3 * driver / len(frame):.2f} ms of processor a run")
    print(f"about {own / BATCH_SECONDS:.0f} batches of {BATCH_SECONDS:g} s")
    print(f"files in the store: {len(files)}; {size / len(frame):.0f} bytes a row")
    print(f"message to a worker: {message:.0f} bytes a run")


def cpu_seconds(process: psutil.Process) -> float:
    """Processor time that a process has had."""
    times = process.cpu_times()
    return float(times.user + times.system)


def coverage(place: Path, repetitions: int) -> None:
    """How often the stated interval holds the mean of all runs of a point."""
    frame = open_store(place).frame(series=True)
    frame = frame[frame["point"] == frame["point"].iloc[0]]
    egress, curves = frame.egress_s.to_numpy(float), frame.occupancy.to_numpy()
    true = float(egress.mean())
    print(f"{len(egress)} runs: mean egress time {true:.3f} s, sd {egress.std(ddof=1):.3f} s")
    for precision in (
        Precision(("mean egress_s",), 0.02, occupancy=None),
        Precision(("mean egress_s",), 0.02, occupancy=OccupancyConvergence()),
        Precision(),
    ):
        rng = np.random.default_rng(1)
        held, counts = [], []
        for _ in range(repetitions):
            drawn = rng.integers(len(egress), size=precision.most)
            count = 0
            while True:
                count = precision.next_count(count)
                taken = drawn[:count]
                known = assess(precision, count, {"egress_s": egress[taken]}, list(curves[taken]))
                if known.enough or count >= precision.most:
                    break
            found = known.estimates["mean egress_s"]
            assert found.low is not None
            assert found.high is not None
            held.append(found.low <= true <= found.high)
            counts.append(count)
        asked = ", ".join([*precision.figures, *(["occupancy"] if precision.occupancy else [])])
        share = np.mean(held)
        hundreds = np.reshape(held[: repetitions // 100 * 100], (-1, 100)).sum(axis=1)
        within = int(np.sum((hundreds >= 92) & (hundreds <= 98)))
        noise = np.sqrt(share * (1 - share) / repetitions)
        print(
            f"{asked}, to {precision.tolerance:.0%}: {sum(held)} of {repetitions} intervals hold "
            f"the mean, {share:.1%} (standard error {noise:.1%}); {sum(held[:100])} of the first "
            f"100, 92 to 98 in {within} of {len(hundreds)} hundreds; "
            f"{min(counts)} to {max(counts)} runs, median {np.median(counts):.0f}"
        )


if __name__ == "__main__":
    main()
