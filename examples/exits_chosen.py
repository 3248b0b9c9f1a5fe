"""Exits chosen: by distance, by walk and queue, and by familiarity."""

from mesa_mobility.behaviors import FamiliarExit, NearestExit, QuickestExit

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Trajectories
from mesa_mobility.results import crossings


class Hall(PedestrianModel):
    """A hall with a narrow exit near the crowd and a wide one farther away."""

    def __init__(self, target_choice, rng=None):
        plan = FloorPlan(
            "POLYGON ((0 0, 16 0, 16 10, 0 10, 0 0))",
            exits=[Exit("near", (0, 4.6), (0, 5.4)), Exit("far", (16, 4), (16, 6))],
        )
        super().__init__(plan, target_choice=target_choice, record=True, rng=rng)
        self.add_pedestrians([(x, y) for x in range(2, 8) for y in range(1, 10)])


def main():
    choices = [
        ("nearest", NearestExit()),
        ("quickest", QuickestExit()),
        ("familiar with the far one", FamiliarExit(familiar=["far"])),
    ]
    for name, choice in choices:
        model = Hall(choice, rng=11)
        model.run(max_seconds=120)
        tracks = Trajectories.of(model)
        near, far = (len(crossings(tracks, each.a, each.b).time) for each in model.floor_plan.exits)
        print(
            f"{name}: {near} by the near exit, {far} by the far one, "
            f"all out after {model.summary()['egress_s']:.1f} s"
        )


if __name__ == "__main__":
    main()
