"""Routes chosen in buildings: over stairs and escalators, and by lifts."""

import math

import pytest
from mesa_mobility.behaviors import (
    BlockedWays,
    CongestionRouting,
    FamiliarRoutes,
    NearestExit,
    Sign,
    Signs,
)
from mesa_mobility.behaviors.routes.flows import flows_through, in_lift, on_escalator, on_stairs

from mesa_mobility import (
    Building,
    Escalator,
    Exit,
    Level,
    Lift,
    PedestrianModel,
    PedestrianType,
    Stairs,
    Trajectories,
)
from mesa_mobility.buildings import ON_STAIRS
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.results import climbs
from tests.fixtures.buildings import HALL, RISE
from tests.fixtures.maps import strider
from tests.fixtures.scenes import model_of, statues

WHEELCHAIR, ADULT = PedestrianType.named("wheelchair_manual"), PedestrianType.named("able_bodied")
GROUND = Level(0, HALL, exits=[Exit("west", (0, 3), (0, 5)), Exit("east", (24, 3), (24, 5))])
FIRST = Level(1, HALL, elevation=RISE)
SOUTH = ((8, 1.2), (8, 0))
NORTH = ((8, 8), (8, 6.8))
NARROW = ((8, 1), (8, 0))


def straight(name, head, upper=FIRST, lower=GROUND):
    return Stairs.straight(name, upper, lower, head=head, risers=18, tread=0.29)


def lifted(**given):
    """Two stairs side by side, 1.2 m wide and 5.6 m apart, and a lift."""
    lift = Lift("lift", [0, 1], ((20.0, 6.5), (20.9, 6.5)), **given)
    return Building(
        [GROUND, FIRST], [straight("south", SOUTH), straight("north", NORTH)], lifts=[lift]
    )


