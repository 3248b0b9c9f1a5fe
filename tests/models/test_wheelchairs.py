"""Wheelchairs on their tracks: they turn on the spot, take no side step, and stop before a gap."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, PedestrianType
from mesa_mobility.results import Trajectories

WHEELCHAIRS = ("wheelchair_manual", "wheelchair_powered", "wheelchair_assisted")

# Paths are sampled each 0.1 s, and straight in between.
STEP = 3


def tracks_of(model, person):
    """(n, 3) places in metres and headings in radians of one person, each 0.1 s."""
    tracks = Trajectories.of(model)
    own = tracks.person == person
    return np.column_stack([tracks.x[own], tracks.y[own], np.unwrap(tracks.heading[own])])[::STEP]


@pytest.mark.parametrize("name", WHEELCHAIRS)
def test_they_take_no_side_step_in_a_crowd_before_a_door(name):
    plan = FloorPlan(box(0, 0, 10, 8), exits=[Exit("door", (10, 3.4), (10, 4.6))])
    kinds = [PedestrianType.named(name), PedestrianType.named("able_bodied")]
    model = PedestrianModel(plan, pedestrian_types=kinds, record=True, rng=1)
    places = plan.random_points(12, model.rng, spacing=0.9, clearance=0.6)
    model.add_pedestrians(places, type_index=[0, 0, 0, 0] + [1] * 8)
    model.run(max_seconds=120)
    assert model.inside == 0
    for person in range(4):
        track = tracks_of(model, person)
        steps = np.diff(track[:, :2], axis=0)
        middle = track[:-1, 2] + 0.5 * np.diff(track[:, 2])
        across = steps[:, 1] * np.cos(middle) - steps[:, 0] * np.sin(middle)
        assert np.hypot(*steps.T).sum() > 2.0
        # Where the speed changes within a step, its chord is a little off the mean heading.
        assert np.abs(across).max() < 0.001


@pytest.mark.parametrize("name", WHEELCHAIRS)
def test_they_turn_round_within_a_circle_of_one_metre_and_a_half(name):
    """At the end of a blind corridor, where they can hardly move to and fro."""
    kind = PedestrianType.named(name)
    plan = FloorPlan(box(0, 0, 6, 0.84), exits=[Exit("behind", (0, 0), (0, 0.84))])
    model = PedestrianModel(plan, pedestrian_types=[kind], record=True, rng=1)
    model.add_pedestrians([(5.6, 0.42)], headings=[0.0])
    model.run(max_seconds=90)
    assert model.inside == 0
    track = tracks_of(model, 0)
    turned = np.abs(track[:, 2]) > np.deg2rad(165.0)
    assert turned.any()
    turning = track[: np.argmax(turned) + 1]
    body = kind.mobility_map.metadata["body"]
    # The corners of the footprint sweep a circle about a pelvis that stays near one place.
    reach = np.hypot(body["length_m"], body["width_m"]) / 2
    assert reach + np.hypot(*np.ptp(turning[:, :2], axis=0)) / 2 <= 0.75


@pytest.mark.parametrize("name", WHEELCHAIRS)
def test_they_stop_before_a_gap_between_people_until_there_is_room(name):
    kinds = [PedestrianType.named(name), PedestrianType.named("able_bodied")]
    plan = FloorPlan(box(0, 0, 14, 1.24), exits=[Exit("end", (14, 0), (14, 1.24))])
    model = PedestrianModel(plan, pedestrian_types=kinds, record=True, rng=1)
    [chair] = model.add_pedestrians([(2.0, 0.62)], headings=[0.0], type_index=0)
    # Bodies of 0.28 m at both walls leave 0.6 m; the wheelchair is 0.7 m wide.
    stand = model.add_pedestrians([(7.0, 0.18), (7.0, 1.06)], headings=[0.0, 0.0], type_index=1)
    for person in stand:
        person.wait(40.0)
    model.run(max_seconds=35)
    track = tracks_of(model, chair.row)
    # Discs of 0.35 m and 0.14 m whose middles are 0.44 m apart across the corridor touch at 0.22 m.
    assert 5.0 < track[-1, 0] <= 7.0 - np.sqrt(0.49**2 - 0.44**2)
    assert np.ptp(track[-30:, 0]) < 0.02
    model.run(max_seconds=120)
    assert model.inside == 0
