"""How much of the spread of egress times comes from the recordings behind a map.

    mesa-mobility map bootstrap RECORDINGS --maps 8 --out maps --seed 1
    python recordings.py maps store picture.png

runs a crowd on each map. Each map has crowds of its own, and each crowd runs several times: the
map stands for the recordings, the crowd for the people, and the rest is chance.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.experiments import (
    Experiment,
    Table,
    mean_interval,
    run_experiment,
    variance_components,
)

CROWDS, REPLICATIONS = 10, 5
PLAN = "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))"


class Hall(PedestrianModel):
    """A hall with a door; who the people are depends on the crowd, where they stand on the seed."""

    def __init__(self, crowd=0, pedestrians=40, door_width=1.2, mobility_map=None, rng=None):
        low, high = 4 - door_width / 2, 4 + door_width / 2
        plan = FloorPlan(PLAN, exits=[Exit("door", (10, low), (10, high))])
        super().__init__(plan, mobility_map=mobility_map, rng=rng)
        speeds = self.pedestrian_types[0].draw_speeds(pedestrians, np.random.default_rng(crowd))
        places = plan.random_points(pedestrians, self.rng, spacing=0.5, clearance=0.3)
        self.add_pedestrians(places, preferred_speeds=speeds)


def experiment(maps, crowds=CROWDS, replications=REPLICATIONS):
    """Crowds are nested in maps: none walks on two of them."""
    points = [
        {"mobility_map": str(file.resolve()), "crowd": 1000 * number + crowd}
        for number, file in enumerate(sorted(maps), start=1)
        for crowd in range(crowds)
    ]
    return Experiment(
        f"{Path(__file__).resolve()}:Hall",
        Table(points),
        replications,
        seed=1,
        max_seconds=300,
        time_limit=120,
        name="Recordings, people, chance",
    )


def draw(frame, parts, path):
    """Egress time of each crowd by map, and the shares of the variance."""
    figure = Figure(figsize=(9.0, 3.6), dpi=120, layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=[1.6, 1.0])
    for number, (_, of) in enumerate(frame.groupby("mobility_map"), start=1):
        means = of.groupby("crowd").egress_s.mean()
        left.plot([number] * len(of), of.egress_s, ".", color="#bbbbbb", markersize=3)
        left.plot([number] * len(means), means, "_", color="#2166ac", markersize=9)
        left.plot(number, means.mean(), "D", color="#d6604d", markersize=6)
    left.set(xlabel="map (clips drawn with replacement)", ylabel="egress time (s)")
    left.set_title("runs (grey), means of crowds (blue), of maps (red)", fontsize=9)
    names = ["recordings", "people", "chance"]
    shares = np.array([[p.share.value, p.share.low, p.share.high] for p in parts])
    errors = np.abs(shares[:, 1:] - shares[:, :1]).T
    right.bar(names, shares[:, 0], yerr=errors, color="#92c5de", ecolor="#333333", capsize=4)
    right.set(ylabel="share of the variance, 95 % interval", ylim=(0, 1))
    figure.savefig(path)


def main(folder, place, picture=None, **keywords):
    store = run_experiment(experiment(Path(folder).glob("*.npz"), **keywords), place)
    parts = variance_components(store, "egress_s", ["mobility_map", "crowd"])
    frame = store.frame()
    # Maps are what is independent here: runs and crowds of one map share its recordings.
    mean = mean_interval(frame.groupby("mobility_map").egress_s.mean())
    print(
        f"mean egress time {mean.value:.2f} s (95 %: {mean.low:.2f} to {mean.high:.2f}), "
        f"{store.status()['done']} runs"
    )
    for name, part in zip(["recordings", "people", "chance"], parts, strict=True):
        share = part.share
        print(
            f"{name}: standard deviation {part.variance**0.5:.2f} s, share {share.value:.0%} "
            f"({share.low:.0%} to {share.high:.0%})"
        )
    if picture is not None:
        draw(frame, parts, picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
