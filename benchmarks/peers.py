"""This package and JuPedSim on the same scenarios, side by side.

python benchmarks/peers.py room bottleneck open-1000 [--rounds 3] [--alone]
    [--out FOLDER]

Each run is a process of its own; the two take turns. Timed is the simulation alone:
compilation and setting up are printed apart. Seconds of processor time count all threads.
"""

from __future__ import annotations

import argparse
import json
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from pages.blocks import give, machine, table
from scenarios import SCENARIOS, Scenario, open_walk

LIMIT_S = 600.0
"""Simulated seconds after which a floor that is not empty is given up."""

TITLES = {
    "room": "room: 750 people, two 1.2 m doors, until empty",
    "bottleneck": "bottleneck: 150 people, one 1.0 m door, until empty",
    "open-1000": "open walk, 1,000 people, 0.5 per m2, 10 s",
    "open-10000": "open walk, 10,000 people",
}
"""Of scenarios, for the page."""

PEERS = ("mesa-mobility", "jupedsim")


def our_model(scenario: Scenario, mobility_map: Any = None) -> Any:
    """Our model of a scenario; all it needs is compiled, except what its first steps compile.

    The package is imported here, as the other's runs do without.
    """
    from mesa_mobility import Exit, FloorPlan, Gate, PedestrianModel
    from mesa_mobility.crowd.precompile import compile_the_rest

    # Code that free walkers do not need. A jam would compile it while it is timed.
    compile_the_rest()
    plan = FloorPlan(
        scenario.floor,
        exits=[Exit(name, *line) for name, (line, _) in scenario.exits.items()],
        gates=[Gate(name, *line) for name, line in scenario.doors.items()],
    )
    model = PedestrianModel(plan, mobility_map=mobility_map, rng=1)
    wanted = np.array([name or "" for name in scenario.exit_of])
    for name in np.unique(wanted):
        of = wanted == name
        model.add_pedestrians(
            scenario.places[of],
            preferred_speeds=scenario.speeds[of],
            exits=[str(name)] if name else None,
        )
    return model


def ours(scenario: Scenario) -> Callable[[], tuple[float, int]]:
    """Set up our model; the function returned runs it: person-seconds, people left inside."""
    model = our_model(scenario)

    def run() -> tuple[float, int]:
        model.run(max_seconds=scenario.seconds or LIMIT_S)
        return float(model.crowd.active_frames.sum()) / 30.0, model.inside

    return run


def jupedsim(scenario: Scenario, dt: float = 0.01) -> Callable[[], tuple[float, int]]:
    """Set up JuPedSim with its collision-free speed model V2, the like."""
    import jupedsim as jps

    simulation = jps.Simulation(
        model=jps.CollisionFreeSpeedModelV2(), geometry=scenario.floor, dt=dt
    )
    stages = {name: simulation.add_exit_stage(area) for name, (_, area) in scenario.exits.items()}
    journeys = {
        name: simulation.add_journey(jps.JourneyDescription([stage]))
        for name, stage in stages.items()
    }
    middle = {name: np.mean(line, axis=0) for name, (line, _) in scenario.exits.items()}
    for place, speed, name in zip(scenario.places, scenario.speeds, scenario.exit_of, strict=True):
        goal = name or min(middle, key=lambda n: float(np.hypot(*(middle[n] - place))))
        simulation.add_agent(
            jps.CollisionFreeSpeedModelV2AgentParameters(
                position=tuple(place),
                desired_speed=speed,
                radius=0.15,
                journey_id=journeys[goal],
                stage_id=stages[goal],
            )
        )

    def run() -> tuple[float, int]:
        person_seconds = 0.0
        until = scenario.seconds or LIMIT_S
        while simulation.agent_count() and simulation.elapsed_time() < until - 1e-9:
            person_seconds += simulation.agent_count() * dt
            simulation.iterate()
        return person_seconds, simulation.agent_count()

    return run


