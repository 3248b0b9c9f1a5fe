"""The explanation of a decision agrees with the decision itself."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import Displacement, Interference, TargetDistance

from mesa_mobility import CostTerm, FloorPlan
from mesa_mobility.crowd import FREE, PERSON, WALL, Watch
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import Exit
from tests.fixtures.engine import ENGINE
from tests.fixtures.maps import make_map, stand, straight, strider, wanderer
from tests.fixtures.oracles.numpy_terms import Clearance
from tests.fixtures.plugin_terms import KeepOff
from tests.fixtures.scenes import advance, corridor, dead_end, model_of, put, statues

ROOM = "POLYGON((0 0,6 0,6 5,0 5,0 0))"
PILLAR = "POLYGON((3 2,3.5 2,3.5 3,3 3,3 2))"


class KeepLow(CostTerm):
    """Metres above y = 1, as another package would write it."""

    name = "keep_low"

    def cost(self, candidates):
        return np.abs(candidates.points[:, 1] - 1.0)


def room(seed, preset=ENGINE, extra=()):
    plan = FloorPlan(
        ROOM,
        exits=[Exit("east", (6, 1), (6, 1.8)), Exit("north", (1, 5), (2, 5))],
        obstacles=[PILLAR],
    )
    model = model_of(plan, wanderer(seed), preset=preset, rng=seed)
    model.terms.extend(extra)
    model.add_pedestrians(plan.random_points(10, model.rng, spacing=0.5, clearance=0.3))
    return model


ENDS = ("from", "to")


def decisions_of(model, row, frames):
    """(decision, start and end of what it commits to) of a watched pedestrian, one by one."""
    model.watch = Watch(row)
    explained = []
    while model.running and model.frame < frames and model.crowd.active[row]:
        before = model.watch.decision
        advance(model, 1)
        if model.watch.decision is not before:
            person = model.crowd.records[row]
            poses = [[person[f"{end}_{of}"] for of in ("x", "y", "heading")] for end in ENDS]
            explained.append((model.watch.decision, np.array(poses).T))
    return explained


@pytest.mark.thorough
@pytest.mark.parametrize("preset", [ENGINE, "paper"], ids=["engine", "paper"])
@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("plug_in", [False, True])
def test_the_cheapest_of_the_free_options_is_what_the_engine_commits_to(preset, seed, plug_in):
    taken = 0
    for row in range(5):
        model = room(seed, preset, [KeepLow(0.7)] if plug_in else [])
        for decision, ends in decisions_of(model, row, 200):
            assert decision.taken
            assert decision.pedestrian == row
            free = decision.verdicts == FREE
            taken += 1
            if not free.any():
                assert decision.chosen == -1
                continue
            cheapest = np.flatnonzero(free)[np.argmin(decision.totals[free])]
            assert decision.chosen == cheapest
            knots = decision.knots[cheapest]
            assert np.array_equal(decision.paths[cheapest][:, [0, knots - 1]], ends)
    assert taken >= 10


@pytest.mark.parametrize("weight", [2.0, -2.0])
def test_a_term_over_walls_counts_in_the_explanation_as_in_the_decision(weight):
    taken = beside = 0
    for row in range(5):
        model = room(1, extra=[KeepOff(weight)])
        for decision, _ in decisions_of(model, row, 200):
            taken += 1
            expected = Clearance().cost(decision.candidates)
            beside += int(expected.any())
            np.testing.assert_allclose(decision.costs[-1], expected, atol=1e-9)
            assert decision.terms[-1] == "keep_off"
            free = decision.verdicts == FREE
            cheapest = np.flatnonzero(free)[np.argmin(decision.totals[free])]
            assert decision.chosen == cheapest
    assert min(taken, beside) >= 10


def test_where_nothing_is_free_the_explanation_names_the_fallback(whole):
    # Nothing but two metres ahead, and a wall at one.
    model = model_of(dead_end(x=5.0), make_map([[straight(2.0, 12, to=0)]]), preset=whole)
    person = put(model, 4.0, 2.0, preferred_speeds=[0.5])
    ((decision, _),) = decisions_of(model, person.row, 1)
    assert decision.chosen == -1
    assert (decision.verdicts == WALL).all()
    assert person.in_fallback
    assert model.crowd.knots[person.row] == 2


def test_watching_changes_nothing():
    quiet, watched = room(4, extra=[KeepLow(0.5)]), room(4, extra=[KeepLow(0.5)])
    watched.watch = Watch(3)
    for _ in range(150):
        quiet.step()
        watched.step()
    assert watched.watch.decision is not None
    assert quiet.crowd.records.tobytes() == watched.crowd.records.tobytes()
    assert quiet.rng.random() == watched.rng.random()


def test_costs_are_those_of_each_term_with_its_weight(whole):
    # At (2, 2) facing east, 18 m from the exit's line at x = 20; straight on by 0, 0.5 and 1 m.
    terms = [TargetDistance(2.0), KeepLow(3.0), Displacement(0.5)]
    speed_rules = [straight(0.5, 12, to=0), straight(1.0, 12, to=0)]
    model = model_of(corridor(), make_map([[stand(), *speed_rules]]), behaviors=terms, preset=whole)
    person = put(model, 2.0, 2.0)
    model.crowd.target_x[person.row], model.crowd.target_y[person.row] = 5.0, 2.0
    explained = model.explain(person.row)
    assert not explained.taken
    assert explained.terms == ("target_distance", "keep_low", "displacement")
    order = np.argsort(explained.candidates.displacements)
    assert explained.weights.tolist() == [2.0, 3.0, 0.5]
    assert explained.costs[0][order] == pytest.approx([3.0, 2.5, 2.0], abs=1e-6)
    assert explained.costs[1][order] == pytest.approx([1.0, 1.0, 1.0], abs=1e-6)
    assert explained.costs[2][order] == pytest.approx([0.0, -0.5, -1.0], abs=1e-6)
    assert explained.totals[order] == pytest.approx([9.0, 7.75, 6.5], abs=1e-5)
    assert explained.chosen == order[2]


def test_walls_and_people_in_the_way_have_different_verdicts(in_parts):
    # A strider may go 0.5, 1 or 1.875 m; bodies of 0.15 m stay clear of each other and of walls.
    maps, terms = [strider(), statues()], [Displacement()]
    model = model_of(dead_end(x=5.0), maps, behaviors=terms, preset=in_parts)
    person = put(model, 3.4, 2.0)
    explained = model.explain(person.row)
    by_reach = dict(
        zip(np.round(explained.candidates.displacements, 2), explained.verdicts, strict=True)
    )
    parts = {0.0: FREE, 0.12: FREE, 0.25: FREE}
    assert by_reach == parts | {0.5: FREE, 1.0: FREE, 1.88: WALL}
    other = put(model, 4.25, 2.0, type_index=1)
    explained = model.explain(person.row)
    by_reach = dict(
        zip(np.round(explained.candidates.displacements, 2), explained.verdicts, strict=True)
    )
    assert by_reach == parts | {0.5: FREE, 1.0: PERSON, 1.88: WALL}
    assert set(explained.blockers[explained.verdicts == PERSON]) == {other.row}
    assert (explained.blockers[explained.verdicts != PERSON] == -1).all()
    assert explained.candidates.displacements[explained.chosen] == pytest.approx(0.5, abs=1e-6)


def test_paths_lead_from_where_the_person_stands_to_the_mobility_points():
    model = room(1)
    explained = model.explain(2)
    x, y = model.crowd.x[2], model.crowd.y[2]
    assert explained.paths[:, 0, 0] == pytest.approx(np.full(len(explained.knots), x))
    assert explained.paths[:, 1, 0] == pytest.approx(np.full(len(explained.knots), y))
    ends = explained.paths[np.arange(len(explained.knots)), :2, explained.knots - 1]
    assert ends == pytest.approx(explained.candidates.points, abs=1e-6)
    assert (explained.knots - 1) * 0.1 == pytest.approx(explained.candidates.durations)


def test_what_those_before_have_committed_to_counts_and_their_velocities_do_not():
    # The one ahead decides first, and goes: behind it the long option is free at once. The cost
    # of interference sees both as they stood.
    model = model_of(corridor(), strider(), behaviors=[Displacement(), Interference()])
    model.add_pedestrians([(6.5, 2.0), (6.0, 2.0)], headings=[0.0, 0.0])
    alone = model.explain(1)
    assert PERSON in alone.verdicts
    model.watch = Watch(1)
    advance(model, 1)
    decision = model.watch.decision
    assert decision.taken
    assert (decision.verdicts == FREE).all()
    assert np.array_equal(decision.costs, alone.costs)
    assert alone.neighbour_ends == pytest.approx(np.array([[6.5, 2.0]]))
    assert decision.neighbour_ends == pytest.approx(np.array([[8.375, 2.0]]))
    assert math.hypot(*decision.candidates.neighbour_velocities[0]) == 0.0


def test_somebody_who_is_not_there_is_refused():
    model = room(0)
    for row in (-1, 10):
        with pytest.raises(ModelError, match=rf"pedestrian {row}: expected the row"):
            model.explain(row)
