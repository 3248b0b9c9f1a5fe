"""A target choice by a field of people."""

from __future__ import annotations

import numpy as np

from mesa_mobility import Deciding, TargetChoice, Targets


class SeeTheDoctor(TargetChoice):
    """The infected leave by the exit "doctor", all others by the nearest exit that they may use.

    Everybody leaves as usual where the plan has no such exit, or the model no field ``infected``.
    """

    name = "see_the_doctor"

    def targets(self, deciding: Deciding) -> Targets:
        """Targets on the routes to these exits."""
        site, to = deciding.site, deciding.destinations.copy()
        fields = deciding.inside.fields
        if "infected" in fields and "doctor" in [each.name for each in site.plan.exits]:
            infected = fields["infected"][deciding.inside.places(deciding.pedestrians)]
            for kind in np.unique(deciding.types):
                to[infected & (deciding.types == kind)] = site.destination(("doctor",), int(kind))
        return site.targets(deciding.positions, to)
