"""Which exit people take, and when they change their mind."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import FamiliarExit, QuickestExit, SocialInfluence
from shapely import box

from mesa_mobility import Exit, FloorPlan, Gate
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import crossings
from tests.fixtures.scenes import advance, model_of, put, statues


def hall(length: float = 20.0) -> FloorPlan:
    """Exits 2 m wide, 0 and 1, at either end of a hall 6 m wide."""
    return FloorPlan(
        box(0, 0, length, 6),
        exits=[Exit("left", (0, 2), (0, 4)), Exit("right", (length, 2), (length, 4))],
    )


def heads_for(choice, people) -> list[int]:
    return choice.heading(np.array([p.row for p in people])).tolist()


def taken(model, people) -> list[str]:
    """By which exit each has left."""
    rows = model.recorder.arrays()
    passed = {}
    for door in model.floor_plan.exits:
        passed |= {row: door.name for row, n in crossings(rows, door.a, door.b).items() if n}
    return [passed.get(p.row) for p in people]


# -- the quickest ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    # At 1 m/s from x = 8: 8 s to the left, 12 s to the right. 2 m pass 4.305 people a second, so
    # that 17 before oneself take 3.95 s and 18 of them 4.18 s.
    ("queue", "expected"),
    [(0, 0), (17, 0), (18, 1), (40, 1)],
)
def test_walk_and_queue_are_weighed(queue, expected):
    choice = QuickestExit()
    model = model_of(hall(), [strider(), statues()], target_choice=choice)
    model.add_pedestrians(
        [(0.5 + 0.4 * (k // 14), 0.3 + 0.4 * (k % 14)) for k in range(queue)],
        exits=["left"],
        type_index=1,
    )
    person = put(model, 8.0, 3.0, preferred_speeds=[1.0])
    assert heads_for(choice, [person]) == [expected]


def test_those_behind_do_not_count():
    choice = QuickestExit()
    model = model_of(hall(), [strider(), statues()], target_choice=choice)
    model.add_pedestrians(
        [(9.0 + 0.4 * (k // 14), 0.3 + 0.4 * (k % 14)) for k in range(30)],
        exits=["left"],
        type_index=1,
    )
    assert heads_for(choice, [put(model, 8.0, 3.0, preferred_speeds=[1.0])]) == [0]


@pytest.mark.parametrize(("queue", "turns"), [(4, False), (5, True)])
def test_only_a_gain_of_a_tenth_turns_people_round(queue, turns):
    # From the middle it is 10 s either way. 4 before oneself make it 10.93 s, of which 0.93 s are
    # less than a tenth; 5 make it 11.16 s.
    choice = QuickestExit(interval=0.01)
    model = model_of(hall(), [statues(), statues()], target_choice=choice, rng=1)
    person = put(model, 10.0, 3.0, preferred_speeds=[1.0])
    model.add_pedestrians([(1.0, 0.5 + k) for k in range(queue)], exits=["left"], type_index=1)
    advance(model, 12)
    assert heads_for(choice, [person]) == [0]
    advance(model, 1)  # its second decision, and the first with time to think again
    assert heads_for(choice, [person]) == [int(turns)]


@pytest.mark.parametrize(("queue", "turns"), [(33, False), (36, True)])
def test_the_longer_people_have_been_under_way_the_more_they_must_gain(queue, turns):
    # 10 s either way, and a minute gone. 33 before oneself make it 17.67 s: 7.67 s to gain, of
    # 77.7 s in all, are less than a tenth; with 36 it is 8.36 s of 78.4 s.
    choice = QuickestExit(interval=0.01)
    model = model_of(hall(), [statues(), statues()], target_choice=choice, rng=1)
    person = put(model, 10.0, 3.0, preferred_speeds=[1.0])
    advance(model, 1800)
    model.add_pedestrians(
        [(1.0 + 0.5 * (k // 10), 0.5 + 0.5 * (k % 10)) for k in range(queue)],
        exits=["left"],
        type_index=1,
    )
    advance(model, 13)
    assert heads_for(choice, [person]) == [int(turns)]


def test_a_jam_at_the_nearer_exit_sends_some_to_the_farther_one():
    # RiMEA test 11, smaller: two exits in one wall, everybody nearer to the first of them.
    near, far = Exit("near", (11, 10), (12, 10)), Exit("far", (16, 10), (17, 10))
    plan = FloorPlan(box(0, 0, 18, 10), exits=[near, far])
    model = model_of(plan, shipped_map(), target_choice=QuickestExit(), rng=3, frames_per_step=3)
    people = model.add_pedestrians(
        plan.random_points(80, model.rng, within=box(1, 1, 9, 9), spacing=0.45, clearance=0.3)
    )
    model.run(max_seconds=120)
    assert model.inside == 0
    share = taken(model, people).count("near") / 80
    assert 0.5 < share < 0.8


# -- a familiar one ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    # From x = 8: 8 m and 12 m. Right is farther by 4 m.
    ("affiliation", "known", "expected"),
    [(3.0, ["right"], 0), (5.0, ["right"], 1), (5.0, ["left", "right"], 0), (5.0, [], 0)],
)
def test_a_known_exit_is_worth_some_metres(affiliation, known, expected):
    choice = FamiliarExit(known, affiliation=affiliation, scale=0.0)
    model = model_of(hall(), strider(), target_choice=choice)
    assert heads_for(choice, [put(model, 8.0, 3.0)]) == [expected]


def test_each_may_know_exits_of_its_own():
    choice = FamiliarExit(["left"], scale=0.0)
    model = model_of(hall(), shipped_map(), target_choice=choice, rng=1, frames_per_step=3)
    a, b = put(model, 8.0, 2.0), put(model, 8.0, 4.0)
    choice.know([b], ["right"])
    model.run(max_seconds=60)
    assert taken(model, [a, b]) == ["left", "right"]


def test_tastes_make_shares_of_a_logit_model():
    # 8 m and 12 m with a scale of 2 m: 1 / (1 + exp(-4 / 2)) = 0.881 take the nearer.
    choice = FamiliarExit(scale=2.0)
    model = model_of(hall(), strider(), target_choice=choice, preset="paper", rng=5)
    people = model.add_pedestrians(np.tile([(8.0, 3.0)], (4000, 1)))
    share = np.mean(np.array(heads_for(choice, people)) == 0)
    assert share == pytest.approx(1 / (1 + math.exp(-2.0)), abs=0.02)


def test_nobody_wavers():
    choice = FamiliarExit(scale=4.0, interval=0.1)
    model = model_of(hall(), statues(), target_choice=choice, rng=2)
    people = model.add_pedestrians([(10.0, 0.5 + 0.5 * k) for k in range(11)])
    first = heads_for(choice, people)
    assert set(first) == {0, 1}
    for _ in range(20):
        advance(model, 12)
        assert heads_for(choice, people) == first


def test_exits_unknown_to_the_plan():
    model = model_of(hall(), strider(), target_choice=FamiliarExit(["middle"]))
    with pytest.raises(ModelError, match=r"'middle' is unknown.*left, right"):
        put(model, 8.0, 3.0)
    choice = FamiliarExit()
    model = model_of(hall(), strider(), target_choice=choice)
    person = put(model, 8.0, 3.0)
    for names in (["middle"], "left"):
        with pytest.raises(ModelError, match="exit"):
            choice.know([person], names)


# -- where others go ---------------------------------------------------------------------------


def bound(model, n: int, y: float = 3.0) -> None:
    model.add_pedestrians(
        [(13.0, y - 0.2 * n + 0.4 * k) for k in range(n)], exits=["right"], type_index=1
    )


@pytest.mark.parametrize(
    # From x = 8: right is farther by 4 m; of three in view two head there, worth 2/3 of influence.
    ("influence", "expected"),
    [(0.0, 0), (11.9, 0), (12.1, 1)],
)
def test_the_share_of_those_in_view_counts(influence, expected):
    choice = SocialInfluence(influence=influence, scale=0.0)
    model = model_of(hall(), [strider(), statues()], target_choice=choice)
    bound(model, 2)
    model.add_pedestrians([(6.0, 3.0)], exits=["left"], type_index=1)
    # 2/3 - 1/3 of 12 m are 4 m.
    assert heads_for(choice, [put(model, 8.0, 3.0)]) == [expected]


@pytest.mark.parametrize(("sight", "walled"), [(4.0, False), (15.0, True)])
def test_those_out_of_view_do_not_count(sight, walled):
    choice = SocialInfluence(influence=50.0, sight=sight, scale=0.0)
    plan = hall()
    if walled:
        plan.add_obstacle(box(10.0, 1.0, 10.5, 5.0))
    model = model_of(plan, [strider(), statues()], target_choice=choice)
    bound(model, 1)
    assert heads_for(choice, [put(model, 8.0, 3.0)]) == [0]


def test_one_who_goes_there_draws_others():
    # NIST TN 1822 Verif.3.2: two exits as far off; the share of the second rises.
    shares = []
    for others in (0, 1):
        choice = SocialInfluence()
        model = model_of(
            hall(), [strider(), strider()], target_choice=choice, preset="paper", rng=4
        )
        bound(model, others)
        # All of them choose at once, before any of the others heads anywhere.
        people = model.add_pedestrians(np.tile([(10.0, 3.0)], (2000, 1)))
        shares.append(np.mean(heads_for(choice, people)))
    # Even, and 1 / (1 + exp(-5 / 2)) = 0.924.
    assert shares == pytest.approx([0.5, 0.924], abs=0.04)


# -- what they have in common ------------------------------------------------------------------

CHOICES = [QuickestExit, FamiliarExit, SocialInfluence]


@pytest.mark.parametrize("choice", CHOICES)
def test_an_exit_that_closes_is_left_at_the_next_decision(choice):
    # NIST TN 1822 Verif.4.1: heading for one exit, which is unavailable from 1 s on.
    made = choice()
    model = model_of(hall(), shipped_map(), target_choice=made, rng=1, frames_per_step=3)
    people = model.add_pedestrians([(7.0, 2.0), (7.0, 4.0)])
    while model.elapsed < 1.0:
        model.step()
    assert 0 in heads_for(made, people)
    model.floor_plan.close_gate("left")
    # The longest movement takes 1.5 s.
    advance(model, 46)
    assert heads_for(made, people) == [1, 1]
    model.run(max_seconds=60)
    assert taken(model, people) == ["right", "right"]


@pytest.mark.parametrize("choice", CHOICES)
def test_nobody_takes_an_exit_that_is_not_its_own(choice):
    made = choice()
    model = model_of(hall(), strider(), target_choice=made)
    assert heads_for(made, [put(model, 1.0, 3.0, exits=["right"])]) == [1]


@pytest.mark.parametrize("choice", CHOICES)
def test_on_the_way_to_a_gate_nothing_is_chosen(choice):
    plan = FloorPlan(box(0, 0, 20, 6), exits=hall().exits, gates=[Gate("g", (14, 0), (14, 6))])
    made = choice()
    model = model_of(plan, shipped_map(), target_choice=made, rng=1, frames_per_step=3)
    person = put(model, 8.0, 3.0, route=["g"])
    assert heads_for(made, [person]) == [-1]
    assert person.target[0] > 14.0
    model.run(max_seconds=60)
    assert person.gates_crossed == 1
    assert model.inside == 0


@pytest.mark.parametrize("choice", CHOICES)
def test_with_no_exit_open_people_wait_for_one(choice):
    plan = hall()
    plan.close_gate("left")
    plan.close_gate("right")
    made = choice()
    model = model_of(plan, shipped_map(), target_choice=made, rng=1, frames_per_step=3)
    person = put(model, 8.0, 3.0)
    advance(model, 60)
    assert heads_for(made, [person]) == [-1]
    plan.open_gate("right")
    model.run(max_seconds=60)
    assert taken(model, [person]) == ["right"]


@pytest.mark.parametrize(
    "make",
    [
        lambda: QuickestExit(interval=0.0),
        lambda: QuickestExit(patience=1.0),
        lambda: FamiliarExit("left"),
        lambda: FamiliarExit(affiliation=-1.0),
        lambda: FamiliarExit(scale=math.inf),
        lambda: SocialInfluence(influence=math.nan),
        lambda: SocialInfluence(sight=0.0),
    ],
)
def test_parameters_out_of_range(make):
    with pytest.raises(ModelError):
        make()
