"""Calibrate the preset `default` on measured crowds, or on all but some of them.

python -m benchmarks.default_preset TRACKS STORE [--leave-out corridors] [--evaluations 320]
    [--preset default] [--spread 0.1] [--workers 2]

TRACKS is the folder with the files of ``measured.RUNS``.  STORE keeps all runs, the preset found
and a report; the same command goes on where it stopped.
"""

from __future__ import annotations

import argparse
import sys
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.default_preset import goals, measured, published
from mesa_mobility.calibration import Distance, Free, HeldOut, Search, Seeds, calibrate
from mesa_mobility.crowd.presets.shipped import preset_of
from mesa_mobility.errors import MobilityError

BOUNDS = {
    "facing_deviation.weight": (1.0, 12.0),
    "preferred_velocity.weight": (1.0, 12.0),
    "velocity_change.weight": (1.0, 15.0),
    "room_ahead.weight": (0.2, 10.0),
    "personal_space.weight": (0.2, 5.0),
    "headway.weight": (0.8, 15.0),
    "speed_ahead.weight": (2.0, 25.0),
    "right_of_way.weight": (0.5, 10.0),
    "velocity_change.walking": (0.2, 1.5),
    "velocity_change.softness": (0.05, 0.6),
    "personal_space.room": (0.1, 1.0),
    "headway.time": (0.3, 2.0),
    "headway.distance": (0.2, 0.5),
    "headway.width": (0.2, 0.7),
    "headway.beyond": (0.0, 1.0),
    "speed_ahead.width": (0.2, 0.7),
    "speed_ahead.range": (0.4, 3.0),
    "right_of_way.width": (0.25, 0.8),
    "course_choice.haste": (1.0, 20.0),
    "course_choice.width": (0.2, 0.6),
    "anticipation.wander": (0.02, 0.15),
}
"""The numbers that are free, and their ranges."""


def scenarios(
    folder: Path, left_out: str | None
) -> tuple[dict[str, Any], dict[str, Any], dict[str, list[Distance]]]:
    """Scenarios, what was measured, and distances, by name."""
    simulates: dict[str, Any] = {}
    data: dict[str, Any] = {}
    distances: dict[str, list[Distance]] = {}

    def add(name: str, scenario: Any, known: Any, distance: Any, weight: float) -> None:
        simulates[name], data[name] = scenario, known
        distances[name] = [Distance(distance, weight, "off")]

    hidden = measured.FOLDS[left_out] if left_out else ()
    for name, run in measured.RUNS.items():
        path = str((folder / run.file).absolute())
        known: Any = partial(measured.read, path, name)
        add(
            name,
            partial(measured.replay, name=name, path=path),
            HeldOut(known) if name in hidden else known,
            partial(measured.distance, name=name),
            1.0,
        )
    for width in published.NECKS:
        add(
            f"neck {width:g} m",
            partial(published.neck, width=width),
            published.of_necks(width),
            published.far,
            1.0 / len(published.NECKS),
        )
    add("alone", published.alone, published.ALONE, published.far_alone, 1.0)
    for people in published.IN_LINE:
        add(
            f"{people} in line",
            partial(published.in_line, people=people),
            published.published_in_line,
            published.far_at_density,
            1.0 / len(published.IN_LINE),
        )
    for density in published.CROWDED:
        add(
            f"{density:g} persons a square metre",
            partial(published.crowded, density=density),
            published.published_crowded,
            published.far_at_density,
            1.0 / len(published.CROWDED),
        )
    for name, wanted in goals.GOALS.items():
        add(name, getattr(goals, name), list(wanted), goals.outside, 2.0 / len(goals.GOALS))
    return simulates, data, distances


def main() -> int:
    """Calibrate, and print where the preset and the report are."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tracks", type=Path)
    parser.add_argument("store", type=Path)
    parser.add_argument("--leave-out", choices=sorted(measured.FOLDS), help="runs not to see")
    parser.add_argument("--evaluations", type=int, default=320, help="sets of numbers to try")
    parser.add_argument("--preset", default="default", help="where the search starts")
    parser.add_argument("--spread", type=float, default=0.1, help="of the first sets")
    parser.add_argument("--seeds", type=int, default=5, help="that judge what was found")
    parser.add_argument("--workers", type=int, default=None)
    given = parser.parse_args()
    try:
        simulates, data, distances = scenarios(given.tracks, given.leave_out)
        found = calibrate(
            simulates,
            data,
            free=[Free(name, *bounds, log=bounds[0] > 0.0) for name, bounds in BOUNDS.items()],
            distances=distances,
            store=given.store,
            seeds=Seeds(held_out=given.seeds),
            search=Search(
                given.evaluations,
                candidates=16,
                spread=given.spread,
                preset=preset_of(given.preset),
            ),
            workers=given.workers,
        )
    except MobilityError as error:
        print(error, file=sys.stderr)
        return 2
    print(found.frame().to_string(index=False))
    return 0


if __name__ == "__main__":
    sys.exit(main())
