"""The table of a set of runs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from statistics import fmean

from benchmarks.conflicts.resuming import Row

WRONG = (
    "lost", "doubled", "stood", "overlaps", "wall_crossings", "floor_crossings", "off_floor",
    "jumps", "on_steps", "closed_crossed", "late",
)  # fmt: skip
"""Figures that are to be 0."""

THROUGH = ("wall_crossings", "closed_crossed", "floor_crossings")
"""Figures whose sum is shown as walls."""

FIGURES = ("flow_per_s", "ratio")
"""Figures of single scenes, of which the mean is shown."""


def print_table(rows: Sequence[Row]) -> bool:
    """Print a line for each scenario, and the seeds that failed; whether anything was wrong."""
    print(
        "| scenario | runs | people | left inside | in runs | lost | stood | in runs "
        "| overlaps | walls | off floor | doubled | jumps | late | stalled, s | out, mean s "
        "| last s | other |"
    )
    print("|---" * 18 + "|")
    bad = list[str]()
    for name in dict.fromkeys(row["scenario"] for row in rows):
        mine = [row for row in rows if row["scenario"] == name]
        bad += [f"{name} seed {row['seed']}: {why}" for row in mine if (why := wrong_with(row))]
        good = [row for row in mine if "error" not in row]
        out = [row["out_s"] for row in good if row.get("out_s") is not None]
        other = [
            f"{key} {fmean(found):.3g}"
            for key in FIGURES
            if (found := [row[key] for row in good if row.get(key) is not None])
        ]
        cells = [
            name, len(mine), _sum(good, "people"), _sum(good, "left_inside"),
            sum(row["left_inside"] > 0 for row in good), _sum(good, "lost"), _sum(good, "stood"),
            sum(row["stood"] > 0 for row in good), _sum(good, "overlaps"),
            sum(_sum(good, each) for each in THROUGH), _sum(good, "off_floor"),
            _sum(good, "doubled"), _sum(good, "jumps"), _sum(good, "late"),
            round(_sum(good, "stalled_frames") / 30),
            f"{fmean(out):.0f}" if out else "-", f"{max(out):.0f}" if out else "-",
            ", ".join(other),
        ]  # fmt: skip
        print("| " + " | ".join(map(str, cells)) + " |")
    for line in bad:
        print(line)
    return bool(bad)


def wrong_with(row: Row) -> str:
    """What was wrong in a run, in a few words; empty if nothing was."""
    if "error" in row:
        return str(row["error"])
    found = [f"{key} {row[key]}" for key in WRONG if row.get(key)]
    if row.get("too_long"):
        found.append(str(row["too_long"]))
    return ", ".join(found)


def _sum(rows: Iterable[Row], key: str) -> int:
    return sum(row.get(key, 0) for row in rows)
