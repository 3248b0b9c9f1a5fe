"""What a few wheelchairs or slow walkers change: table and picture of explanation/mixed_ability.md.

python benchmarks/pages/mixed_ability.py FOLDER --seeds 10

Each run is kept as a line of FOLDER/rows.jsonl, from which an interrupted command goes on.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from blocks import give, table
from matplotlib.figure import Figure
from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Trajectories
from mesa_mobility.experiments import mean_interval
from mesa_mobility.populations import Population
from mesa_mobility.results import check_safety, crossings, flow

SHARES = (0.0, 0.05, 0.1, 0.2)
TYPES = {"wheelchair_manual": "manual wheelchairs", "slow": "slow walkers"}
PEOPLE, LIMIT_S = 60, 600.0
ROOM, BEHIND, SPACING = 12.0, 6.0, 0.85
"""Metres: the square room where people start, the floor behind the neck, and between people."""
NECKS = {"door": (1.0, 0.2), "corridor": (2.0, 10.0)}
"""Width and length, metres."""
CONFIDENCE = 0.9


def main() -> None:
    """Run what is missing; write the table and the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="for runs, table and picture")
    parser.add_argument("--seeds", type=int, default=10, help="seeds 1 to this")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    kept = given.folder / "rows.jsonl"
    rows = [json.loads(line) for line in kept.read_text().splitlines()] if kept.exists() else []
    done = {(row["neck"], row["type"], row["share"], row["seed"]) for row in rows}
    for seed in range(1, given.seeds + 1):
        for neck, kind, share in runs():
            if (neck, kind, share, seed) in done:
                continue
            rows.append(run(neck, kind, share, seed))
            with kept.open("a") as file:
                file.write(json.dumps(rows[-1]) + "\n")
    rows = [row for row in rows if row["seed"] <= given.seeds]
    draw(rows, given.folder / "mixed_ability.png")
    give(given.folder, "mixed-ability", results(rows, given.seeds))


def runs() -> list[tuple[str, str, float]]:
    """Neck, type and share of each configuration; nobody of either type counts for both."""
    return [
        (neck, kind if share else "", share)
        for neck in NECKS
        for kind in TYPES
        for share in SHARES
        if share or kind == next(iter(TYPES))
    ]


def run(neck: str, kind: str, share: float, seed: int) -> dict[str, Any]:
    """People leave a room through a neck; the share of one type is given."""
    width, length = NECKS[neck]
    low, high, end = (ROOM - width) / 2, (ROOM + width) / 2, ROOM + length
    floor = union_all(
        [
            box(0.0, 0.0, ROOM, ROOM),
            box(ROOM, low, end, high),
            box(end, 0.0, end + BEHIND, ROOM),
        ]
    )
    line = ((end + BEHIND, 0.0), (end + BEHIND, ROOM))
    plan = FloorPlan(floor, exits=[Exit("end", *line)])
    shares = {"able_bodied": 1.0 - share, kind: share} if kind else {"able_bodied": 1.0}
    model = PedestrianModel(plan, population=Population(shares), record=True, rng=seed)
    start = box(0.0, 0.0, ROOM - 2.0, ROOM)
    model.add_pedestrians(
        plan.random_points(PEOPLE, model.rng, within=start, spacing=SPACING, clearance=0.45)
    )
    model.run(max_seconds=LIMIT_S)
    trajectories = Trajectories.of(model)
    found = crossings(trajectories, (end, low), (end, high))
    _, first = np.unique(found.person, return_index=True)
    times = np.sort(found.time[first])
    safety = check_safety(trajectories, plan.walls, plan.free)
    return {
        "neck": neck,
        "type": kind,
        "share": share,
        "seed": seed,
        "flow": flow(times),
        "egress_s": float(times[-1]) if len(times) == PEOPLE else None,
        "inside": model.inside,
        "overlaps": safety.overlaps,
        "wall_crossings": safety.wall_crossings,
    }


def chosen(rows: list[dict[str, Any]], neck: str, kind: str, share: float) -> list[dict[str, Any]]:
    """The runs of one configuration."""
    wanted = (neck, kind if share else "", share)
    return [row for row in rows if (row["neck"], row["type"], row["share"]) == wanted]


def interval(rows: list[dict[str, Any]], figure: str) -> tuple[float, float, float]:
    """Mean of a figure over seeds, and its interval's ends; nan where a seed did not reach it."""
    found = mean_interval([np.inf if (v := row[figure]) is None else v for row in rows], CONFIDENCE)
    values = (found.value, found.low, found.high)
    return tuple(np.nan if each is None else each for each in values)  # type: ignore[return-value]


def results(rows: list[dict[str, Any]], seeds: int) -> str:
    """One line a configuration."""
    heads = ("through", "of", "share", "flow, persons/s", "last one through, s", "still inside")
    lines = []
    for neck, (width, length) in NECKS.items():
        for kind, name in TYPES.items():
            for share in SHARES:
                own = chosen(rows, neck, kind, share)
                flow_, low, high = interval(own, "flow")
                last, soon, late = interval(own, "egress_s")
                # Where some seed leaves people inside, the column beside it says so.
                time = "-" if np.isnan(last) else f"{last:.0f} ({soon:.0f} to {late:.0f})"
                lines.append(
                    (
                        f"{neck}, {width:g} m x {length:g} m",
                        name,
                        f"{100 * share:.0f} %",
                        f"{flow_:.2f} ({low:.2f} to {high:.2f})",
                        time,
                        f"{sum(row['inside'] for row in own)} of {PEOPLE * len(own)}",
                    )
                )
    overlaps, through = (sum(row[name] for row in rows) for name in ("overlaps", "wall_crossings"))
    return (
        f"Seeds 1 to {seeds}; means over seeds, with 90 % intervals of the mean.\n\n"
        f"{table(heads, lines)}\n\n"
        f"Overlaps {overlaps}, wall crossings {through}, in {len(rows)} runs."
    )


def draw(rows: list[dict[str, Any]], picture: Path) -> None:
    """Flow and time of the last one against the share."""
    figure = Figure(figsize=(9.6, 3.8), dpi=120, layout="constrained")
    figures = {"flow": "persons/s", "egress_s": "last one through, s"}
    for axes, (name, label) in zip(figure.subplots(1, 2), figures.items(), strict=True):
        for neck, style in zip(NECKS, ("-", "--"), strict=True):
            for (kind, words), colour in zip(TYPES.items(), ("#2166ac", "#d6604d"), strict=True):
                own = np.array(
                    [interval(chosen(rows, neck, kind, share), name) for share in SHARES]
                )
                axes.errorbar(
                    100 * np.array(SHARES),
                    own[:, 0],
                    yerr=np.abs(own[:, 1:] - own[:, :1]).T,
                    color=colour,
                    linestyle=style,
                    marker="o",
                    markersize=4,
                    capsize=3,
                    label=f"{words}, {neck}",
                )
        axes.set_xlabel("share, %")
        axes.set_ylabel(label)
        axes.set_ylim(bottom=0.0)
        axes.grid(alpha=0.3)
    axes.legend(frameon=False, fontsize=8)
    figure.savefig(picture, metadata={"Software": None})


if __name__ == "__main__":
    main()
