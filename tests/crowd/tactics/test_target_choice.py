"""Target choices brought by others."""

import numpy as np
import pytest
from mesa_mobility.behaviors import TargetDistance

from mesa_mobility.crowd import Deciding, TargetChoice
from mesa_mobility.floorplan import Targets
from tests.fixtures.maps import make_map, shipped_map, stand, straight, strider
from tests.fixtures.oracles.counting import crossings
from tests.fixtures.scenes import advance, corridor, model_of, put, statues, two_doors


class ToPoint(TargetChoice):
    """Everybody to one point, the one farthest to the right first."""

    name = "to_point"

    def __init__(self, point: tuple[float, float]) -> None:
        self.point = point
        self.asked: list[Deciding] = []

    def targets(self, deciding: Deciding) -> Targets:
        self.asked.append(deciding)
        n = len(deciding.pedestrians)
        return Targets(
            points=np.tile(np.array(self.point), (n, 1)),
            gates=np.full(n, -1),
            distances=100.0 - deciding.positions[:, 0],
        )


class AfterAWhile(TargetChoice):
    """To the left door for a second, then to the right one."""

    name = "after_a_while"

    def targets(self, deciding: Deciding) -> Targets:
        door = "left" if deciding.elapsed < 1.0 else "right"
        number = deciding.site.destination((door,))
        return deciding.site.targets(
            deciding.positions, np.full(len(deciding.pedestrians), number, dtype=np.int32)
        )


def test_people_head_for_the_targets_given():
    choice = ToPoint((5.0, 20.0))
    fork = make_map([[stand(), *(straight(1.5, 45, towards=t, to=0) for t in (0.5, -0.5))]])
    model = model_of(corridor(), fork, target_choice=choice, behaviors=[TargetDistance()])
    person = put(model, 5.0, 2.0, 0.0, preferred_speeds=[1.34])
    assert person.target.tolist() == [5.0, 20.0]
    advance(model, 45)
    assert person.position[1] > 2.5


def test_by_default_people_face_the_target_given():
    model = model_of(corridor(), strider(), target_choice=ToPoint((5.0, 3.0)))
    (person,) = model.add_pedestrians([(5.0, 1.0)])
    assert person.heading == pytest.approx(np.pi / 2)


def test_a_target_choice_gets_those_who_decide_and_their_places():
    choice = ToPoint((99.0, 2.0))
    model = model_of(corridor(length=90.0), [strider(), statues()], target_choice=choice)
    walker, statue = (
        put(model, 1.0, 1.0, preferred_speeds=[1.25]),
        put(model, 3.0, 3.0, type_index=1),
    )
    choice.asked.clear()
    advance(model, 45)
    # Both at the start; the statue each 12 frames, the walker not before its 45 are over.
    asked = [(round(d.elapsed * 30), d.pedestrians.tolist()) for d in choice.asked]
    assert asked == [(0, [walker.row, statue.row]), *((f, [statue.row]) for f in (12, 24, 36))]
    first = choice.asked[0]
    assert first.positions.tolist() == [[1.0, 1.0], [3.0, 3.0]]
    assert first.types.tolist() == [0, 1]
    choice.asked.clear()
    advance(model, 1)
    assert choice.asked[0].pedestrians.tolist() == [walker.row]
    np.testing.assert_allclose(choice.asked[0].positions, [(2.875, 1.0)], atol=1e-6)


def test_people_decide_in_rising_order_of_the_distance_given():
    # As under `nearest first`, but the choice says that who is farther right is nearer. All go as
    # far as there is room, which the one in front makes if it decides first.
    choice = ToPoint((99.0, 2.0))
    model = model_of(
        corridor(both_ends=True), strider(), behaviors=[TargetDistance()], target_choice=choice
    )
    model.add_pedestrians([(6.0, 2.0), (6.5, 2.0)], headings=0.0, preferred_speeds=1.25)
    advance(model, 45)
    assert sorted(p.position[0] for p in model.agents) == pytest.approx([7.875, 8.375])


def test_a_choice_that_changes_its_mind():
    model = model_of(two_doors(), shipped_map(), target_choice=AfterAWhile(), rng=1)
    people = model.add_pedestrians([(6.0, 4.0), (6.5, 2.0)])
    assert all(person.target[0] < 0.0 for person in people)
    model.run(max_seconds=40)
    assert model.inside == 0
    rows = model.recorder.arrays()
    right = model.floor_plan.gate("right")
    assert set(crossings(rows, right.a, right.b).values()) == {1}


def test_a_choice_must_say_where_to():
    class Undecided(TargetChoice):
        name = "undecided"

    with pytest.raises(TypeError):
        Undecided()
