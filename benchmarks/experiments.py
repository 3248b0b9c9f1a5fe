"""What an experiment costs beside its runs, and how often its intervals hold.

    python benchmarks/experiments.py overhead --runs 10000 --workers 2 --store STORE
    python benchmarks/experiments.py coverage --store STORE

--out FOLDER writes what either prints as a block for docs/explanation/scaling_experiments.md.

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
from pages.blocks import give, machine, table

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
    parser.add_argument("--out", type=Path, help="folder for the block")
    arguments = parser.parse_args()
    if arguments.what == "overhead":
        text = overhead(arguments.store, arguments.runs, arguments.people, arguments.workers)
    else:
        text = coverage(arguments.store, arguments.repetitions)
    give(arguments.out, f"experiments-{arguments.what}", text)


def overhead(place: Path, runs: int, people: int, workers: int) -> str:
    """Run an experiment and compare the time of its runs with that of everything."""
    if place.exists():
        raise SystemExit(f"{place} is there: runs that it holds would not be timed")
    experiment = Experiment(
        "doorway",
        {"door_width": WIDTHS},
        replications=runs // len(WIDTHS),
        seed=1,
        fixed={"pedestrians": people},
        max_seconds=120,
        keep=("occupancy",),
    )
    process = psutil.Process()
    memory: list[tuple[int, float]] = []
    marks: list[int] = []

    def watch(now: Progress) -> None:
        memory.append((now.ended, process.memory_info().rss / 1e6))
        if not marks or now.ended >= marks[-1] + runs / 10:
            marks.append(now.ended)
            print(f"{now.ended} of {now.total} runs, driver {memory[-1][1]:.0f} MB", flush=True)

    with (
        LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            dashboard_address=None,
            env={"NUMBA_NUM_THREADS": "1"},
        ) as cluster,
        Client(cluster) as client,
    ):
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
    rows = [
        (
            "wall time beyond the runs' own",
            "10 %",
            f"{(there - own) / own:.1%}: runs {own:,.0f} s, workers there for {there:,.0f} s",
        ),
        (
            "processor time beyond the runs' own, driver and scheduler included",
            "",
            f"{(used - own_cpu) / own_cpu:.1%}: {sum(spent):,.0f} s of workers and {driver:,.0f} s "
            f"for {own_cpu:,.0f} s of runs",
        ),
        (
            "memory of the driver, with the scheduler in it, since a tenth of the runs",
            "+50 MB",
            f"{memory[-1][1] - first:+.1f} MB",
        ),
        ("files in the store", "200", f"{len(files)}, with {size / len(frame):.0f} bytes a row"),
        ("processor time of driver and scheduler", "", f"{1e3 * driver / len(frame):.1f} ms a run"),
        ("batches", "", f"{own / BATCH_SECONDS:.0f} of {BATCH_SECONDS:g} s"),
        ("message to a worker", "", f"{message:.0f} bytes a run"),
    ]
    told = f"{runs:,} runs of {people} people on {workers} workers. {machine()}"
    return f"{told}\n\n{table(('figure', 'required', 'measured'), rows)}"


def cpu_seconds(process: psutil.Process) -> float:
    """Processor time that a process has had."""
    times = process.cpu_times()
    return float(times.user + times.system)


def coverage(place: Path, repetitions: int) -> str:
    """How often the stated interval holds the mean of all runs of a point."""
    frame = open_store(place).frame(series=True)
    frame = frame[frame["point"] == frame["point"].iloc[0]]
    egress, curves = frame.egress_s.to_numpy(float), frame.occupancy.to_numpy()
    true = float(egress.mean())
    told = (
        f"The {len(egress):,} runs that stand for the truth have a mean egress time of "
        f"{true:.2f} s and a standard deviation of {egress.std(ddof=1):.2f} s. The experiment is "
        f"repeated {repetitions:,} times; the standard error of a share of all is at most "
        f"{np.sqrt(0.05 * 0.95 / repetitions):.1%} at 95 %."
    )
    rows = []
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
        rows.append(
            (
                f"{asked} to {precision.tolerance:.0%}",
                f"{min(counts)} to {max(counts)}, {np.median(counts):.0f}",
                sum(held[:100]),
                f"{share:.1%}",
                f"{within} of {len(hundreds)}",
            )
        )
    heads = (
        "requested precision",
        "runs: range, median",
        "of the first 100",
        "of all",
        "hundreds with 92 to 98",
    )
    return f"{told}\n\n{table(heads, rows)}"


if __name__ == "__main__":
    main()
