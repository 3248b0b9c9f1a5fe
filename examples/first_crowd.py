"""A first crowd: forty people leave a room by one door."""

from mesa_mobility import Exit, FloorPlan, PedestrianModel


class Room(PedestrianModel):
    """A room of 10 m x 8 m with a door and a table in the way.

    Args:
        pedestrians: how many people are inside at the start.
        rng: seed or NumPy generator.
    """

    def __init__(self, pedestrians=40, rng=None):
        plan = FloorPlan(
            "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))",
            exits=[Exit("door", (10, 3.5), (10, 4.5))],
            obstacles=["POLYGON ((6 3, 7 3, 7 5, 6 5, 6 3))"],
            name="room",
        )
        super().__init__(plan, record=True, rng=rng)
        self.add_pedestrians(plan.random_points(pedestrians, self.rng, spacing=0.5, clearance=0.3))


def main():
    model = Room(rng=42)
    model.run(max_seconds=120)
    summary = model.summary()
    print(f"{summary['pedestrians']} people are out after {summary['egress_s']:.1f} s")
    print(model.datacollector.get_model_vars_dataframe()[["elapsed", "inside"]].iloc[::50])


if __name__ == "__main__":
    main()
