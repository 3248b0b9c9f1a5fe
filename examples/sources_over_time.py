"""Sources over time: a trickle at one door, a train's worth of people at another."""

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Source
from mesa_mobility.distributions import LogNormal


class Concourse(PedestrianModel):
    """A concourse of 20 m x 10 m with a street door; people come from two sides."""

    def __init__(self, rng=None):
        plan = FloorPlan(
            "POLYGON ((0 0, 20 0, 20 10, 0 10, 0 0))",
            exits=[Exit("street", (20, 4), (20, 6))],
        )
        super().__init__(plan, rng=rng)
        # Half a person a second, at random times, for forty seconds.
        self.add_source(Source(area="POLYGON ((0 7, 2 7, 2 10, 0 10, 0 7))", rate=0.5, until=40))
        # A train arrives after 15 s: thirty people within ten seconds; some of them dawdle.
        self.add_source(
            Source(
                area="POLYGON ((0 0, 3 0, 3 4, 0 4, 0 0))",
                times=[15 + k / 3 for k in range(30)],
                pre_movement=LogNormal(1.0, 0.5, 0, 20),
            )
        )


def main():
    model = Concourse(rng=7)
    model.run(max_seconds=180)
    trickle, train = (inflow.entered for inflow in model.sources)
    print(f"{trickle} people trickled in, {train} came by train")
    for seconds, inside in model.statistics.occupancy[::10]:
        print(f"{seconds:5.0f} s {inside:4d} inside")


if __name__ == "__main__":
    main()
