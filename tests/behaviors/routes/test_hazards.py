"""Hazards that grow are kept away from and gone round."""

import math

import numpy as np
import pytest
import shapely
from mesa_mobility.behaviors import Hazard, Hazards
from shapely import Point, box

from mesa_mobility import Exit, FloorPlan, Gate, PedestrianModel
from mesa_mobility.errors import FloorPlanError, ModelError
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import advance, corridor, model_of, put, same_rows


def hall(**keywords):
    """20 m by 12 m, with exits in the middle of its short sides."""
    exits = [Exit("west", (0, 5), (0, 7)), Exit("east", (20, 5), (20, 7))]
    return FloorPlan(box(0, 0, 20, 12), exits=exits, **keywords)


def round_a_disc(before, radius, behind, up):
    """Length of the shortest way past a disc, metres: two tangents and an arc.

    It begins ``before`` metres in front of the middle, and ends ``behind`` metres beyond it and
    ``up`` metres to the side.
    """
    far = math.hypot(behind, up)
    angle = math.pi - math.atan2(up, behind)
    arc = angle - math.acos(radius / before) - math.acos(radius / far)
    return math.sqrt(before**2 - radius**2) + math.sqrt(far**2 - radius**2) + radius * arc


def test_a_disc_grows_at_its_speed():
    hazard = Hazard((10.0, 6.0), speed=0.5, begins=4.0)
    assert hazard.at(3.9) is None
    # The area of a circle of 3 m, and that of a polygon of 16 sides around it.
    assert 28.27 <= hazard.at(10.0).area <= 28.27 * 1.014
    room = Hazard((10.0, 6.0), speed=0.5, within=box(9, 5, 20, 12))
    assert room.at(1000.0).area == pytest.approx(77.0)
    assert Hazard(box(0, 0, 2, 1)).at(50.0).area == pytest.approx(2.0)


@pytest.mark.parametrize("margin", [0.0, 1.0])
def test_the_way_round_a_disc_is_two_tangents_and_an_arc(margin):
    hazard = Hazard(Point(10, 6).buffer(2.0, quad_segs=64))
    model = model_of(hall(), strider(), target_choice=Hazards([hazard], margin=margin))
    person = put(model, 4.0, 6.0, exits=["east"])
    # It may end anywhere in the exit. Bodies of 0.15 m keep up to 0.05 m more than that, and
    # corners of a polygon around a circle are up to 2 % farther out.
    least = round_a_disc(6.0, 2.0 + margin, 10.0, 1.0)
    most = round_a_disc(6.0, 1.02 * (2.0 + margin) + 0.2, 10.0, 0.0)
    assert least < model.crowd.route[person.row] < most


@pytest.mark.parametrize("seed", [1, 3, 6])
def test_nobody_enters_a_hazard_that_leaves_a_way(seed):
    hazard = Hazard((10.0, 6.0), speed=0.1)
    choice = Hazards([hazard])
    model = model_of(hall(), shipped_map(), target_choice=choice, frames_per_step=3, rng=seed)
    places = [(2.0 + 0.7 * i, 3.0 + 0.8 * k) for i in range(4) for k in range(8)]
    model.add_pedestrians(places, exits=["east"])
    nearest = []
    while model.inside and model.elapsed < 60.0:
        model.step()
        rows = model.rows
        away = np.hypot(model.crowd.x[rows] - 10.0, model.crowd.y[rows] - 6.0)
        nearest.append((away - 0.1 * model.elapsed).min(initial=np.inf))
    assert model.inside == 0
    assert choice.enclosed == []
    assert min(nearest) > 0.0
    assert same_rows(model)


def test_people_take_the_exit_that_is_clear():
    model = model_of(
        hall(), strider(), target_choice=Hazards([Hazard((20.0, 6.0), speed=1.0, begins=2.0)])
    )
    person = put(model, 12.0, 6.0)
    assert person.target[0] > 12.0
    advance(model, 92)
    # At 3.1 s, 1.5 m of smoke and 1 m of margin are before the exit to the east.
    assert person.target[0] < 12.0
    assert model.crowd.route[person.row] > 13.0


def test_who_is_overtaken_leaves_by_the_nearest_edge():
    model = model_of(hall(), strider(), target_choice=Hazards([Hazard(box(6, 0, 17, 12))]))
    one, other = model.add_pedestrians([(8.0, 6.0), (15.5, 6.0)])
    assert one.target == pytest.approx([5.0 - 0.3, 6.0], abs=0.3)
    assert other.target == pytest.approx([18.0 + 0.3, 6.0], abs=0.3)
    # 3.3 m out of it, and 4.7 m to the exit.
    assert model.crowd.route[one.row] == pytest.approx(8.0, abs=0.2)


