"""A model with fields and agents of its own."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from crowd_extras.people import Patient
from crowd_extras.target_choice import SeeTheDoctor
from crowd_extras.terms import KeepAway
from mesa_mobility import Exit, FloorPlan, PedestrianModel, Range


class Clinic(PedestrianModel):
    """People leave a waiting room, the infected by the doctor's door.

    Args:
        pedestrians: how many.
        infected: share of them who are infected at first.
        keep_away: weight of the term by which the others keep away.
        preset: rules by which they move.
        mobility_map: a map, or None for the one that ships.
        record: keep every frame.
        rng: seed or NumPy generator.
    """

    def __init__(
        self,
        pedestrians: Annotated[int, Range(2, 60)] = 30,
        infected: Annotated[float, Range(0.0, 1.0)] = 0.2,
        keep_away: Annotated[float, Range(0.0, 5.0)] = 2.0,
        preset: str = "default",
        mobility_map: str | None = None,
        record: bool = False,
        rng: int | np.random.Generator | None = None,
    ) -> None:
        plan = FloorPlan(
            "POLYGON ((0 0, 12 0, 12 8, 0 8, 0 0))",
            exits=[Exit("street", (12, 3.4), (12, 4.6)), Exit("doctor", (0, 3.4), (0, 4.6))],
            name="clinic",
        )
        super().__init__(
            plan,
            preset=preset,
            mobility_map=mobility_map,
            target_choice=SeeTheDoctor(),
            pedestrian_class=Patient,
            fields={"infected": bool},
            record=record,
            rng=rng,
        )
        self.terms.append(KeepAway(weight=keep_away))
        places = plan.random_points(pedestrians, self.rng, spacing=0.8, clearance=0.4)
        ill = np.arange(pedestrians) < round(infected * pedestrians)
        self.add_pedestrians(places, fields={"infected": ill})
