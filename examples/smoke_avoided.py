"""Smoke that spreads from a corridor: people who do not heed it, and people who go round it."""

from mesa_mobility.behaviors import Hazard, Hazards, NearestExit
from shapely import Point, box

from mesa_mobility import Exit, FloorPlan, PedestrianModel


class Halls(PedestrianModel):
    """Two halls with two corridors between them; a fire breaks out in the lower one."""

    def __init__(self, target_choice, rng=None):
        plan = FloorPlan(
            box(0, 0, 20, 8) - box(6, 2, 14, 6), exits=[Exit("east", (20, 0), (20, 2))]
        )
        super().__init__(plan, target_choice=target_choice, rng=rng)
        self.add_pedestrians([(0.6 + 0.6 * i, 0.6 + 0.7 * k) for i in range(4) for k in range(10)])


def main():
    smoke = Hazard((10.0, 0.5), speed=0.1)
    for name, choice in (("unaware", NearestExit()), ("aware", Hazards([smoke]))):
        model = Halls(choice, rng=5)
        exposed = set()
        while model.inside and model.elapsed < 120.0:
            model.step()
            area = smoke.at(model.elapsed)
            exposed |= {each.row for each in model.agents if area.covers(Point(each.position))}
        print(f"{name}: {len(exposed)} of 40 walked through, out after {model.elapsed:.0f} s")


if __name__ == "__main__":
    main()
