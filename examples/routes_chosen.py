"""Routes chosen: the shorter of two corridors, or the one that is quicker."""

from mesa_mobility.behaviors import CongestionRouting, NearestExit
from shapely import box

from mesa_mobility import Exit, FloorPlan, Gate, PedestrianModel, Trajectories
from mesa_mobility.results import crossings


class Halls(PedestrianModel):
    """Two halls with two corridors between them; the exit is nearer to the lower one."""

    def __init__(self, target_choice, rng=None):
        plan = FloorPlan(
            box(0, 0, 20, 8) - box(6, 1.2, 14, 6.8),
            exits=[Exit("east", (20, 1), (20, 4))],
            gates=[Gate("lower", (10, 0), (10, 1.2)), Gate("upper", (10, 6.8), (10, 8))],
        )
        super().__init__(plan, target_choice=target_choice, record=True, rng=rng)
        self.add_pedestrians([(0.5 + 0.65 * i, 0.6 + 0.65 * k) for i in range(8) for k in range(5)])


def main():
    for name, choice in (("shortest", NearestExit()), ("quickest", CongestionRouting())):
        model = Halls(choice, rng=5)
        model.run(max_seconds=180)
        tracks = Trajectories.of(model)
        lower, upper = (
            len(set(crossings(tracks, gate.a, gate.b).person)) for gate in model.floor_plan.gates
        )
        print(
            f"{name}: {lower} by the lower corridor, {upper} by the upper one, "
            f"all out after {model.summary()['egress_s']:.1f} s"
        )


if __name__ == "__main__":
    main()
