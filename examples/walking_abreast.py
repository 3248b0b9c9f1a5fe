"""Couples and threes on a promenade: they walk side by side, and slower than those alone."""

import numpy as np
from mesa_mobility.behaviors import WalkingAbreast
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel


class Promenade(PedestrianModel):
    """A way of 40 m by 8 m; people of one walking speed set off in groups of 1, 2 and 3."""

    def __init__(self, rng=None):
        plan = FloorPlan(box(0, 0, 40, 8), exits=[Exit("east", (40, 0), (40, 8))])
        super().__init__(plan, rng=rng)
        self.add_tactic(WalkingAbreast())
        self.people = {
            "alone": self.add_pedestrians([(1, 1)], preferred_speeds=1.22),
            "a pair": self.add_pedestrians([(1, 3), (2, 3)], preferred_speeds=1.22, group="pair"),
            "a three": self.add_pedestrians(
                [(1, 5), (2, 6), (1, 7)], preferred_speeds=1.22, group="three"
            ),
        }


def main():
    model = Promenade(rng=1)
    model.run(max_seconds=15)
    before = {name: np.array([p.position for p in who]) for name, who in model.people.items()}
    model.run(max_seconds=25)
    for name, who in model.people.items():
        places = np.array([p.position for p in who])
        speed = (places - before[name])[:, 0].mean() / 10.0
        apart = np.hypot(*np.diff(places[places[:, 1].argsort()], axis=0).T)
        text = f", {apart.mean():.2f} m apart" if len(who) > 1 else ""
        print(f"{name}: {speed:.2f} m/s{text}")


if __name__ == "__main__":
    main()
