"""How likely single choices of measured people are, on the folds that an estimate has not seen.

python -m benchmarks.default_preset.likelihoods TRACKS [--most 1000]

TRACKS is the folder with the files of ``measured.RUNS``. Prints nats a choice and the energy score
of end points for three models: the terms of the preset `default` with weights estimated on the
other folds, the same terms with the preset's weights, and the terms and weights that were set by
hand before (decision record 31). The latter two have the common scale that fits the other folds
best. All see the same draw of options.
"""

from __future__ import annotations

import argparse
import dataclasses
from functools import reduce
from operator import add
from pathlib import Path

from benchmarks.default_preset import measured
from benchmarks.pages.blocks import table
from mesa_mobility.crowd.presets.shipped import preset_of
from mesa_mobility.estimation import Sampling, leave_out, observe

EARLIER = {
    "target_distance": 0.6,
    "facing_deviation": 1.25,
    "preferred_velocity": 2.75,
    "velocity_change": 1.3,
    "sideways": 2.2,
    "room_ahead": 2.0,
    "interference": 1.0,
    "headway": 2.6,
    "right_of_way": 1.2,
    "stepping": 1.3,
}
"""The weights that were set by hand."""


def main() -> None:
    """Observe, estimate and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tracks", type=Path)
    parser.add_argument("--most", type=int, default=1000, help="choices of each run")
    given = parser.parse_args()
    default = preset_of("default")
    by_hand = dataclasses.replace(default, name="by hand", terms=EARLIER, settings={})
    folds = {run: fold for fold, runs in measured.FOLDS.items() for run in runs}
    observations = []
    for name, run in measured.RUNS.items():
        looked = observe(
            run.plan(),
            measured.read(str(given.tracks / run.file), name),
            name=name,
            fold=folds[name],
            sampling=Sampling(most=given.most),
        )
        print(f"{name}: {looked.coverage}", flush=True)
        observations.append(looked)
    everything = reduce(add, observations)
    ours = leave_out(default.make_terms(), everything)
    earlier = leave_out(by_hand.make_terms(), everything)
    rows = [
        [
            each.fold,
            *(
                f"{model.nats:.2f} ({model.energy:.3f})"
                for model in (each.measures, each.given, before.given)
            ),
        ]
        for each, before in zip(ours, earlier, strict=True)
    ]
    print("\nNats a choice (energy score in metres) on the fold left out:\n")
    print(table(["fold", "estimated", "default, scaled", "set by hand, scaled"], rows))


if __name__ == "__main__":
    main()
