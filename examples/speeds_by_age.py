"""Several types of people: students, and older people who are slower and keep more room."""

from statistics import mean

from mesa_mobility import Exit, FloorPlan, MobilityMap, PedestrianModel, PedestrianType
from mesa_mobility.distributions import Normal
from mesa_mobility.populations import walking_speed

STUDENTS, OLDER = 0, 1


class MixedCrowd(PedestrianModel):
    def __init__(self, rng=None):
        plan = FloorPlan(
            "POLYGON ((0 0, 25 0, 25 10, 0 10, 0 0))",
            exits=[Exit("door", (25, 4), (25, 6))],
        )
        able_bodied = MobilityMap.load()
        types = [
            PedestrianType(
                name="student",
                mobility_map=able_bodied,
                preferred_speed=Normal(1.55, 0.18, 1.0, 1.85),
            ),
            PedestrianType(name="older", mobility_map=able_bodied, core_radius=0.18),
        ]
        super().__init__(plan, pedestrian_types=types, record=True, rng=rng)
        places = plan.random_points(40, self.rng, spacing=0.6, clearance=0.4)
        self.students = self.add_pedestrians(places[:25], type_index=STUDENTS)
        # Weidmann's curve: mean and spread of the walking speed at an age.
        ages = self.rng.uniform(65, 80, 15)
        self.older = self.add_pedestrians(
            places[25:], type_index=OLDER, preferred_speeds=walking_speed(ages, self.rng)
        )


def main():
    model = MixedCrowd(rng=5)
    for people in (model.students, model.older):
        speed = mean(each.preferred_speed for each in people)
        print(f"{len(people)} of type {people[0].pedestrian_type.name} like {speed:.2f} m/s")
    model.run(max_seconds=120)
    print(f"all out after {model.summary()['egress_s']:.1f} s")


if __name__ == "__main__":
    main()
