"""How far replays of measured runs are off after some seconds, beside two other predictions.

python -m benchmarks.default_preset.predictions TRACKS [--preset default] [--every 5] [--seeds 3]

A replay begins at an instant of a measured run, with the places and velocities that people had
then.  The error is the distance between where a person is in the replay and where they were
measured.  The others begin at the same places: constant velocity, and JuPedSim's collision-free
speed model.  Both models have the same preferred speeds: the fastest that each person had walked by
then, though at least that of the slowest fortieth of people.
"""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.default_preset import measured
from mesa_mobility import PedestrianModel, Trajectories
from mesa_mobility.crowd import model_rules
from mesa_mobility.crowd.insertion.measured import Measured
from mesa_mobility.crowd.insertion.measured import measured as smoothed
from mesa_mobility.distributions import Distribution, parse

FloatArray = NDArray[np.float64]

AFTER_S = (1.5, 3.0, 4.8)
"""Seconds after the instant."""
SLOWEST = 1.0 / 40.0
"""Share of people who prefer less than the least speed that anybody is given."""
RADIUS_M = 0.137
"""Of bodies in JuPedSim: half the distance that replays leave between people."""


def known(track: Measured, frame: int, column: FloatArray) -> dict[int, FloatArray]:
    """A row of a column of tracks by number of each person who was measured in a frame."""
    rows = np.flatnonzero(track.frame == frame)
    return dict(zip(track.person[rows].tolist(), column[rows], strict=True))


def ours(model: PedestrianModel, people: dict[int, int]) -> dict[float, dict[int, FloatArray]]:
    """(x, y) by number of the person, after each of ``AFTER_S``; run the model for it."""
    found: dict[float, dict[int, FloatArray]] = {}
    for seconds in AFTER_S:
        model.run(max_seconds=seconds)
        places = np.column_stack([model.crowd.x, model.crowd.y])
        found[seconds] = {person: places[row] for person, row in people.items()}
    return found


def jupedsim(
    model: PedestrianModel, track: Measured, people: dict[int, int]
) -> dict[float, dict[int, FloatArray]]:
    """The same by JuPedSim, from where a model has its people now."""
    import jupedsim as jps

    plan = model.floor_plan
    simulation = jps.Simulation(
        model=jps.CollisionFreeSpeedModelV2(), geometry=plan.walkable, dt=0.01
    )
    stages = []
    for each in plan.exits:
        strip = each.line.buffer(0.2, cap_style="flat")
        stages.append(simulation.add_exit_stage(strip.intersection(plan.walkable)))
    journeys = [simulation.add_journey(jps.JourneyDescription([stage])) for stage in stages]
    persons = np.array(list(people))
    agents: dict[int, int] = {}
    places: dict[int, FloatArray] = {}
    for person, way in zip(persons.tolist(), track.exits(persons, plan), strict=True):
        row = people[person]
        place = (float(model.crowd.x[row]), float(model.crowd.y[row]))
        agents[person] = simulation.add_agent(
            jps.CollisionFreeSpeedModelV2AgentParameters(
                position=place,
                desired_speed=float(model.crowd.preferred[row]),
                radius=RADIUS_M,
                journey_id=journeys[way],
                stage_id=stages[way],
            )
        )
        places[agents[person]] = np.array(place)
    found: dict[float, dict[int, FloatArray]] = {}
    for seconds in AFTER_S:
        while simulation.elapsed_time() < seconds - 1e-9:
            simulation.iterate()
            places |= {each.id: np.array(each.position) for each in simulation.agents()}
        found[seconds] = {person: places[agent] for person, agent in agents.items()}
    return found


def instants(run: measured.MeasuredRun, every: float) -> Iterator[int]:
    """Frames of a run every so many seconds, all followed by as much as is predicted."""
    first, last = run.window
    step = round(every * run.rate)
    yield from range(first, last - round(AFTER_S[-1] * run.rate), step)


def preferred(track: Measured, frame: int, speeds: Distribution) -> FloatArray:
    """(m,) preferred speeds by number of the person, from what was measured up to a frame, m/s."""
    rows = np.flatnonzero(track.frame <= frame)
    found = np.full(track.person.max() + 1, speeds.quantile(np.array([SLOWEST]))[0])
    np.maximum.at(found, track.person[rows], np.hypot(*track.velocity[rows].T))
    return found


def errors(name: str, tracks: Trajectories, every: float, seed: int) -> dict[str, FloatArray]:
    """(n, len(AFTER_S)) metres by prediction: replay, constant velocity, JuPedSim."""
    run = measured.RUNS[name]
    found: dict[str, list[list[float]]] = {"constant velocity": [], "JuPedSim": [], "replay": []}
    track = smoothed(tracks, run.plan())
    for frame in instants(run, every):
        model = PedestrianModel(run.plan(), rng=[seed, frame])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            speeds = preferred(track, frame, parse(run.speeds))
            made = model.replay(tracks, frame, preferred_speeds=speeds)
        people = made.row_of()
        now, velocity = known(track, frame, track.places), known(track, frame, track.velocity)
        later = {s: known(track, frame + round(s * run.rate), track.places) for s in AFTER_S}
        predicted = {
            "constant velocity": {s: {p: now[p] + velocity[p] * s for p in now} for s in AFTER_S},
            "JuPedSim": jupedsim(model, track, people),
            "replay": ours(model, people),
        }
        for person in people:
            if all(person in places for places in later.values()):
                for what, by in predicted.items():
                    found[what].append(
                        [float(np.hypot(*(by[s][person] - later[s][person]))) for s in AFTER_S]
                    )
    return {what: np.array(rows) for what, rows in found.items()}


def main() -> None:
    """Print a table for each run."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tracks", type=Path)
    parser.add_argument("--runs", nargs="+", choices=tuple(measured.RUNS), default=[*measured.RUNS])
    parser.add_argument("--preset", default="default")
    parser.add_argument("--every", type=float, default=5.0, help="seconds between instants")
    parser.add_argument("--seeds", type=int, default=3)
    given = parser.parse_args()
    preset = Path(given.preset) if given.preset.endswith(".toml") else given.preset
    print("| run | prediction | " + " | ".join(f"{s:g} s" for s in AFTER_S) + " | people |")
    print("|---" * (len(AFTER_S) + 3) + "|")
    for name in given.runs:
        tracks = measured.read(str(given.tracks / measured.RUNS[name].file), name)
        with model_rules(preset):
            tries = [errors(name, tracks, given.every, seed) for seed in range(given.seeds)]
        for what in tries[0]:
            rows = np.concatenate([each[what] for each in tries])
            means = " | ".join(f"{mean:.2f}" for mean in rows.mean(axis=0))
            print(f"| {name} | {what} | {means} | {len(rows)} |")


if __name__ == "__main__":
    main()