def test_the_enclosed_go_through_by_the_shortest_way():
    choice = Hazards([Hazard(box(9, 0, 11, 4))])
    model = model_of(corridor(), shipped_map(), target_choice=choice, frames_per_step=3)
    person = put(model, 3.0, 2.0)
    assert choice.enclosed == [person.row]
    assert model.crowd.route[person.row] == pytest.approx(17.0, abs=0.05)
    model.run(max_seconds=40)
    assert model.inside == 0
    assert choice.enclosed == []


def test_a_hazard_that_fills_the_floor_ends_no_run():
    choice = Hazards([Hazard((10.0, 2.0), speed=5.0)])
    model = model_of(corridor(), shipped_map(), target_choice=choice, frames_per_step=3)
    model.add_pedestrians([(3.0, 2.0), (5.0, 2.0)])
    model.run(max_seconds=60)
    assert model.inside == 0


def test_where_the_margin_leaves_no_way_people_pass_within_it():
    # 1.5 m are left beside it.
    choice = Hazards([Hazard(box(9, 1.5, 11, 4))])
    model = model_of(corridor(), strider(), target_choice=choice)
    person = put(model, 3.0, 3.5)
    assert choice.enclosed == []
    assert person.target[1] < 1.5


def test_routes_by_gates_and_wide_bodies_go_round_too():
    plan = hall(gates=[Gate("line", (15, 0), (15, 12))])
    model = model_of(
        plan,
        [strider(), strider(core_radius=0.35)],
        target_choice=Hazards([Hazard(box(9, 2, 11, 12))], margin=0.5),
    )
    walker = put(model, 4.0, 8.0, route=["line"], exits=["east"])
    wheelchair = put(model, 6.0, 8.0, exits=["east"], type_index=1)
    for person in (walker, wheelchair):
        assert person.target[1] < 1.7


def test_hazards_may_come_while_a_model_runs():
    choice = Hazards()
    model = model_of(hall(), strider(), target_choice=choice)
    person = put(model, 15.0, 6.0)
    assert person.target[0] > 15.0
    choice.hazards.append(Hazard((19.5, 6.0), speed=0.2))
    advance(model, 46)
    assert person.target[0] < 15.0


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        ({"area": "POINT (1 2)"}, "hazard: area 'POINT"),
        ({"area": (1.0, math.nan)}, "hazard: area"),
        ({"area": shapely.LineString([(0, 0), (1, 1)])}, "expected a valid shapely Polygon"),
        ({"speed": -1.0}, r"hazard: speed -1.0, expected 0 m/s or more"),
        ({"begins": math.inf}, "hazard: begins inf"),
        ({"within": Point(1, 2)}, "hazard: within"),
    ],
)
def test_hazards_that_are_none_are_refused(wrong, text):
    with pytest.raises(ModelError, match=text):
        Hazard(**{"area": (1.0, 2.0), **wrong})
    with pytest.raises(ModelError, match="margin -1, expected 0 m or more"):
        Hazards(margin=-1)


# -- obstacles that cut people off --------------------------------------------------------------

WALL = box(8, 0, 8.5, 4)


def test_an_obstacle_may_cut_people_off_where_the_caller_says_so():
    plan = corridor()
    model = PedestrianModel(plan, mobility_map=shipped_map(), rng=2)
    cut, free = model.add_pedestrians([(3.0, 2.0), (12.0, 2.0)])
    with pytest.raises(FloorPlanError, match="disconnected from every exit"):
        plan.add_obstacle(WALL)
    number = plan.add_obstacle(WALL, cut_off=True)
    assert plan.cut_off
    model.run()
    assert list(model.agents) == [cut]
    assert free.row not in model.rows
    assert model.stall_reason == "nobody inside has a way to go"
    assert cut.position[0] < 8.0
    plan.remove_obstacle(number)
    model.run(max_seconds=model.elapsed + 40)
    assert model.inside == 0


def test_a_plan_with_a_piece_cut_off_is_written_and_read():
    plan = corridor()
    plan.add_obstacle(WALL, cut_off=True)
    again = FloorPlan.from_geojson(plan.to_geojson())
    assert again.cut_off
    assert again.free.equals(plan.free)
    other = corridor()
    other.restore(plan.state())
    assert other.free.equals(plan.free)
    wrong = plan.to_geojson()
    wrong["features"][0]["properties"]["cut_off"] = "yes"
    with pytest.raises(FloorPlanError, match="cut_off must be true or false, found 'yes'"):
        FloorPlan.from_geojson(wrong)


def test_an_altered_plan_leaves_the_first_as_it_is():
    plan = corridor()
    other = plan.altered(obstacles=[WALL], closed=["east"])
    assert plan.is_open("east")
    assert not other.is_open("east")
    assert len(plan.walls) == 3
    assert plan.free.area == pytest.approx(80.0)
    assert other.free.area == pytest.approx(78.0)
    assert other.obstacles == {0: WALL}
    assert plan.add_obstacle(box(1, 1, 2, 2)) == 0
    with pytest.raises(FloorPlanError, match="no gate or exit 'up'"):
        plan.altered(closed=["up"])
