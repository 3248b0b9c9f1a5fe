"""Batch runs: how long it takes to leave, against the width of the door, over several seeds."""

from collections import defaultdict
from statistics import mean, stdev

import mesa_mobility
from mesa_mobility import Exit, FloorPlan, PedestrianModel


class Room(PedestrianModel):
    def __init__(self, pedestrians=30, width=1.0, rng=None):
        plan = FloorPlan(
            "POLYGON ((0 0, 8 0, 8 8, 0 8, 0 0))",
            exits=[Exit("door", (8, 4 - width / 2), (8, 4 + width / 2))],
        )
        super().__init__(plan, rng=rng)
        self.add_pedestrians(plan.random_points(pedestrians, self.rng, spacing=0.5, clearance=0.3))


def main():
    rows = mesa_mobility.batch_run(
        Room,
        {"pedestrians": 30, "width": [0.8, 1.2, 2.0]},
        rng=range(4),
        max_steps=1200,
        display_progress=False,
    )
    times = defaultdict(list)
    for row in rows:
        times[row["width"]].append(row["elapsed"])
    for width, seconds in times.items():
        print(f"door of {width} m: {mean(seconds):.1f} s, sd {stdev(seconds):.1f} s over seeds")


if __name__ == "__main__":
    main()
