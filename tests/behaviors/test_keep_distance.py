"""People who keep 1.5 m apart."""

import numpy as np
import pytest
from mesa_mobility.behaviors import KeepDistance
from shapely import box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import wanderer
from tests.fixtures.options import Chooser, Ending, candidates
from tests.fixtures.scenes import model_of


def test_what_an_option_costs():
    # After 1 s the walker is at (2, 0) and the other, who walks 1 m/s to the left, at (3, 1).
    found = KeepDistance().cost(
        candidates(
            Chooser(
                [Ending((2.0, 0.0), 0.0, 2.0, 1.0), Ending((0.0, 0.0), 0.0, 0.0, 1.0)],
                target=(9.0, 0.0),
                neighbours=[((4.0, 1.0), (-1.0, 0.0)), ((0.0, 0.5), (0.0, 0.0))],
            )
        )
    )
    np.testing.assert_allclose(found, [1.5 - np.sqrt(2.0), 1.0], atol=1e-12)


def test_members_of_a_group_do_not_count():
    model = model_of(FloorPlan(box(0, 0, 9, 4), exits=[Exit("e", (9, 0), (9, 4))]), wanderer(5))
    one, other = model.add_pedestrians([(2.0, 2.0), (2.5, 2.0)], group="family")
    alone = model.add_pedestrians([(3.0, 2.0)])[0]
    term = KeepDistance()
    both = model.candidates(np.array([one.row]))
    other.group = None
    apart = model.candidates(np.array([one.row]))
    assert term.cost(apart).sum() > term.cost(both).sum() > 0.0
    alone.remove()
    other.group = "family"
    assert term.cost(model.candidates(np.array([one.row]))).max() == 0.0


def nearest(model):
    """Mean distance to the nearest other person."""
    places = model.space.agent_positions
    away = np.linalg.norm(places[:, None] - places[None], axis=2)
    np.fill_diagonal(away, np.inf)
    return away.min(axis=1).mean()


def crowd(weight):
    plan = FloorPlan(box(0, 0, 24, 8), exits=[Exit("east", (24, 0), (24, 8))])
    model = model_of(plan, wanderer(5, options=120), rng=4, frames_per_step=3)
    if weight:
        model.terms.append(KeepDistance(weight=weight))
    inner = box(1, 1, 8, 7)
    places = plan.random_points(20, model.rng, within=inner, spacing=0.7, clearance=0.4)
    model.add_pedestrians(places)
    model.run(max_seconds=4)
    return nearest(model)


def test_people_are_farther_apart():
    assert crowd(4.0) > crowd(0.0) + 0.1


@pytest.mark.parametrize("distance", [0.0, -1.0, float("nan"), float("inf")])
def test_distances_that_are_refused(distance):
    with pytest.raises(ModelError, match="keep_distance: distance"):
        KeepDistance(distance=distance)
