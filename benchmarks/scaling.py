"""Cost of a simulated person-second against people, density, options and processors.

python benchmarks/scaling.py [--most 100000] [--largest 1000000] [--out FOLDER]

Open walk, 10 s, compilation not counted; the last four parts are in processes of their own. A
person-second costs more or less as its decisions do, so their number is printed as well. Memory is
what is resident after people have been added and have walked for a second, less what was before.
"""

from __future__ import annotations

import argparse
import gc
import json
import multiprocessing
import os
import resource
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from pages.blocks import give, machine, table
from peers import our_model
from scenarios import Scenario, open_walk

from mesa_mobility import MobilityMap

PEOPLE = (1_000, 3_000, 10_000, 30_000, 100_000)
DENSITIES = (0.1, 0.25, 0.5, 1.0, 1.5)
KEEP_EVERY = (8, 4, 2, 1)
SECONDS = 10.0
SETTLED = 1.0
"""Seconds after which the largest crowd is timed: all decide in the first frame."""
CORES = (1, os.cpu_count() or 1)


def thinned(map_: MobilityMap, every: int) -> MobilityMap:
    """The map with every n-th option of each cluster and duration, at least one."""
    cluster = np.repeat(np.arange(map_.n_clusters), np.diff(map_.offsets))
    label = cluster * 100 + map_.durations
    order = np.argsort(label, kind="stable")
    first = np.concatenate([[True], np.diff(label[order]) != 0])
    place = np.arange(len(order)) - np.maximum.accumulate(np.where(first, np.arange(len(order)), 0))
    rows = np.sort(order[place % every == 0])
    samples = np.diff(map_.path_offsets)[rows]
    starts = np.concatenate([[0], np.cumsum(samples)])
    within = np.arange(starts[-1]) - np.repeat(starts[:-1], samples)
    at = np.repeat(map_.path_offsets[rows], samples) + within
    counts = np.bincount(cluster[rows], minlength=map_.n_clusters)
    return replace(
        map_,
        offsets=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        durations=map_.durations[rows],
        costs=map_.costs[rows],
        path_offsets=starts.astype(np.int64),
        paths=map_.paths[at],
        path_clusters=map_.path_clusters[at],
    )


def timed(scenario: Scenario, map_: MobilityMap | None = None) -> dict[str, Any]:
    """One run: microseconds a person-second and a decision."""
    model = our_model(scenario, map_)
    cpu, wall = time.process_time(), time.perf_counter()
    model.run(max_seconds=scenario.seconds)
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    person_s = float(model.crowd.active_frames.sum()) / 30.0
    return {
        "people": len(scenario.places),
        "cpu_s": cpu,
        "wall_s": wall,
        "us_per_person_s": 1e6 * cpu / person_s,
        "us_per_decision": 1e6 * cpu / float(model.crowd.decisions.sum()),
    }


def show(title: str, label: str, value: object, result: dict[str, Any]) -> dict[str, Any]:
    """Print one line of a table."""
    print(
        f"{title:10s} {label} {value!s:>8}: {result['us_per_person_s']:6.1f} us a person-second, "
        f"{result['us_per_decision']:6.1f} us a decision, {result['cpu_s']:.2f} CPU s, "
        f"{result['wall_s']:.2f} s",
        flush=True,
    )
    return {label: value, **result}


def _one(people: int) -> dict[str, Any]:
    timed(open_walk(20, seconds=1.0))
    return timed(open_walk(people, seconds=SECONDS))


def in_processes(count: int, people: int, threads: int) -> dict[str, Any]:
    """The slowest of so many runs at once, each in a process of its own with so many threads."""
    os.environ["NUMBA_NUM_THREADS"] = str(threads)
    with multiprocessing.get_context("spawn").Pool(count) as pool:
        runs = pool.map(_one, [people] * count)
    return max(runs, key=lambda run: float(run["wall_s"]))


