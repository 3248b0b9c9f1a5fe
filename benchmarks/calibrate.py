"""How well the numbers of the default preset, and other numbers, fit the measurements.

python benchmarks/calibrate.py calibration.jsonl [--seeds 2] [--jobs 2] [--minutes 9] [--out FOLDER]

Changes each number by itself to a smaller and a larger value (``GRID``), runs bottlenecks, a
corridor and a counterflow with it, and appends one JSON line for each setting and seed; goes on
where the file ends. Then it prints, or writes as a block for docs/calibration.md, each figure and
the objective: the mean square of (figure - middle) / half the width of what was measured.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from pages.blocks import give, table

from mesa_mobility import MobilityMap, PedestrianType
from mesa_mobility.commands.console import progress_bar
from mesa_mobility.crowd import PRESETS
from mesa_mobility.mobility.map_data import CORE_RADIUS
from mesa_mobility.plugins.registry import load_behavior
from mesa_mobility.results.files import json_text
from mesa_mobility.runs.jobs import Failed, run_jobs
from mesa_mobility.runs.workers import Processes
from mesa_mobility.validation.bottleneck import DENSITY_IN_FRONT, bottleneck
from mesa_mobility.validation.corridor import RECORDED
from mesa_mobility.verification.references import (
    BOTTLENECK_TOLERANCE,
    bottleneck_fit,
    corridor_band,
)
from mesa_mobility.verification.scenarios.counterflow import counterflow
from mesa_mobility.verification.scenarios.tracks.track import track

_TERMS = PRESETS["default"].terms
_CONSTANTS = {
    "headway": ("distance", "time", "width"),
    "right_of_way": ("width", "bias", "ahead", "beside"),
    "stepping": ("length",),
}

DEFAULT: dict[str, float] = {
    **{f"weight of {name}": weight for name, weight in _TERMS.items() if name != "target_distance"},
    **{
        f"{name}: {constant}": getattr(load_behavior(name)(), constant)
        for name, constants in _CONSTANTS.items()
        for constant in constants
    },
    "core radius": CORE_RADIUS,
}
"""The numbers of the default preset. The weight of target_distance is the unit."""

GRID: dict[str, tuple[float, float]] = {
    **{name: (0.5 * value, 1.5 * value) for name, value in DEFAULT.items()},
    "headway: distance": (0.28, 0.38),
    "core radius": (0.12, 0.16),
}
"""The smaller and the larger value that each is changed to."""

WIDTHS = (0.9, 1.2, 2.0)
DENSITIES = (0.5, 2.1)
IN_FRONT_OF = 1.0


def settings() -> list[dict[str, float]]:
    """The default first, then one change at a time."""
    return [{}, *({name: value} for name, pair in GRID.items() for value in pair)]


def rules(changes: dict[str, float]) -> dict[str, Any]:
    """The model's arguments for these numbers."""
    of = DEFAULT | changes
    terms = [
        load_behavior(name)(
            weight=of.get(f"weight of {name}", _TERMS[name]),
            **{each: of[f"{name}: {each}"] for each in _CONSTANTS.get(name, ())},
        )
        for name in _TERMS
    ]
    adults = PedestrianType(mobility_map=MobilityMap.load(), core_radius=of["core radius"])
    return {"behaviors": terms, "pedestrian_types": [adults]}


def measure(setting: tuple[dict[str, float], int]) -> dict[str, float]:
    """The figures of one setting with a seed; nan where people got stuck."""
    changes, seed = setting
    figures: dict[str, Any] = {}
    for width in (*WIDTHS, IN_FRONT_OF):
        run = bottleneck(seed, width=width, **rules(changes))
        if width == IN_FRONT_OF:
            figures[f"density before {width:g} m"] = run["density_in_front"]
        else:
            figures[f"flow {width:g} m"] = run["flow_per_s"]
    for density in DENSITIES:
        # The corridor's people walk alone as fast as those it was measured with.
        run = track(seed, density=density, width=1.8, speed=RECORDED, **rules(changes))
        here = np.abs(run["density"] - density) < 0.125
        figures[f"speed at {density:g}/m2"] = float(np.median(run["along"][here]))
    run = counterflow(seed, opposing=100, **rules(changes))
    figures["through the counterflow"] = float(run["pedestrians"] - run["left_inside"])
    return {
        name: float("nan") if value is None else float(value) for name, value in figures.items()
    }


