"""Wide people before openings through which two of them do not fit side by side."""

import numpy as np
import pytest

from mesa_mobility import PedestrianModel, PedestrianType
from mesa_mobility.crowd.tactics.giving_way.openings import (
    at_a_jamb,
    axis_points,
    mouths_ahead,
    wait_clear,
)
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import overlaps, track
from tests.fixtures.scenes import advance, model_of, put, two_rooms

# A mouth 1 m wide along the x axis, entered upwards.
MOUTH = np.array([[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]])


@pytest.mark.parametrize(("place", "target", "found"), [
    ((0.5, -2.0), (0.5, 2.0), 0),
    ((0.5, -3.0), (0.5, -1.1), 0),  # a target right before it
    ((0.5, -3.0), (0.5, -1.3), -1),  # a target farther off than waiting people are, 1.2 m
    ((0.5, 2.0), (0.5, -2.0), -1),  # the other way
    ((0.5, -4.1), (0.5, 1.5), -1),  # too far off
    ((-0.3, -2.0), (-0.3, 2.0), 0),  # just past a jamb
    ((-0.4, -2.0), (-0.4, 2.0), -1),
    ((1.3, -2.0), (1.3, 2.0), 0),
    ((-2.0, -1.0), (3.0, 1.0), 0),  # crosses at x = 0.5
    ((0.5, -2.0), (0.5, -2.0), -1),  # who stays
])  # fmt: skip
def test_who_is_about_to_enter(place, target, found):
    assert ahead(MOUTH, place, target) == found


def ahead(mouths, place, target) -> int:
    found = mouths_ahead(mouths, np.array([place]), np.array([target]), np.array([0.35]))
    return int(found[0])


def test_the_nearer_of_two_mouths():
    mouths = np.concatenate([MOUTH, MOUTH - [0.0, 1.0, 0.0, 1.0, 0.0, 0.0]])
    assert ahead(mouths, (0.5, -2.0), (0.5, 2.0)) == 1


def test_a_body_is_kept_clear_of_the_mouth():
    """Half the mouth and one body of 0.7 m are 1.2 m from its middle; they stop at 1.55 m."""
    places = np.array([[0.5, -3.05], [0.5, -1.4], [0.5, -1.0], [-0.5, 0.0]])
    targets = np.full((4, 2), (0.5, 5.0))
    points, speeds = wait_clear(
        MOUTH.repeat(4, axis=0), places, np.full(4, 0.35), targets, np.full(4, 1.3)
    )
    # 1.5 m left in 1.5 s; there; 0.2 m too near, and away from the middle.
    assert speeds == pytest.approx([1.0, 0.0, 0.8, 0.8])
    assert points == pytest.approx(np.array([[0.5, -1.55], [0.5, -1.4], [0.5, -3.0], [-2.5, 0.0]]))


def wide(core: float = 0.35):
    return strider(core_radius=core)


def test_the_nearer_goes_first_and_the_other_keeps_clear():
    model = model_of(two_rooms(1.0, 0.2), wide())
    near = put(model, 8.0, 4.0, exits=["east"], preferred_speeds=1.25)
    far = put(model, 6.8, 4.0, exits=["east"], preferred_speeds=1.25)
    advance(model, 150)
    rows = model.recorder.arrays()
    first, second = track(rows, near.row), track(rows, far.row)
    clear = 10.0 - (0.5 + 2 * 0.35)
    through = first[first[:, 1] > 10.0, 0].min()
    assert (second[second[:, 0] <= through, 1] <= clear + 0.02).all()
    assert second[-1, 1] > 10.0
    assert overlaps(rows, 0.35) == 0


def test_bodies_that_fit_side_by_side_do_not_wait():
    def beside(width: float) -> float:
        """Where the second of two is whose first is slow, after 3 s."""
        model = model_of(two_rooms(width, 0.2), wide())
        put(model, 8.0, 4.4, exits=["east"], preferred_speeds=0.3)
        other = put(model, 7.2, 3.6, exits=["east"])
        advance(model, 90)
        return float(other.position[0])

    # Stopped half a mouth and one body and a half before the middle of the mouth, and past it.
    assert beside(1.3) < 10.0 - 1.3 / 2 - 0.7 < 10.0 < beside(2.4)


@pytest.mark.thorough
def test_people_on_foot_move_as_without_it():
    def places(taken_out: bool) -> bytes:
        model = PedestrianModel(
            two_rooms(0.9, 0.2), pedestrian_types=[
                PedestrianType(mobility_map=shipped_map()),
                PedestrianType(mobility_map=shipped_map(), name="wide", core_radius=0.35),
            ], rng=3,
        )  # fmt: skip
        if taken_out:
            model.tactics[:] = [each for each in model.tactics if each.name != "giving_way"]
        model.add_pedestrians(
            [(6.0 + k % 3, 3.0 + k // 3) for k in range(9)], exits=["east"], type_index=0
        )
        # A single wide person has nobody to give way to.
        model.add_pedestrians([(4.0, 4.0)], exits=["east"], type_index=1)
        model.run(max_seconds=8)
        return model.crowd.records[:10].tobytes()

    assert places(True) == places(False)


def test_one_who_makes_no_progress_loses_its_precedence():
    model = model_of(two_rooms(1.0, 0.2), wide())
    blocked = put(model, 8.9, 4.0, exits=["east"])
    blocked.wait(3.0)
    other = put(model, 7.0, 4.0, exits=["east"])
    advance(model, 600)
    assert model.inside == 0 or other.position[0] > 10.0


class Rooms(PedestrianModel):
    def __init__(self, rng=None):
        super().__init__(two_rooms(1.0, 0.2), mobility_map=wide(), record=True, rng=rng)
        self.add_pedestrians([(6.0 + k, 2.6 + 0.7 * (k % 3)) for k in range(4)], exits=["east"])


@pytest.mark.thorough
def test_a_saved_model_goes_on_alike(tmp_path):
    model = Rooms(rng=1)
    model.run(max_seconds=2)
    model.save(tmp_path / "now.ckpt")
    again = Rooms.load(tmp_path / "now.ckpt")
    for each in (model, again):
        each.run(max_seconds=4)
    assert again.crowd.records[:4].tobytes() == model.crowd.records[:4].tobytes()


def test_up_against_a_jamb():
    """A body of 0.35 m fits through 1 m where its centre is within 0.15 m of the middle."""
    places = np.array([[0.74, -0.25], [0.6, -0.34], [0.9, -0.5]])
    cores = np.full(3, 0.35)
    # 0.36 m from the jamb at (1, 0); within 0.15 m of the middle; 0.51 m from the jamb.
    assert at_a_jamb(MOUTH.repeat(3, axis=0), places, cores).tolist() == [True, False, False]
    assert axis_points(MOUTH, cores[:1]).tolist() == [[0.5, -0.7]]
