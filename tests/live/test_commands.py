"""What commands are understood, and what they do."""

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility import Exit, FloorPlan, Gate
from mesa_mobility.errors import LiveError, MobilityError
from mesa_mobility.live.commands import read_command
from mesa_mobility.live.run import Run
from tests.fixtures.maps import shipped_map
from tests.fixtures.scenes import model_of, put

JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=10),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner),
    max_leaves=12,
)
NAMES = [
    "do",
    "id",
    "person",
    "people",
    "to",
    "stay",
    "velocity",
    "seconds",
    "opening",
    "positions",
    "exits",
    "speed",
    "type",
    "heading",
]
VERBS = ["walk", "steer", "release", "leave", "wait", "open", "close", "add", "pause", "resume"]


@given(
    st.text(max_size=100)
    | JSON.map(json.dumps)
    | st.dictionaries(st.sampled_from(NAMES), JSON | st.sampled_from(VERBS)).map(json.dumps)
)
def test_whatever_is_no_command_is_refused_on_one_line(text):
    message = ""
    try:
        read_command(text)
    except LiveError as refused:
        message = str(refused)
    assert len(message.splitlines()) <= 1
    assert len(message) < 400


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({}, "do: missing"),
        ({"do": "fly"}, 'do: got "fly", expected one of walk, steer'),
        ({"do": "walk", "to": [1, 2]}, "people: missing"),
        ({"do": "walk", "person": 1}, "to: missing"),
        ({"do": "walk", "person": 1, "to": [1, 2, 3]}, "expected two numbers"),
        ({"do": "walk", "person": True, "to": [1, 2]}, "the number of a person"),
        ({"do": "walk", "person": -1, "to": [1, 2]}, "the number of a person"),
        ({"do": "walk", "people": [], "to": [1, 2]}, "a list of one or more"),
        ({"do": "walk", "person": 1, "to": [1, 2], "on": 1}, '"on": unknown field'),
        ({"do": "wait", "person": 1, "seconds": "long"}, "expected a number"),
        ({"do": "steer", "person": 1, "velocity": [10**400, 0]}, "expected a number"),
        ({"do": "open", "opening": 3}, "opening: got 3, expected a text"),
        ({"do": "leave", "person": 1, "exits": "door"}, "exits: got"),
        ({"do": "pause", "id": [1]}, "id: expected"),
    ],
)
def test_a_wrong_command_is_told_what_was_expected(fields, message):
    with pytest.raises(LiveError) as refused:
        read_command(json.dumps(fields))
    assert message in str(refused.value)


def test_numbers_that_are_not_finite_are_refused():
    with pytest.raises(LiveError, match="NaN, expected finite numbers"):
        read_command('{"do": "wait", "person": 1, "seconds": NaN}')


def do(run, verb, **fields):
    _, command = read_command(json.dumps({"do": verb, **fields}))
    return command(run)


def steps(run, seconds):
    for _ in range(round(seconds * 30)):
        run.step()


@pytest.fixture
def room():
    """A room with a door in its right wall and a wall with a gap in its middle."""
    wall = "POLYGON ((4.9 0, 5.1 0, 5.1 6, 4.9 6, 4.9 0))"
    plan = FloorPlan(
        "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))",
        exits=[Exit("door", (10, 3.5), (10, 4.5)), Exit("back", (0, 3.5), (0, 4.5))],
        gates=[Gate("gap", (5, 6), (5, 8))],
        obstacles=[wall],
    )
    return Run(model_of(plan, shipped_map(), record=False))


def place_of(run, row):
    return np.array([run.model.crowd.x[row], run.model.crowd.y[row]])


def test_people_walk_round_a_wall_to_a_place_stay_and_go_on(room):
    row = put(room.model, 2.0, 3.0).row
    do(room, "walk", person=row, to=[8.0, 4.0], stay=8)
    # By way of the gap it is hypot(2.9, 3) + 0.2 + hypot(2.9, 2) = 7.9 m; nobody walks at 2 m/s.
    steps(room, 3.9)
    assert math.dist(place_of(room, row), (8.0, 4.0)) > 0.4
    steps(room, 8.1)
    assert math.dist(place_of(room, row), (8.0, 4.0)) < 0.5
    steps(room, 14.0)
    assert not room.model.crowd.active[row]


