"""A speed rule of one's own: people slow down in smoke.

A speed rule says how fast those who decide would like to walk now. The smoke fills the left half
of a hall and thins out to the right.
"""

import numpy as np

from mesa_mobility import Exit, FloorPlan, PedestrianModel, SpeedRule


class SlowInSmoke(SpeedRule):
    """Preferred speeds fall with the optical density, to a floor of 0.3 m/s.

    Args:
        density: optical density per metre at x = 0; it falls to nothing at x = 15 m.
    """

    name = "slow_in_smoke"

    def __init__(self, density):
        self.density = density

    def speeds(self, deciding, speeds):
        smoke = self.density * np.clip(1.0 - deciding.positions[:, 0] / 15.0, 0.0, 1.0)
        return np.maximum(speeds * (1.0 - 0.34 * smoke), np.minimum(speeds, 0.3))


class Hall(PedestrianModel):
    def __init__(self, density=0.0, rng=None):
        plan = FloorPlan(
            "POLYGON ((0 0, 30 0, 30 8, 0 8, 0 0))",
            exits=[Exit("door", (30, 3), (30, 5))],
        )
        super().__init__(plan, rng=rng)
        self.speed_rules.append(SlowInSmoke(density))
        self.add_pedestrians([(x, y) for x in (1.0, 2.0, 3.0) for y in (2.0, 4.0, 6.0)])


def main():
    for density in (0.0, 1.0, 2.0):
        model = Hall(density, rng=3)
        model.run(max_seconds=300)
        print(f"optical density {density} /m: all out after {model.summary()['egress_s']:.1f} s")


if __name__ == "__main__":
    main()
