"""A guide leads visitors round a wall, stops, and leaves with them by the far door."""

from mesa_mobility.behaviors import Following
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Visit


class Gallery(PedestrianModel):
    """Two rooms; visitors come in by the near door, and a guide leads to the far one."""

    def __init__(self, guided, rng=None):
        plan = FloorPlan(
            box(0, 0, 16, 8) - box(8, 0, 8.5, 5),
            exits=[Exit("near", (0, 1), (0, 3)), Exit("far", (16, 1), (16, 3))],
        )
        super().__init__(plan, rng=rng)
        stop = Visit((12.0, 4.0), stay=5.0)
        [guide] = self.add_pedestrians([(5, 4)], route=[stop], exits=["far"], preferred_speeds=1.0)
        visitors = self.add_pedestrians([(1 + 0.8 * i, 2 + k) for i in range(2) for k in range(5)])
        if guided:
            following = Following(distance=1.5)
            following.follow(visitors, guide)
            self.add_tactic(following)


def main():
    for guided in (False, True):
        model = Gallery(guided, rng=1)
        people = list(model.agents)
        model.run(max_seconds=120)
        far = sum(model.crowd.x[person.row] > 8.0 for person in people)
        name = "with the guide" if guided else "without her"
        print(f"{name}: {far} by the far door, out after {model.elapsed:.0f} s")


if __name__ == "__main__":
    main()
