"""Tables and picture of docs/explanation/stairs.md: our stairs beside published ones.

python benchmarks/pages/stairs_tables.py --seeds 5 --out FOLDER
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from blocks import give, table
from matplotlib.figure import Figure
from numpy.typing import NDArray
from stairs_scenes import ENDS, RISER, TREAD, WIDTH, counted, merging, of_one_type, office, stream

from mesa_mobility import PedestrianType
from mesa_mobility.populations import presets
from mesa_mobility.verification import catalogue, suite
from mesa_mobility.verification.report import measured_text
from mesa_mobility.verification.scenarios.buildings.stairs import lone_climber
from mesa_mobility.verification.suite import verify

FREE_SPEED = 1.34
"""Of people on a level floor, m/s."""

STAIRS = ((0.17, 0.29), (0.18, 0.28), (0.15, 0.33))
"""Riser and tread, metres."""

DENSITIES = (0.3, 0.6, 1.0, 1.5, 2.0, math.inf)
"""In the corridor before the stair, persons/m2; the last is a crowd in a room."""

TYPE_SEEDS = 2
"""Seeds for each type at most."""

EDGES = np.arange(0.0, 4.51, 0.5)
"""Of bins of density, persons/m2."""

LEAST = 20
"""Half-seconds that a bin needs to be shown."""

IMO = {False: (1.0, 0.55, 1.1), True: (0.8, 0.44, 0.88)}
"""Down and up: free speed and speed at the maximum flow, m/s along the slope, and this flow in
persons/(s m) of clear width (MSC.1/Circ.1533)."""

FREE_DENSITY = 0.54
"""Persons/m2 up to which people walk freely in the SFPE Handbook."""

SFPE_FLOW = 1.01
"""Greatest flow in the SFPE Handbook, persons/s for a metre of the width less 0.15 m a side."""

CORBETTA = {
    False: ((0.33, -1.02, 1.39), (0.0, -0.08, 0.67)),
    True: ((0.18, -0.55, 1.02), (0.0, 0.01, 0.48)),
}
"""Down and up: fast and slow edge of measured speeds, m/s, as polynomials of the density."""

MEASURED_TO = 1.5
"""Persons/m2: the polynomials rise beyond."""

WAYS = {False: "down", True: "up"}


def main() -> None:
    """Run all, and write the tables and the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5, help="seeds 1 to this")
    parser.add_argument("--out", type=Path, required=True, help="folder for blocks and picture")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    seeds = range(1, given.seeds + 1)
    streams = [
        stream(seed, up=up, density=density)
        for up in WAYS
        for density in DENSITIES
        for seed in seeds
    ]
    merged = [merging(seed, beside=beside) for beside in (False, True) for seed in seeds]
    offices = [office(seed, phased=phased) for phased in (False, True) for seed in seeds]
    runs = [*streams, *merged, *offices]
    told = f"Seeds 1 to {given.seeds}. {counted(runs)}"
    give(given.out, "stairs-free", free_speeds())
    give(given.out, "stairs-flow", f"{told}\n\n{flows(streams)}")
    give(given.out, "stairs-types", by_type(min(given.seeds, TYPE_SEEDS)))
    give(given.out, "stairs-merging", shares(merged))
    give(given.out, "stairs-phases", phases(offices))
    give(given.out, "stairs-documented", documented())
    draw(streams, given.out / "stairs.png")


def free_speeds() -> str:
    """A person alone on stairs, down and up."""
    rows = []
    for riser, tread in STAIRS:
        risers = round(5.0 / tread)
        found = [
            lone_climber(1, up=up, risers=risers, riser=riser, tread=tread, preferred=FREE_SPEED)
            for up in WAYS
        ]
        rows.append(
            (
                f"{100 * riser:.0f} / {100 * tread:.0f} cm",
                *(f"{each['speed_mps']:.2f}" for each in found),
                f"{0.85 * sfpe(riser, tread):.2f}",
                *(f"{IMO[up][0]:.2f}" for up in WAYS),
            )
        )
    heads = ("riser / tread", "down", "up", "SFPE", "IMO, down", "IMO, up")
    return (
        f"Metres a second along the slope, of a person who walks {FREE_SPEED} m/s on a level floor."
        f"\n\n{table(heads, rows)}"
    )