def wanted() -> dict[str, tuple[float, float]]:
    """Middle and half the width of the measured range."""
    middle, half = np.mean(DENSITY_IN_FRONT), np.ptp(DENSITY_IN_FRONT) / 2
    bands = {f"flow {w:g} m": (bottleneck_fit(w), BOTTLENECK_TOLERANCE) for w in WIDTHS}
    bands[f"density before {IN_FRONT_OF:g} m"] = (float(middle), float(half))
    for density in DENSITIES:
        low, _, high = corridor_band(density)
        bands[f"speed at {density:g}/m2"] = (float(low + high) / 2, float(high - low) / 2)
    return bands


def main() -> None:
    """Run the settings without results yet, then print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path, help="one JSON line a setting and seed")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--minutes", type=float, default=9.0, help="begin no run after this")
    parser.add_argument("--out", type=Path, help="folder for the block")
    parser.add_argument("--no-progress", action="store_true", help="no progress on standard error")
    given = parser.parse_args()
    lines = given.file.read_text(encoding="utf-8").splitlines() if given.file.exists() else []
    done = {
        (json_text(row["changes"]), row["seed"]): row["figures"] for row in map(json.loads, lines)
    }
    asked = [(each, seed) for each in settings() for seed in range(1, given.seeds + 1)]
    missing = [(each, seed) for each, seed in asked if (json_text(each), seed) not in done]
    until = time.monotonic() + 60.0 * given.minutes

    def in_time() -> Iterator[tuple[dict[str, float], int]]:
        for setting in missing:
            if time.monotonic() > until:
                return
            yield setting

    with (
        given.file.open("a", encoding="utf-8") as file,
        progress_bar(shown=not given.no_progress) as told,
    ):
        told("runs", len(done), len(asked))
        for (each, seed), figures in run_jobs(measure, in_time(), Processes(given.jobs)):
            if isinstance(figures, Failed):
                raise SystemExit(f"{json_text(each)}, seed {seed}: {figures.error}")
            row = {"changes": each, "seed": seed, "figures": figures}
            file.write(json_text(row) + "\n")
            file.flush()
            done[json_text(each), seed] = figures
            told("runs", len(done), len(asked))
    report(done, given.seeds, given.out)


def report(
    done: dict[tuple[str, int], dict[str, float]], seeds: int, out: Path | None = None
) -> None:
    """One line for each setting: medians over its seeds, and the objective."""
    bands = wanted()
    names = [*bands, "through the counterflow"]
    lines: list[list[str]] = [
        ["measured", "", *(f"{m:.2f} ± {h:.2f}" for m, h in bands.values()), "200", ""]
    ]
    for each in settings():
        rows = [
            done[json_text(each), seed]
            for seed in range(1, seeds + 1)
            if (json_text(each), seed) in done
        ]
        if not rows:
            continue
        medians = {name: float(np.median([_number(row[name]) for row in rows])) for name in names}
        off = [((medians[name] - middle) / half) ** 2 for name, (middle, half) in bands.items()]
        ((name, value),) = each.items() or [("default preset", None)]
        shown = "" if value is None else f"{value:.3g}"
        cells = [f"{medians[n]:.3g}" for n in names]
        lines.append([name, shown, *cells, f"{np.mean(off):.2f}"])
    text = table(("number", "value", *names, "objective"), lines)
    give(out, "sensitivity", f"Medians over seeds 1 to {seeds}.\n\n{text}")


def _number(value: float | None) -> float:
    return float("nan") if value is None else value


if __name__ == "__main__":
    main()