def test_people_stay_at_a_place_until_told_otherwise(room):
    row = put(room.model, 2.0, 4.0).row
    do(room, "walk", person=row, to=[3.0, 4.0])
    steps(room, 20.0)
    assert math.dist(place_of(room, row), (3.0, 4.0)) < 0.5
    do(room, "leave", person=row, exits=["door"])
    steps(room, 3.0)
    assert place_of(room, row)[1] > 4.5
    steps(room, 12.0)
    assert room.model.inside == 0


def test_several_stand_round_the_place_to_which_they_were_sent(room):
    rows = [put(room.model, 1.0 + k, 1.0).row for k in range(3)]
    do(room, "walk", people=rows, to=[2.5, 6.0])
    steps(room, 12.0)
    places = np.array([place_of(room, row) for row in rows])
    assert (np.hypot(*(places - (2.5, 6.0)).T) < 1.0).all()
    before = places.copy()
    steps(room, 2.0)
    assert (np.hypot(*(np.array([place_of(room, row) for row in rows]) - before).T) < 0.3).all()


def test_a_place_without_a_way_is_one_to_wait_for(room):
    row = put(room.model, 2.0, 3.0).row
    do(room, "close", opening="gap")
    do(room, "walk", person=row, to=[8.0, 4.0])
    steps(room, 4.0)
    assert math.dist(place_of(room, row), (2.0, 3.0)) < 0.3
    do(room, "open", opening="gap")
    steps(room, 14.0)
    assert math.dist(place_of(room, row), (8.0, 4.0)) < 0.5


@pytest.mark.parametrize("place", [[5.0, 3.0], [-1.0, 3.0], [9.95, 1.0]])
def test_nobody_is_sent_into_a_wall(room, place):
    row = put(room.model, 2.0, 1.0).row
    with pytest.raises(LiveError, match="expected a place with room for the body"):
        do(room, "walk", person=row, to=place)


def test_people_wait(room):
    row = put(room.model, 2.0, 4.0).row
    do(room, "wait", person=row, seconds=4)
    steps(room, 3.9)
    assert math.dist(place_of(room, row), (2.0, 4.0)) < 0.3
    steps(room, 5.0)
    assert not room.model.crowd.active[row]


def test_people_wait_on_their_way_to_a_place(room):
    row = put(room.model, 1.0, 1.0).row
    do(room, "walk", person=row, to=[1.0, 6.0])
    do(room, "wait", person=row, seconds=3)
    steps(room, 3.0)
    assert math.dist(place_of(room, row), (1.0, 1.0)) < 0.3
    steps(room, 9.0)
    assert math.dist(place_of(room, row), (1.0, 6.0)) < 0.5
    do(room, "release", person=row)
    steps(room, 9.0)
    assert not room.model.crowd.active[row]


def test_doors_close_and_open(room):
    do(room, "close", opening="back")
    assert not room.model.floor_plan.is_open("back")
    do(room, "open", opening="back")
    assert room.model.floor_plan.is_open("back")
    with pytest.raises(MobilityError, match="there is no gate or exit 'front'"):
        do(room, "open", opening="front")


def test_people_are_added(room):
    added = do(room, "add", positions=[[1, 1], [2, 1]], exits=["door"], speed=1.1, heading=0.5)
    assert added == {"people": [0, 1]}
    first = room.model.space.active_agents[0]
    assert (first.exits, first.preferred_speed, first.heading) == (("door",), 1.1, 0.5)
    with pytest.raises(MobilityError):
        do(room, "add", positions=[[1, 1]])
    with pytest.raises(LiveError, match='type: got "giant", expected one of'):
        do(room, "add", positions=[[1, 3]], type="giant")
    assert room.model.inside == 2