def sfpe(riser: float, tread: float) -> float:
    """The factor k of the SFPE Handbook, m/s: the speed along the slope is k (1 - 0.266 D)."""
    return 0.861 * math.sqrt(tread / riser)


def sfpe_speed(density: NDArray[np.float64]) -> NDArray[np.float64]:
    """Speed along the slope, m/s, at densities in persons/m2, on the stair of this page."""
    speed: NDArray[np.float64] = sfpe(RISER, TREAD) * (
        1.0 - 0.266 * np.maximum(density, FREE_DENSITY)
    )
    return speed


def flows(streams: Sequence[dict[str, Any]]) -> str:
    """The flow out of a room over a stair, and speeds by density."""
    rows = []
    for up, name in WAYS.items():
        own = [run for run in streams if run["up"] is up and run["flow"] is not None]
        measured = np.array([run["flow"] for run in own]) / WIDTH
        rows.append(
            (
                name,
                f"{measured.mean():.2f} ({measured.min():.2f} to {measured.max():.2f})",
                f"{IMO[up][2]:.2f}",
                f"{SFPE_FLOW * (WIDTH - 0.3) / WIDTH:.2f}",
            )
        )
    heads = ("", "persons/(s m) of clear width", "IMO, most", "SFPE, most")
    by_density = []
    for low, high in pairwise(EDGES):
        cells = [in_bin(streams, up, low, high) for up in WAYS]
        if any(len(each) >= LEAST for each in cells):
            reference = sfpe_speed(np.array([(low + high) / 2]))[0]
            by_density.append(
                (f"{low:g} to {high:g}", *map(spread, cells), f"{max(reference, 0.0):.2f}")
            )
    return (
        f"{table(heads, rows)}\n\nSpeed along the slope, m/s: median (10th to 90th percentile) of "
        f"half-seconds, {ENDS:g} m or more from the ends of the flight.\n\n"
        f"{table(('persons/m2', 'down', 'up', 'SFPE'), by_density)}"
    )


def in_bin(
    streams: Sequence[dict[str, Any]], up: bool, low: float, high: float
) -> NDArray[np.float64]:
    """(k,) speeds of the half-seconds with a density from `low` to `high`, in one direction."""
    own = [run for run in streams if run["up"] is up]
    density = np.concatenate([run["densities"] for run in own])
    speed = np.concatenate([run["speeds"] for run in own])
    return speed[(density > low) & (density <= high)]


def spread(speeds: NDArray[np.float64]) -> str:
    """Median and percentiles as a cell."""
    if len(speeds) < LEAST:
        return "-"
    low, middle, high = np.percentile(speeds, (10, 50, 90))
    return f"{middle:.2f} ({low:.2f} to {high:.2f})"


def by_type(seeds: int) -> str:
    """Speeds alone and flows of each type that uses stairs."""
    kinds = [kind for kind in presets()["every_type"].names if PedestrianType.named(kind).climbs]
    rows, runs = [], []
    for kind in kinds:
        found = {
            up: [of_one_type(seed, kind, up=up) for seed in range(1, seeds + 1)] for up in WAYS
        }
        runs += [run for each in found.values() for run in each]
        mean = {
            (up, name): float(np.mean([run[name] for run in each]))
            for up, each in found.items()
            for name in ("level_mps", "free_mps", "flow")
        }
        rows.append(
            (
                kind,
                f"{mean[False, 'level_mps']:.2f}",
                *(f"{mean[up, 'free_mps']:.2f}" for up in WAYS),
                *(f"{mean[up, 'flow'] / WIDTH:.2f}" for up in WAYS),
            )
        )
    heads = ("type", "level, m/s", "down, m/s", "up, m/s", "flow down", "flow up")
    return f"Seeds 1 to {seeds}. {counted(runs)}\n\n{table(heads, rows)}"