def resident() -> int:
    """Bytes of this process in memory, on Linux."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def memory(people: int) -> dict[str, Any]:
    """Resident memory a person, once everything is compiled and the map is there."""
    timed(open_walk(3_000, seconds=1.0))
    scenario = open_walk(people)
    gc.collect()
    before = resident()
    model = our_model(scenario)
    model.run(max_seconds=1.0)
    gc.collect()
    each = (resident() - before) / people
    print(f"memory     people {people:8d}: {each:6.0f} bytes a person", flush=True)
    return {
        "people": people,
        "bytes_per_person": each,
        "before": before,
        "record": model.crowd.records.dtype.itemsize,
        "agenda": model.crowd.agenda.dtype.itemsize,
    }


def largest(people: int) -> dict[str, Any]:
    """Time and memory of one run of 3 s, of which the last two are timed."""
    timed(open_walk(3_000, seconds=1.0))
    begun = time.perf_counter()
    model = our_model(open_walk(people))
    set_up = time.perf_counter() - begun
    model.run(max_seconds=SETTLED)
    known = float(model.crowd.active_frames.sum())
    cpu, wall = time.process_time(), time.perf_counter()
    model.run(max_seconds=SETTLED + 2.0)
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    person_s = (float(model.crowd.active_frames.sum()) - known) / 30.0
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    found = {
        "people": people,
        "set_up_s": set_up,
        "us_per_person_s": 1e6 * cpu / person_s,
        "wall_s_per_s": wall / 2.0,
        "peak_bytes": peak,
    }
    print(f"largest    {json.dumps(found)}", flush=True)
    return found


def main() -> None:
    """Run all parts, print tables and one JSON line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--most", type=int, default=100_000)
    parser.add_argument("--largest", type=int, default=1_000_000)
    parser.add_argument("--out", type=Path, help="folder for blocks and picture")
    given = parser.parse_args()
    timed(open_walk(20, seconds=1.0))
    people = [
        show("people", "people", n, timed(open_walk(n, seconds=SECONDS)))
        for n in PEOPLE
        if n <= given.most
    ]
    densities = [
        show("density", "per_m2", d, timed(open_walk(3_000, density=d, seconds=SECONDS)))
        for d in DENSITIES
    ]
    whole = MobilityMap.load(None)
    maps = [whole if every == 1 else thinned(whole, every) for every in KEEP_EVERY]
    options = []
    for map_ in maps:
        timed(open_walk(20, seconds=1.0), map_)
        mean = round(map_.n_options / map_.n_clusters)
        options.append(
            show("options", "mean", mean, timed(open_walk(3_000, seconds=SECONDS), map_))
        )
    threads = [
        show("threads", "threads", count, in_processes(1, given.most, threads=count))
        for count in CORES
    ]
    processes = [
        show("processes", "at once", count, in_processes(count, 3_000, threads=1))
        for count in CORES
    ]
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        held = pool.map(memory, [given.most])
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        most = pool.map(largest, [given.largest])
    parts = {
        "people": people,
        "density": densities,
        "options": options,
        "threads": threads,
        "processes": processes,
        "memory": held,
        "largest": most,
    }
    print(json.dumps(parts))
    if given.out is not None:
        give(given.out, "scaling", tables(parts))
        give(given.out, "memory", memory_table(held[0]))
        give(given.out, "largest", largest_table(most[0]))
        draw(parts, given.out / "scaling.png")


def tables(parts: dict[str, list[dict[str, Any]]]) -> str:
    """Microseconds a person-second against people, density and options."""
    columns = (
        ("people", "people", "people, at 0.5 per m2"),
        ("density", "per_m2", "people per m2"),
        ("options", "mean", "options per cluster, on average"),
    )
    told = [f"One run each. {machine()}"]
    for part, key, label in columns:
        heads = [f"{run[key]:,}" for run in parts[part]]
        costs = [f"{run['us_per_person_s']:.1f}" for run in parts[part]]
        told.append(table((label, *heads), [("microseconds of CPU per person-second", *costs)]))
    return "\n\n".join(told)


def memory_table(held: dict[str, Any]) -> str:
    """Memory of the process and of a person."""
    rows = [
        ("Python, the libraries and the map", f"{held['before'] / 1e6:.0f} MB"),
        ("a person, resident", f"{held['bytes_per_person'] / 1e3:.2f} kB"),
        ("- record and agenda of a person", f"{held['record']} + {held['agenda']} bytes"),
    ]
    people = f"{held['people']:,}"
    return f"With {people} people who have walked for a second.\n\n{table(('what', 'size'), rows)}"


def largest_table(run: dict[str, Any]) -> str:
    """Time and memory of the largest crowd."""
    rows = [
        ("set up, s", f"{run['set_up_s']:.0f}"),
        ("microseconds of CPU per person-second", f"{run['us_per_person_s']:.1f}"),
        ("seconds by the clock per simulated second", f"{run['wall_s_per_s']:.0f}"),
        ("peak memory, GB", f"{run['peak_bytes'] / 1e9:.1f}"),
    ]
    told = f"{run['people']:,} people"
    return f"{machine()}\n\n{table((told, ''), rows)}"


def draw(parts: dict[str, list[dict[str, Any]]], picture: Path) -> None:
    """The same as a picture."""
    figure = Figure(figsize=(12, 3.6), layout="constrained")
    columns = (("people", "people", "people"), ("density", "per_m2", "persons/m2"))
    for axes, (part, key, label) in zip(
        figure.subplots(1, 3, sharey=True),
        (*columns, ("options", "mean", "options per cluster (mean)")),
        strict=True,
    ):
        axes.plot(
            [run[key] for run in parts[part]], [run["us_per_person_s"] for run in parts[part]], "o-"
        )
        axes.set_xlabel(label)
        axes.grid(alpha=0.3)
    first = figure.axes[0]
    first.set_xscale("log")
    first.set_ylabel("microseconds of CPU a person-second")
    first.set_ylim(bottom=0.0)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main()