def test_a_command_to_somebody_who_is_not_there_gives_nobody_an_order(room):
    row = put(room.model, 2.0, 4.0).row
    with pytest.raises(LiveError, match="person 5: expected somebody inside"):
        do(room, "walk", people=[row, 5], to=[3.0, 3.0])
    steps(room, 6.0)
    assert not room.model.crowd.active[row]


def test_somebody_is_steered_and_let_go(room):
    row = put(room.model, 2.0, 4.0, heading=math.pi / 2).row
    do(room, "steer", person=row, velocity=[0.0, 1.0])
    steps(room, 3.0)
    x, y = place_of(room, row)
    # 1 m/s but for the first steps.
    assert abs(x - 2.0) < 0.3
    assert 2.0 < y - 4.0 < 3.1
    do(room, "steer", person=row, velocity=[0.0, 0.0])
    steps(room, 2.0)
    stopped = place_of(room, row)
    steps(room, 2.0)
    assert math.dist(place_of(room, row), stopped) < 0.1
    do(room, "release", person=row)
    steps(room, 8.0)
    assert not room.model.crowd.active[row]


def test_nobody_is_steered_faster_than_anybody_walks(room):
    row = put(room.model, 2.0, 4.0).row
    with pytest.raises(LiveError, match="velocity: 20 m/s, expected at most 10"):
        do(room, "steer", person=row, velocity=[12.0, 16.0])


def way_through_a_crowd(seed, *, steered):
    """Metres that somebody gets on in 10 s, at 1 m/s, among people who stand in a corridor."""
    plan = FloorPlan("POLYGON ((0 0, 12 0, 12 2, 0 2, 0 0))", exits=[Exit("e", (12, 0), (12, 2))])
    model = model_of(plan, shipped_map(), record=False)
    run, rng = Run(model), np.random.default_rng(seed)
    walker = put(model, 1.0, 1.0, preferred_speeds=1.0).row
    spots = plan.random_points(20, rng, spacing=0.6, clearance=0.3, avoid=[(1.0, 1.0)])
    standing = [person.row for person in model.add_pedestrians(spots[spots[:, 0] > 2.0])]
    do(run, "wait", people=standing, seconds=100)
    if steered:
        do(run, "steer", person=walker, velocity=[1.0, 0.0])
    steps(run, 10.0)
    return place_of(run, walker)[0] - 1.0


def test_the_crowd_makes_way_for_somebody_who_is_steered():
    # A person who is not steered goes round those who stand. They make way for a person who is
    # steered, which takes some seconds of the ten.
    own, steered = (
        np.mean([way_through_a_crowd(seed, steered=each) for seed in range(1, 5)])
        for each in (False, True)
    )
    assert own + 1.0 < steered > 7.0


def test_those_whom_a_client_steers_are_let_go_when_it_goes(room):
    one, other = put(room.model, 2.0, 4.0).row, put(room.model, 2.0, 1.0).row
    for client, row in (("a", one), ("b", other)):
        _, command = read_command(
            json.dumps({"do": "steer", "person": row, "velocity": [0, 0]}), client
        )
        command(room)
    room.drop("a")
    assert room.orders.steered().tolist() == [other]


def test_orders_leave_everybody_else_as_they_were(room):
    plain = model_of(room.model.floor_plan, shipped_map(), record=False)
    for model in (plain, room.model):
        for k in range(5):
            put(model, 1.0 + 0.7 * k, 1.0)
    for _ in range(60):
        plain.step()
        room.step()
    np.testing.assert_array_equal(plain.crowd.x[:5], room.model.crowd.x[:5])
    np.testing.assert_array_equal(plain.crowd.heading[:5], room.model.crowd.heading[:5])


@pytest.mark.parametrize("rate", [0, 4, 60, -30])
def test_a_rate_that_does_not_divide_30_is_refused(rate):
    plan = FloorPlan("POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0))", exits=[Exit("e", (4, 1), (4, 2))])
    with pytest.raises(LiveError, match="expected 1, 2, 3, 5, 6, 10, 15 or 30"):
        Run(model_of(plan, shipped_map()), rate)
