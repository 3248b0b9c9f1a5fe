"""A ticket hall: people line up before two counters and then go to the platform."""

from mesa_mobility.behaviors import Counter, Queueing
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.distributions import Uniform


class TicketHall(PedestrianModel):
    """A hall of 14 m by 8 m with counters along its upper wall."""

    def __init__(self, rng=None):
        plan = FloorPlan(box(0, 0, 14, 8), exits=[Exit("platform", (14, 3), (14, 6))])
        super().__init__(plan, rng=rng)
        self.counters = [
            Counter([(x, 7.3), (x, 1.0)], service=Uniform(3.0, 5.0)) for x in (5.0, 10.0)
        ]
        self.queueing = Queueing(self.counters)
        self.add_tactic(self.queueing)
        for counter, x in zip(self.counters, (2.0, 7.0), strict=True):
            places = [(x + 0.8 * k, 1.0) for k in range(4)]
            self.add_pedestrians(places, route=[counter.visit])


def main():
    model = TicketHall(rng=1)
    longest = 0
    while model.inside and model.elapsed < 120.0:
        model.step()
        longest = max(longest, *(len(model.queueing.line(each)) for each in model.counters))
    print(f"longest line: {longest} people; all are out after {model.elapsed:.0f} s")


if __name__ == "__main__":
    main()