def shares(merged: Sequence[dict[str, Any]]) -> str:
    """The share of people from the stair and from the floor at a landing."""
    rows = []
    for beside, place, reference in (
        (False, "opposite to the foot", "about 50 %"),
        (True, "beside the foot", "about 40 %"),
    ):
        own = [run for run in merged if run["beside"] is beside]
        share = 100.0 * np.array([run["share"] for run in own])
        flow = np.array([run["flow"] for run in own])
        rows.append(
            (
                place,
                f"{share.mean():.0f} % ({share.min():.0f} to {share.max():.0f})",
                reference,
                f"{flow.mean():.2f}",
            )
        )
    heads = ("door of the floor", "from the stair", "measured", "persons/s down")
    return f"Means over seeds (least to greatest).\n\n{table(heads, rows)}"


def phases(offices: Sequence[dict[str, Any]]) -> str:
    """When each storey is empty."""
    rows = []
    for phased, name in ((False, "at once"), (True, "top storey first")):
        own = [run for run in offices if run["phased"] is phased]
        clear = np.mean([run["clear"] for run in own], axis=0)
        on_stairs = np.mean([run["on_stairs_s"] for run in own])
        rows.append((name, *(f"{each:.0f}" for each in clear), f"{on_stairs:.1f}"))
    storeys = len(offices[0]["clear"])
    heads = [f"level {storeys - 1 - k} empty, s" for k in range(storeys)]
    return f"Means over seeds.\n\n{table(['', *heads, 'on a stair, s'], rows)}"


def documented() -> str:
    """The RiMEA tests of several storeys with seed 1."""
    entries = catalogue()
    rows = [
        (name, entries[name].what, measured_text(outcome), outcome.verdict)
        for name, outcome in verify(suite(["rimea-08", "rimea-14"]), [1], 1).items()
    ]
    return table(("test", "what", "simulated, seed 1", "verdict"), rows)


def draw(streams: Sequence[dict[str, Any]], picture: Path) -> None:
    """Speed against density, down and up, beside the references."""
    figure = Figure(figsize=(9.6, 3.8), dpi=120, layout="constrained")
    for axes, (up, name) in zip(figure.subplots(1, 2, sharey=True), WAYS.items(), strict=True):
        at = np.linspace(0.0, MEASURED_TO, 50)
        fast, slow = (np.polyval(each, at) for each in CORBETTA[up])
        axes.fill_between(at, slow, fast, color="#dddddd", label="measured (Corbetta)")
        density = np.linspace(0.0, 3.7, 100)
        axes.plot(density, sfpe_speed(density), color="#555555", label="SFPE")
        free, slowed, most = IMO[up]
        axes.plot([FREE_DENSITY, most / slowed], [free, slowed], "^", color="#d6604d", label="IMO")
        for low, high in pairwise(EDGES):
            speeds = in_bin(streams, up, low, high)
            if len(speeds) >= LEAST:
                p10, p50, p90 = np.percentile(speeds, (10, 50, 90))
                axes.errorbar(
                    (low + high) / 2,
                    p50,
                    yerr=[[p50 - p10], [p90 - p50]],
                    fmt="o",
                    color="#2166ac",
                    capsize=3,
                    label="simulated" if low == EDGES[0] else None,
                )
        axes.set(title=name, xlabel="persons/m2", xlim=(0.0, EDGES[-1]), ylim=(0.0, 1.5))
        axes.grid(alpha=0.3)
        axes.legend(frameon=False, fontsize=8)
    figure.axes[0].set_ylabel("speed along the slope, m/s")
    figure.savefig(picture, metadata={"Software": None})


if __name__ == "__main__":
    main()