def measure(peer: str, name: str) -> dict[str, Any]:
    """One run in this process."""
    prepare = ours if peer == PEERS[0] else jupedsim
    start = time.process_time()
    prepare(open_walk(20, seconds=2.0))()
    compiled = time.process_time() - start
    start = time.process_time()
    run = prepare(SCENARIOS[name]())
    set_up = time.process_time() - start
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    cpu, wall = time.process_time(), time.perf_counter()
    person_seconds, left = run()
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return {
        "peer": peer,
        "scenario": name,
        "cpu_s": cpu,
        "wall_s": wall,
        "person_s": person_seconds,
        "person_s_per_cpu_s": person_seconds / cpu,
        "left_inside": left,
        "warm_up_cpu_s": compiled,
        "set_up_cpu_s": set_up,
        "peak_mb": peak / 1024.0,
        "grown_mb": (peak - before) / 1024.0,
    }


def in_own_process(peer: str, name: str) -> dict[str, Any]:
    """One run in a process of its own."""
    command = [sys.executable, __file__, "--child", peer, name]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    return dict(json.loads(done.stdout.splitlines()[-1]))


def main() -> None:
    """Run all, print a table and one JSON line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenarios", nargs="*", default=["room", "bottleneck", "open-1000"])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--alone", action="store_true", help="this package only")
    parser.add_argument("--out", type=Path, help="folder for a block, with JuPedSim beside")
    parser.add_argument("--child", choices=PEERS, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.child:
        print(json.dumps(measure(given.child, given.scenarios[0])))
        return
    peers = PEERS[:1] if given.alone else PEERS
    print("| scenario | simulator | CPU s | wall s | person-s per CPU s | peak MB | ratio |")
    print("|---" * 7 + "|")
    results = []
    for name in given.scenarios:
        runs = [[in_own_process(peer, name) for peer in peers] for _ in range(given.rounds)]
        ratios = [turn[-1]["cpu_s"] / turn[0]["cpu_s"] for turn in runs]
        rates = [turn[0]["person_s_per_cpu_s"] / turn[-1]["person_s_per_cpu_s"] for turn in runs]
        for k, peer in enumerate(peers):
            of = {
                key: statistics.median(turn[k][key] for turn in runs)
                for key in ("cpu_s", "wall_s", "person_s_per_cpu_s", "peak_mb")
            }
            ratio = "" if k else f"{statistics.median(ratios):.1f} x CPU s"
            print(
                f"| {name} | {peer} | {of['cpu_s']:.2f} | {of['wall_s']:.2f} "
                f"| {of['person_s_per_cpu_s']:,.0f} | {of['peak_mb']:.0f} | {ratio} |",
                flush=True,
            )
        results.append({"scenario": name, "ratio_cpu": ratios, "ratio_rate": rates, "runs": runs})
    print(json.dumps({"results": results}))
    if given.out is not None and not given.alone:
        give(given.out, "peers", side_by_side(results))


def side_by_side(results: list[dict[str, Any]]) -> str:
    """Processor time of both, and person-seconds simulated in a second of it."""
    rows = []
    for each in results:
        cpu, rate = (
            [statistics.median(turn[k][key] for turn in each["runs"]) for k in range(len(PEERS))]
            for key in ("cpu_s", "person_s_per_cpu_s")
        )
        rows.append(
            (
                TITLES.get(each["scenario"], each["scenario"]),
                f"{cpu[0]:.2f}",
                f"{cpu[1]:.3g}",
                f"{statistics.median(each['ratio_cpu']):.1f}",
                f"{rate[0]:,.0f}",
                f"{rate[1]:,.0f}",
            )
        )
    heads = (
        "scenario",
        "CPU s here",
        "CPU s JuPedSim",
        "ratio",
        "person-seconds per CPU-second here",
        "JuPedSim",
    )
    rounds = len(results[0]["runs"])
    told = f"Medians of {rounds} rounds; JuPedSim {version('jupedsim')}. {machine()}"
    return f"{told}\n\n{table(heads, rows)}"


if __name__ == "__main__":
    main()
