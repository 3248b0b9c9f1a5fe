"""Analysis with PedPy: flow and density at a bottleneck, from recorded trajectories."""

import logging

import pedpy

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Trajectories


class Bottleneck(PedestrianModel):
    """A room of 8 m x 8 m before a neck 1 m wide and 2 m long."""

    def __init__(self, pedestrians=60, rng=None):
        plan = FloorPlan(
            "POLYGON ((0 0, 8 0, 8 3.5, 10 3.5, 10 4.5, 8 4.5, 8 8, 0 8, 0 0))",
            exits=[Exit("end of the neck", (10, 3.5), (10, 4.5))],
        )
        super().__init__(plan, record=True, rng=rng)
        room = pedpy.MeasurementArea([(0, 0), (7, 0), (7, 8), (0, 8)]).polygon
        places = plan.random_points(
            pedestrians, self.rng, within=room, spacing=0.45, clearance=0.25
        )
        self.add_pedestrians(places)


# PedPy shows every library's messages; Mesa has one for each step.
logging.getLogger("MESA").setLevel(logging.WARNING)


def main():
    model = Bottleneck(rng=2)
    model.run(max_seconds=120)
    tracks = Trajectories.of(model).to_pedpy()

    line = pedpy.MeasurementLine([(8.2, 3.5), (8.2, 4.5)])
    nt, _ = pedpy.compute_n_t(traj_data=tracks, measurement_line=line)
    passed = nt[nt.cumulative_pedestrians.diff() > 0].time
    print(f"flow {(len(passed) - 1) / (passed.max() - passed.min()):.2f} persons/s")

    area = pedpy.MeasurementArea([(6.5, 3), (7.5, 3), (7.5, 5), (6.5, 5)])
    density = pedpy.compute_classic_density(traj_data=tracks, measurement_area=area)
    print(f"density before the neck: up to {density.density.max():.1f} persons/m2")


if __name__ == "__main__":
    main()
