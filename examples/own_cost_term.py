"""A cost term of one's own: people in a corridor keep to the left.

A term sees the movement options of everybody who decides as flat arrays, and gives one cost each.
Options that lead to the right of the way to the target become dearer.
"""

import numpy as np

from mesa_mobility import CostTerm, Exit, FloorPlan, PedestrianModel, Trajectories


class KeepLeft(CostTerm):
    name = "keep_left"

    def cost(self, candidates):
        way = candidates.targets - candidates.positions
        way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-9)
        step = candidates.points - candidates.positions[candidates.owner]
        ahead = way[candidates.owner]
        return ahead[:, 1] * step[:, 0] - ahead[:, 0] * step[:, 1]  # metres to the right


class Corridor(PedestrianModel):
    """Counterflow in a corridor of 20 m x 4 m."""

    def __init__(self, left_bias=0.0, rng=None):
        plan = FloorPlan(
            "POLYGON ((0 0, 20 0, 20 4, 0 4, 0 0))",
            exits=[Exit("west", (0, 0), (0, 4)), Exit("east", (20, 0), (20, 4))],
        )
        super().__init__(plan, record=True, rng=rng)
        self.terms.append(KeepLeft(weight=left_bias))
        places = plan.random_points(16, self.rng, spacing=0.6, clearance=0.4)
        places = places[np.argsort(places[:, 0])]
        self.add_pedestrians(places[:8], exits=["east"])
        self.add_pedestrians(places[8:], exits=["west"])


def main():
    for bias in (0.0, 3.0):
        model = Corridor(left_bias=bias, rng=1)
        model.run(max_seconds=60)
        tracks = Trajectories.of(model)
        east = tracks.person < 8
        print(
            f"weight {bias}: eastbound at y = {tracks.y[east].mean():.2f} m, "
            f"westbound at y = {tracks.y[~east].mean():.2f} m"
        )


if __name__ == "__main__":
    main()
