"""People who choose between two corridors."""

import numpy as np
import pytest
from shapely import Polygon, box

from mesa_mobility import Exit, FloorPlan, Gate, RouteChoice
from mesa_mobility.errors import FloorPlanError, ModelError
from tests.fixtures.maps import wanderer
from tests.fixtures.scenes import model_of


def two_corridors():
    """A hall, a short corridor at y = 1 and a long one at y = 7, and a hall with an exit."""
    floor = box(0, 0, 20, 8) - box(6, 2, 14, 6)
    assert isinstance(floor, Polygon)
    return FloorPlan(
        floor,
        exits=[Exit("east", (20, 0), (20, 2))],
        gates=[Gate("low", (10, 0), (10, 2)), Gate("high", (10, 6), (10, 8))],
    )


class Alternating(RouteChoice):
    name = "alternating"

    def routes(self, deciding, who):
        return [["low"] if row % 2 else ["high"] for row in deciding.pedestrians[who].tolist()]


class Emptier(RouteChoice):
    """By the gate that fewer people head for."""

    name = "emptier"

    def __init__(self, interval):
        super().__init__(interval)
        self.asked = 0

    def routes(self, deciding, who):
        self.asked += len(who)
        return [["high"] if k % 2 else [] for k in range(len(who))]


def crowd(choice, n=8, **keywords):
    model = model_of(
        two_corridors(), wanderer(5, options=80), rng=2, frames_per_step=3, target_choice=choice
    )
    places = [(1.0 + k // 2, 3.5 + k % 2) for k in range(n)]
    return model, model.add_pedestrians(places, **keywords)


def test_each_goes_by_its_gate():
    model, people = crowd(Alternating())
    assert [person.route for person in people] == [("high",), ("low",)] * 4
    # Targets lie on the way round the near end of the block, x = 6, above or below.
    for person in people:
        assert (person.target[1] > 4.0) == (person.route == ("high",))
    passed = {}
    while model.inside and model.elapsed < 120.0:
        model.step()
        for person in model.agents:
            x, y = person.position
            if 8.0 < x < 12.0:
                passed[person.row] = y
    assert model.inside == 0
    assert {row: y > 4.0 for row, y in passed.items()} == {k: k % 2 == 0 for k in range(8)}


def test_who_has_a_route_keeps_it():
    _, people = crowd(Alternating(), route=["low"])
    assert {person.route for person in people} == {("low",)}


def test_people_choose_again_now_and_then():
    once, _ = crowd(choice := Emptier(np.inf))
    once.run(max_seconds=5)
    assert choice.asked == 8
    often, _ = crowd(again := Emptier(1.0))
    often.run(max_seconds=5)
    assert again.asked > 16


def test_what_is_refused():
    class Short(RouteChoice):
        name = "short"

        def routes(self, deciding, who):
            return []

    class Lost(RouteChoice):
        name = "lost"

        def routes(self, deciding, who):
            return [["middle"]] * len(who)

    with pytest.raises(ModelError, match="behaviour 'short': gave 0 routes, expected 8"):
        crowd(Short())
    with pytest.raises(FloorPlanError, match="there is no gate or exit 'middle'"):
        crowd(Lost())
    with pytest.raises(ModelError, match="interval 0, expected more than 0 s"):
        Alternating(0)


def test_the_graph_is_public_and_follows_the_plan():
    plan = two_corridors()
    names = {name for _, name in plan.route_graph.nodes(data="opening") if name}
    assert names == {"low", "high", "east"}
    assert all(weight > 0.0 for *_, weight in plan.route_graph.edges(data="weight"))
    plan.close_gate("low")
    names = {name for _, name in plan.route_graph.nodes(data="opening") if name}
    assert names == {"high", "east"}
