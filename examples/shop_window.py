"""A shop window in an arcade: the more attractive it is, the more of those who pass stop."""

from mesa_mobility.behaviors import Attraction, Attractions
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.distributions import Uniform


class Arcade(PedestrianModel):
    """An arcade of 24 m by 6 m with a window in its lower wall."""

    def __init__(self, share, rng=None):
        plan = FloorPlan(box(0, 0, 24, 6), exits=[Exit("east", (24, 0), (24, 6))])
        super().__init__(plan, rng=rng)
        self.window = Attraction(box(10, 0.3, 15, 1.8), stay=Uniform(2, 4), share=share)
        self.attractions = Attractions([self.window])
        self.add_tactic(self.attractions)
        self.add_pedestrians([(1 + 0.8 * i, 2 + 0.9 * k) for i in range(6) for k in range(4)])


def main():
    for share in (0.0, 0.5, 1.0):
        model = Arcade(share, rng=2)
        model.run(max_seconds=120)
        stopped = len(model.attractions.stopped(model.window))
        print(f"share {share}: {stopped} of 24 stop, all are out after {model.elapsed:.0f} s")


if __name__ == "__main__":
    main()