def model_in(building, choice, rng=1):
    """A model with a person in a wheelchair and 19 adults upstairs, in the west."""
    model = PedestrianModel(
        building, pedestrian_types=[WHEELCHAIR, ADULT], record=True, rng=rng, target_choice=choice
    )
    model.add_pedestrians(building.places([(4.0, 4.0)], 1), type_index=[0])
    crowd = [(1.0 + 0.7 * (k // 5), 1.5 + 0.7 * (k % 5)) for k in range(20) if k != 12]
    model.add_pedestrians(building.places([(x, y) for x, y in crowd if x < 3.5], 1), type_index=1)
    return model


# -- what people do ----------------------------------------------------------------------------


def test_wheelchairs_take_the_lift_and_climbers_go_on_over_the_stairs():
    building = lifted()
    model = model_in(building, CongestionRouting(interval=0.3))
    wheelchair, *adults = model.agents
    assert wheelchair.route == ("lift at level 1",)
    ways = {("south after", "south before"), ("north after", "north before")}
    assert {person.route for person in adults} == ways
    model.run(max_seconds=90)
    assert model.inside == 0
    tracks = Trajectories.of(model)
    assert model.lifts.carried.tolist() == [1]
    assert ON_STAIRS not in tracks.level[tracks.person == wheelchair.row]
    taken = climbs(tracks, building)
    assert sum(len(each.person) for each in taken.values()) == len(adults)
    assert all((each.came_by != each.left_by).all() for each in taken.values())


def test_escalators_are_left_at_their_far_end():
    belt = Escalator.straight("belt", 1, 0, NARROW, length=5.3, direction="down", speed=0.65)
    building = Building([GROUND, FIRST], [belt, straight("north", NORTH)])
    choice = FamiliarRoutes(["belt"], share=1.0)
    model = model_in(building, choice)
    people = list(model.agents)
    assert [person.route for person in people[:2]] == [(), ("belt after", "belt before")]
    model.run(max_seconds=60)
    assert model.escalators.carried.tolist() == [len(people) - 1]
    assert climbs(Trajectories.of(model), building)["north"].person.size == 0


@pytest.mark.parametrize(
    # From (2, 2.7) to the corner of the south stair at (8, 1) are 6.2 m, to that of the north one
    # at (8, 7) 7.4 m: 1.1 s more at 1 m/s. Beyond, both are alike. Down 1.2 m of stairs come
    # 1.32 persons/s: one takes 0.8 s, two take 1.5 s. Through doors two would take 0.8 s.
    ("queue", "expected"),
    [(0, "south"), (1, "south"), (2, "north")],
)
def test_people_take_the_stair_with_fewer_people_before_it(queue, expected):
    building = Building(
        [Level(0, HALL, exits=GROUND.exits[1:]), FIRST],
        [straight("south", SOUTH), straight("north", NORTH)],
    )
    model = model_of(building, [strider(), statues()], target_choice=CongestionRouting())
    if queue:
        places = building.places([(7.0, 0.3), (7.0, 0.9)][:queue], 1)
        model.add_pedestrians(places, route=["south after", "south before"], type_index=1)
    [person] = model.add_pedestrians(building.places([(2.0, 2.7)], 1), preferred_speeds=[1.0])
    assert person.route == (f"{expected} after", f"{expected} before")


def test_a_closed_stair_is_no_way_for_wheelchairs_who_have_not_seen_it():
    building = lifted()
    building.close("south")
    targets = []
    for choice in (NearestExit(), BlockedWays(sight=1.0)):
        model = PedestrianModel(
            building, pedestrian_types=[WHEELCHAIR, ADULT], rng=1, target_choice=choice
        )
        places = building.places([(4.0, 2.0), (4.0, 3.0)], 1)
        targets.append([each.target for each in model.add_pedestrians(places, type_index=[0, 1])])
    (wheelchair, adult), (same, misled) = targets
    assert same == pytest.approx(wheelchair)
    # The adult goes north instead of south only if they know.
    assert adult[1] > 3.0 > misled[1]


@pytest.mark.parametrize("choice", [NearestExit, CongestionRouting])
def test_a_run_goes_on_from_a_checkpoint(choice, tmp_path):
    model = model_in(lifted(everybody=True), choice())
    model.run(max_seconds=8)
    model.save(tmp_path / "half.zip")
    loaded = PedestrianModel.load(
        tmp_path / "half.zip",
        floor_plan=lifted(everybody=True),
        pedestrian_types=[WHEELCHAIR, ADULT],
        target_choice=choice(),
    )
    for each in (model, loaded):
        each.run(max_seconds=14)
    one, other = Trajectories.of(model), Trajectories.of(loaded)
    assert one.x.tobytes() == other.x.tobytes()
    assert model.inside > 0


# -- how many pass -----------------------------------------------------------------------------


def test_flows_are_those_of_the_literature():
    # IMO MSC.1/Circ.1533: 1.1 persons/(s m) down stairs, and 0.88 up.
    assert on_stairs(1.2, down=True) == pytest.approx(1.32)
    assert on_stairs(1.2, down=False) == pytest.approx(1.056)
    belt = Escalator.straight("belt", 1, 0, ((8, 8), (8, 7.0)), length=5.3, direction="up")
    lift = Lift("lift", [0, 1], ((20.0, 6.5), (20.9, 6.5)), capacity=8, speed=1.02, door_s=2.5)
    plan = Building([GROUND, FIRST], [straight("south", SOUTH), belt], lifts=[lift]).floor_plan
    # A step is 0.4 m deep: 0.75 m/s have 1.875 persons/s step on. A ride takes 2 * 2.5 s for doors
    # and 3.06 m / 1.02 m/s = 3 s: 8 people in 16 s.
    assert on_escalator(plan.seams[1].belt) == pytest.approx(1.875)
    assert in_lift(plan.shafts[0]) == pytest.approx(0.5)
    # People walk down the stair to the right, and leave 2 m wide doors at 2.23 * 2 - 0.155.
    names = ["south after", "south before (copy)", "belt before", "lift at level 1", "west"]
    ways = [(1.0, 0.0), (-1.0, 0.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)]
    expected = [1.32, 1.056, 1.875, 0.5, 4.305]
    assert flows_through(plan, names, ways).tolist() == pytest.approx(expected)


# -- what people know --------------------------------------------------------------------------


def test_stairs_have_names_in_familiar_ways():
    building = lifted()
    choice = FamiliarRoutes(["north"], share=1.0)
    model = PedestrianModel(
        building, pedestrian_types=[WHEELCHAIR, ADULT], rng=1, target_choice=choice
    )
    places = [*building.places([(3.0, 2.0), (3.0, 4.0)], 1), *building.places([(3.0, 4.0)], 0)]
    wheelchair, upstairs, downstairs = model.add_pedestrians(places, type_index=[0, 1, 1])
    routes = [person.route for person in (wheelchair, upstairs, downstairs)]
    assert routes == [(), ("north after", "north before"), ()]
    choice.know([upstairs, wheelchair], ["south"])
    choice.know([wheelchair], ["lift"])
    model.run(max_seconds=2)
    assert upstairs.route == ("south after", "south before")
    assert wheelchair.route == ("lift at level 1",)
    with pytest.raises(FloorPlanError, match="'nort', did you mean 'north'"):
        choice.know([upstairs], ["nort"])
    with pytest.raises(FloorPlanError, match="no stairs, ramp, escalator, lift, gate or exit 'no'"):
        PedestrianModel(building, target_choice=FamiliarRoutes(["no"])).add_pedestrians(places)


def test_people_know_the_part_of_a_way_between_them_and_the_entrance():
    second = Level(2, HALL, elevation=2 * RISE)
    low, high = straight("low", SOUTH), straight("high", NORTH, second, FIRST)
    building = Building(
        [GROUND, FIRST, second],
        [low, high],
        lifts=[Lift("lift", [0, 1, 2], ((20.0, 6.5), (20.9, 6.5)))],
    )
    came = ["low", "high"]
    down = ("high after", "high before", "low after", "low before")
    assert [building.way_out(came, k) for k in (0, 1, 2)] == [(), down[2:], down]
    assert building.way_out(came, 2, climbs=False) == ()
    assert building.way_out(["lift"], 2, climbs=False) == ("lift at level 2",)
    # Adults do not use this lift.
    assert building.way_out(["lift"], 2) == ()
    # The lift that they know from the way to the first level stops at the second, too.
    assert building.way_out(["lift", "high"], 2, climbs=False) == ("lift at level 2",)
    # Nobody came from the second level, which has no exit.
    assert building.way_out(["high"], 1) == ()


def test_people_do_not_go_up_to_the_exit_by_which_they_did_not_come():
    bridge = Level(1, HALL, elevation=RISE, exits=[Exit("bridge", (0, 3), (0, 5))])
    building = Building([GROUND, bridge], [straight("main", SOUTH, bridge)])
    down = ("main after", "main before")
    assert [building.way_out(["west", "main"], k) for k in (0, 1)] == [(), down]
    assert [building.way_out(["bridge", "main"], k) for k in (0, 1)] == [down[::-1], ()]
    with pytest.raises(FloorPlanError, match="over 'main': levels 0, 1 have exits, expected the"):
        building.way_out(["main"], 0)
    with pytest.raises(FloorPlanError, match="exit 'west', expected an exit only as the first"):
        building.way_out(["main", "west"], 1)
    model = PedestrianModel(
        building, pedestrian_types=[ADULT], target_choice=FamiliarRoutes(["west", "main"], share=1)
    )
    people = model.add_pedestrians([building.places([(3.0, 4.0)], k)[0] for k in (0, 1)])
    assert [person.route for person in people] == [(), down]
    ambiguous = PedestrianModel(building, target_choice=FamiliarRoutes(["main"]))
    with pytest.raises(FloorPlanError, match="expected the exit by which people came in"):
        ambiguous.add_pedestrians(building.places([(3.0, 4.0)], 1))


def test_people_without_a_way_stand_in_no_queue():
    # Each stair leads towards an exit of its own; at y = 3.7 the south one is nearer by a little.
    stairs = [straight("south", SOUTH), straight("north", ((16, 6.8), (16, 8)))]
    building = Building([GROUND, FIRST], stairs)
    climber = PedestrianType(mobility_map=strider(), name="climber")
    other = PedestrianType(mobility_map=statues(), name="other", climbs=False)
    model = PedestrianModel(
        building, pedestrian_types=[climber, other], target_choice=CongestionRouting(), rng=1
    )
    # In the plane, the nearest exit of those upstairs is the east one, towards which south leads.
    there = [(1.0 + 0.8 * (k % 4), 2.0 + 0.8 * (k // 4)) for k in range(12)]
    model.add_pedestrians(building.places(there, 1), type_index=1)
    [person] = model.add_pedestrians(building.places([(12.0, 3.7)], 1))
    assert person.route == ("south after", "south before")


@pytest.mark.parametrize(
    ("gates", "who"),
    [(("north after", "north before"), ADULT), (("lift at level 1",), WHEELCHAIR)],
)
def test_signs_send_only_people_who_can_take_their_way(gates, who):
    building = lifted()
    [[x, y]] = building.places([(23.9, 4.0)], 1)
    sign = Sign((x, y), math.pi, gates)
    choice = Signs([sign], noticed=1.0, followed=1.0, interval=0.1)
    model = PedestrianModel(
        building, pedestrian_types=[WHEELCHAIR, ADULT], target_choice=choice, rng=1
    )
    places = building.places([(2.0, 3.0), (2.0, 5.0)], 1)
    people = model.add_pedestrians(places, type_index=[0, 1], headings=[0.0, 0.0])
    model.run(max_seconds=2)
    for person, kind in zip(people, (WHEELCHAIR, ADULT), strict=True):
        assert (person.route == gates) == (kind is who)


def test_nobody_goes_back_on_an_escalator():
    up = Escalator.straight("up", 1, 0, NARROW, length=5.3, direction="up")
    building = Building([GROUND, FIRST], [up, straight("north", NORTH)])
    assert building.way_out(["up"], 1) == ()
    assert building.way_out(["north"], 1) == ("north after", "north before")
