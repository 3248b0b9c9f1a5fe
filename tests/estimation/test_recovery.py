"""Crowds drawn from a logit of known weights, with head sway and hidden poses."""

from dataclasses import replace

import numpy as np
import pytest

from mesa_mobility import CostTerm, Exit, FloorPlan, PedestrianModel, Trajectories
from mesa_mobility.estimation import Sampling, estimate, observe
from tests.fixtures.engine import ENGINE

WEIGHTS = {
    "facing_deviation": 4.0,
    "preferred_velocity": 5.0,
    "velocity_change": 6.0,
    "sideways": 8.0,
    "headway": 2.0,
    "right_of_way": 1.5,
}
NOT_SEEN = ("facing_deviation", "sideways")
"""Head tracks do not show them: they are given."""

PEOPLE, SECONDS, CROWDS = 40, 12, 20

SWAY, STRIDES, ERROR = 0.025, 0.95, 0.005
"""Metres to the side, strides a second, and metres of measurement error."""


class Drawn(CostTerm):
    """Errors of Gumbel: whoever takes the cheapest option then draws from a logit."""

    name = "drawn"

    def cost(self, candidates):
        return -candidates.rng.gumbel(size=len(candidates))


RULES = replace(
    ENGINE,
    name="logit",
    terms=WEIGHTS,
    durations=(24,),
    shares=((0.75, 0.5, 0.25, 0.0),),
    tactics=(),
    hard_bodies=False,
)


def crowd(seed: int) -> tuple[FloorPlan, Trajectories]:
    """Two streams that meet in a corridor, as a camera sees their heads."""
    plan = FloorPlan(
        "POLYGON ((0 0, 16 0, 16 4, 0 4, 0 0))",
        exits=[Exit("left", (0, 0), (0, 4)), Exit("right", (16, 0), (16, 4))],
    )
    model = PedestrianModel(
        plan, preset=RULES, behaviors=[*RULES.make_terms(), Drawn()], record=True, rng=seed
    )
    places = plan.random_points(PEOPLE, model.rng, spacing=0.5, clearance=0.3)
    model.add_pedestrians(places[: PEOPLE // 2], exits=["left"])
    model.add_pedestrians(places[PEOPLE // 2 :], exits=["right"])
    model.run(max_seconds=SECONDS)
    tracks, rng = Trajectories.of(model), np.random.default_rng(1000 + seed)
    phases = rng.uniform(0.0, 2.0 * np.pi, PEOPLE)[tracks.person]
    sway = SWAY * np.sin(2.0 * np.pi * STRIDES * tracks.frame / tracks.frame_rate + phases)
    errors = ERROR * rng.standard_normal((2, len(tracks)))
    return plan, replace(
        tracks,
        x=tracks.x - sway * np.sin(tracks.heading) + errors[0],
        y=tracks.y + sway * np.cos(tracks.heading) + errors[1],
    )


@pytest.mark.slow
def test_known_weights_are_found_again():
    names = [name for name in WEIGHTS if name not in NOT_SEEN]
    truth, off, covered = np.array([WEIGHTS[name] for name in names]), [], []
    for seed in range(CROWDS):
        plan, tracks = crowd(seed)
        choices = observe(
            plan, tracks, preset=RULES, tactics=(), sampling=Sampling(frames=(24,), interval=0.8)
        )
        found = estimate(RULES.make_terms(), choices, fixed=NOT_SEEN, tests=False)
        of = [found.terms.index(name) for name in names]
        off.append(np.abs(found.weights[of] - truth) / truth)
        low, high = found.intervals[of].T
        covered.append((low <= truth) & (truth <= high))

    assert np.median(off) < 0.25
    assert 0.85 <= np.mean(covered) <= 0.99
    # Hidden poses leave a bias, which must not grow.
    assert (np.median(off, axis=0) < 0.4).all()
