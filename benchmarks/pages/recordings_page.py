"""How much recordings matter: the table and the picture of docs/how-to/recordings.md.

mesa-mobility map bootstrap RECORDINGS/manifest.tsv --maps 8 --out FOLDER/maps --seed 1
python benchmarks/pages/recordings_page.py FOLDER
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from blocks import give, table

from mesa_mobility import MobilityMap
from mesa_mobility.experiments import mean_interval, run_experiment, variance_components

sys.path.append(str(Path(__file__).parents[2] / "examples" / "experiments"))

import recordings

SOURCES = ("recordings", "people (their preferred speeds)", "chance (where they stand)")


def main() -> None:
    """Run what the store lacks, and write the block and the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="with maps/; for store, block and picture")
    parser.add_argument("--crowds", type=int, default=recordings.CROWDS, help="on each map")
    given = parser.parse_args()
    maps = sorted((given.folder / "maps").glob("*.npz"))
    asked = recordings.experiment(maps, given.crowds)
    store = run_experiment(asked, given.folder / f"store-{given.crowds}")
    parts = variance_components(store, "egress_s", ["mobility_map", "crowd"])
    frame = store.frame()
    recordings.draw(frame, parts, given.folder / "recordings.png")
    shares = [
        (name, f"{part.variance**0.5:.2f} s", f"{100 * part.share.value:.0f} %",
         f"{100 * part.share.low:.0f} to {100 * part.share.high:.0f} %")
        for name, part in zip(SOURCES, parts, strict=True)
    ]  # fmt: skip
    means = frame.groupby("mobility_map").egress_s.mean()
    by_map, by_run = mean_interval(means), mean_interval(frame.egress_s.dropna())
    options = [MobilityMap.load(each).n_options for each in maps]
    figures = [
        ("mean egress time", f"{by_map.value:.2f} s"),
        (
            "its 95 % interval, from the means of the maps",
            f"{by_map.low:.2f} to {by_map.high:.2f} s",
        ),
        (
            "its 95 % interval, had all runs been on one map",
            f"{by_run.low:.2f} to {by_run.high:.2f} s",
        ),
        ("means of single maps", f"{means.min():.1f} to {means.max():.1f} s"),
        ("options per map", f"{min(options):,} to {max(options):,}"),
    ]
    told = f"{len(maps)} maps, {given.crowds} crowds on each, {frame.egress_s.count()} runs."
    heads = ("source", "standard deviation", "share of the variance", "95 % interval")
    text = f"{told}\n\n{table(heads, shares)}\n\n{table(('figure', 'value'), figures)}"
    give(given.folder, "recordings", text)


if __name__ == "__main__":
    main()
