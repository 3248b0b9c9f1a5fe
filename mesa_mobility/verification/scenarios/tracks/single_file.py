"""People one behind the other on a narrow oval (RiMEA test 16).

The experiment measured people who walk in line. A narrow track alone does not ensure that: in a
neck as wide, and 5 m long, flow is twice that of single file (RiMEA test 12d), since people walk
staggered. An additional cost term keeps the people of this scenario in line.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mesa_mobility import CompiledTerm, Option, Options, option_kernel
from mesa_mobility.verification.cases import case
from mesa_mobility.verification.runs import Run
from mesa_mobility.verification.scenarios.tracks.oval import Oval, oval_model

OVAL = Oval(straight=4.0, radius=3.0, width=0.8)
SPEED = 1.2
SETTLE_S = 68.0
"""Three laps of 26.85 m at the preferred speed take 67 s."""
MEASURE_S, WINDOW_S, EVERY_S = 60.0, 0.4, 1.0
PEOPLE = (6, 10, 14, 19, 23, 28, 33, 38, 43, 48)


@option_kernel
def _off_line(option: Option, p: InLine) -> float:
    beside = max(abs(option.x) - p.half_straight, 0.0)
    return abs(math.sqrt(beside * beside + option.y * option.y) - p.radius)


@option_kernel
def _off_line_bound(options: Options, p: InLine) -> float:
    beside = max(abs(options.x) - p.half_straight, 0.0)
    off = abs(math.sqrt(beside * beside + options.y * options.y) - p.radius)
    return max(off - options.radius, 0.0)


class InLine(CompiledTerm):
    """Metres from the mobility point to the centre line of an oval.

    The weight is high enough that nobody leaves the line to walk beside others: with 20 a
    metre, people in a jam keep as close to it as free walkers (0.05 to 0.07 m, root mean
    square, against 0.06), with 10 they are 0.09 m off and with 5 0.13.
    """

    name = "in_line"
    default_weight = 20.0
    kernel = _off_line
    bound = _off_line_bound

    def __init__(self, oval: Oval, weight: float | None = None) -> None:
        super().__init__(weight)
        self.half_straight = oval.straight / 2
        self.radius = oval.radius


def single_file(seed: int, *, people: int) -> dict[str, Any]:
    """People walk round a track 0.8 m wide in single file.

    Args:
        seed: of the run.
        people: how many.

    Returns:
        The common figures; ``density`` (k,) persons per metre, 2 / (gap in front + gap
        behind), and ``along`` (k,) speeds over 0.4 s, m/s, of people on the straights.
    """
    model = oval_model(OVAL, people, seed, speed=SPEED, spacing=0.34, clearance=0.18)
    model.terms.append(InLine(OVAL))
    while model.elapsed < SETTLE_S + MEASURE_S + WINDOW_S:
        model.step()
    run = Run(model, model.floor_plan.walls)
    tracks = run.trajectories
    offsets = tracks.frame_offsets
    densities, speeds = [], []
    for time in np.arange(SETTLE_S, SETTLE_S + MEASURE_S, EVERY_S):
        along, straight = [], []
        for at in (time, time + WINDOW_S / 2, time + WINDOW_S):
            frame = round(at * tracks.frame_rate)
            rows = slice(offsets[frame], offsets[frame + 1])
            places = np.column_stack([tracks.x[rows], tracks.y[rows]])
            along.append(OVAL.unroll(places)[0])
            straight.append(np.abs(places[:, 0]) <= OVAL.straight / 2)
        gone = np.mod(along[2] - along[0] + OVAL.length / 2, OVAL.length) - OVAL.length / 2
        order = np.argsort(along[1], kind="stable")
        ahead = np.mod(np.roll(along[1][order], -1) - along[1][order], OVAL.length)
        density = np.empty(people)
        density[order] = 2.0 / (ahead + np.roll(ahead, 1))
        densities.append(density[straight[1]])
        speeds.append(gone[straight[1]] / WINDOW_S)
    return {
        **run.figures(),
        "density": np.concatenate(densities),
        "along": np.concatenate(speeds),
    }


CASES = tuple(case(single_file, effort=1.0 + 0.05 * people, people=people) for people in PEOPLE)
