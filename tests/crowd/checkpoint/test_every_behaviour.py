"""Every behaviour and tactic that ships goes on from a checkpoint to the same bytes."""

import inspect

import pytest
from shapely import box

import mesa_mobility.live.order_tactics  # noqa: F401  (its tactics are those of no preset)
from mesa_mobility import CostTerm, Exit, FloorPlan, Gate, PedestrianModel, SpeedRule, TargetChoice
from mesa_mobility.crowd import Tactic
from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.live.order_tactics import follow_orders
from mesa_mobility.plugins import registry
from tests.fixtures.maps import wanderer
from tests.fixtures.scenes import advance


def below(kind):
    return {each for child in kind.__subclasses__() for each in (child, *below(child))}


def classes():
    """Those of entry points, and the tactics of the package."""
    installed = {each.load() for each in registry.behaviors().values()}
    tactics = {kind for kind in below(Tactic) if kind.__module__.startswith("mesa_mobility.")}
    found = {
        kind
        for kind in installed | tactics
        if kind.__module__.startswith("mesa_mobility.") and not inspect.isabstract(kind)
    }
    return sorted(found, key=lambda kind: kind.__name__)


class Halls(PedestrianModel):
    """Two halls with a door between them, and a wall in the way."""

    def __init__(self, rng=None):
        plan = FloorPlan(
            box(0, 0, 12, 8) - box(5, 0, 5.2, 3) - box(5, 4.2, 5.2, 8) - box(8, 3, 9, 5),
            exits=[Exit("east", (12, 3), (12, 5)), Exit("west", (0, 3), (0, 5))],
            gates=[Gate("door", (5.1, 3), (5.1, 4.2))],
        )
        super().__init__(plan, mobility_map=wanderer(4), record=True, frames_per_step=3, rng=rng)
        places = [(x, y) for x in (2.0, 3.0, 6.5) for y in (2.5, 4.0, 5.5)]
        self.add_pedestrians(places[:5])
        self.add_pedestrians(places[5:], exits=["west"], group="friends")


def add(model, behaviour):
    """Give a model a behaviour, instead of one of its name."""
    if isinstance(behaviour, TargetChoice):
        model.target_choice = behaviour
        return
    kinds = ((CostTerm, model.terms), (SpeedRule, model.speed_rules), (Tactic, model.tactics))
    (there,) = (each for kind, each in kinds if isinstance(behaviour, kind))
    there[:] = [each for each in there if each.name != behaviour.name]
    if isinstance(behaviour, Tactic):
        model.add_tactic(behaviour)
    else:
        there.append(behaviour)


def same(one, other):
    assert one.rng.bit_generator.state == other.rng.bit_generator.state
    for name, values in one.recorder.arrays().items():
        assert values.tobytes() == other.recorder.arrays()[name].tobytes(), name


@pytest.mark.thorough
@pytest.mark.parametrize("kind", classes())
def test_it_goes_on_to_the_same_bytes(kind, tmp_path):
    model = Halls(rng=2)
    add(model, kind())
    advance(model, 24)
    model.floor_plan.close_gate("west")
    advance(model, 21)
    model.save(tmp_path / "run.zip")
    again = Halls.load(tmp_path / "run.zip")
    for each in (model, again):
        advance(each, 60)
    assert model.inside
    same(model, again)


def test_people_who_are_under_command_go_on_as_well(tmp_path):
    model = Halls(rng=3)
    orders = follow_orders(model)
    rows = model.rows
    orders.steer(rows[:1], (0.5, 0.5))
    orders.walk(rows[1:3], (9.5, 6.5), 2.0)
    orders.walk(rows[3:4], (6.0, 1.0), None)
    advance(model, 45)
    model.save(tmp_path / "run.zip")
    again = Halls.load(tmp_path / "run.zip")
    theirs = follow_orders(again)
    assert [each.name for each in again.tactics] == [each.name for each in model.tactics]
    assert theirs.does.tolist() == orders.does.tolist() != []
    for each, told in ((model, orders), (again, theirs)):
        advance(each, 45)
        told.steer(rows[4:5], (-0.3, 0.0))
        told.release(rows[:1])
        advance(each, 45)
    same(model, again)


@pytest.mark.parametrize(
    "name",
    [
        "mesa_mobility.__main__:Steering",
        "mesa_mobility.live.nowhere:Steering",
        "os:getcwd",
        "mesa_mobility.live.order_tactics:follow_orders",
    ],
)
def test_nothing_but_behaviours_of_the_package_is_looked_for(name):
    from mesa_mobility.crowd.checkpoint.behaviours import _shipped

    assert _shipped(name) is None
    assert issubclass(_shipped("mesa_mobility.live.order_tactics:Steering"), Plugin)
