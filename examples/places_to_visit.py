"""Places to visit: people look at shelves, pay at a till, and leave."""

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Visit
from mesa_mobility.distributions import Uniform


class Shop(PedestrianModel):
    """A shop of 12 m x 8 m with two rows of shelves, a till and a door."""

    def __init__(self, rng=None):
        plan = FloorPlan(
            "POLYGON ((0 0, 12 0, 12 8, 0 8, 0 0))",
            exits=[Exit("door", (0, 1), (0, 2.5))],
            obstacles=[
                "POLYGON ((4 2.5, 10 2.5, 10 3, 4 3, 4 2.5))",
                "POLYGON ((4 5, 10 5, 10 5.5, 4 5.5, 4 5))",
            ],
        )
        super().__init__(plan, rng=rng)
        aisle = Visit("POLYGON ((5 3.4, 9 3.4, 9 4.6, 5 4.6, 5 3.4))", stay=Uniform(20, 40))
        till = Visit((2.0, 4.0), stay=10.0)
        self.add_pedestrians([(1, 3), (1, 4), (2, 1), (2, 2)], route=[aisle, till])


def main():
    model = Shop(rng=5)
    people = list(model.agents)
    while model.inside:
        model.step()
        for person in [each for each in people if each not in model.agents]:
            print(f"customer {person.row} is out after {model.elapsed:.0f} s")
            people.remove(person)


if __name__ == "__main__":
    main()
