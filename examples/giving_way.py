"""Five people meet three in a corridor 0.55 m wide: they pass at a niche, or some go back."""

from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan, PedestrianModel


class NarrowCorridor(PedestrianModel):
    """A corridor between two rooms, with a niche or without."""

    def __init__(self, niche=True, rng=None):
        parts = [box(0, 0, 8, 8), box(8, 3.725, 32, 4.275), box(32, 0, 40, 8)]
        if niche:
            parts.append(box(18, 4.275, 22, 5.275))
        exits = [Exit("west", (0, 1), (0, 7)), Exit("east", (40, 1), (40, 7))]
        super().__init__(FloorPlan(union_all(parts), exits=exits), rng=rng)
        self.add_pedestrians([(16 - 0.9 * k, 4) for k in range(5)], headings=0.0, exits=["east"])
        self.add_pedestrians([(24 + 0.9 * k, 4) for k in range(3)], headings=3.14, exits=["west"])


def main():
    for niche in (True, False):
        model = NarrowCorridor(niche, rng=10)
        [giving_way] = [each for each in model.tactics if each.name == "giving_way"]
        farthest, gave_way = 0.0, set()
        while model.inside and model.elapsed < 200.0:
            model.step()
            gave_way |= set(giving_way.making_way)
            back = [each.position[0] for each in model.agents if each.row >= 5]
            farthest = max([farthest, *back])
        print(
            f"{'with' if niche else 'without'} a niche: {len(gave_way)} gave way, went back as far "
            f"as x = {farthest:.1f} m, all out after {model.elapsed:.0f} s"
        )


if __name__ == "__main__":
    main()
