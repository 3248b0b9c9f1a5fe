import numpy as np
import pytest
import shapely
from scipy.spatial.distance import pdist
from shapely import box

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, FloorPlan, Gate
from mesa_mobility.floorplan.poisson_disk import lattice


def wall_distance(plan: FloorPlan, points: np.ndarray) -> np.ndarray:
    lines = shapely.multilinestrings(shapely.linestrings(plan.walls.reshape(-1, 2, 2)))
    return shapely.distance(lines, shapely.points(points))


@pytest.mark.parametrize(
    ("name", "n", "spacing", "clearance"),
    [
        ("room", 40, 0.8, 0.3),
        ("room", 180, 0.4, 0.2),  # 2.5 persons/m² of the 9.6 m x 7.6 m where they can stand
        ("room", 420, 0.4, 0.2),  # 5.8 persons/m²: more than points thrown at random can reach
        ("hall", 300, 0.4, 0.2),
        ("bend", 120, 0.4, 0.2),
        ("l_corridor", 30, 0.5, 0.0),
    ],
)
def test_everybody_has_room(plans, name: str, n: int, spacing: float, clearance: float) -> None:
    plan = plans[name]()
    points = plan.random_points(n, np.random.default_rng(3), spacing=spacing, clearance=clearance)
    assert points.shape == (n, 2)
    assert plan.contains(points).all()
    assert wall_distance(plan, points).min() >= clearance
    assert pdist(points).min() >= spacing


def test_the_same_state_gives_the_same_places(plans) -> None:
    for n in (50, 420):
        first, second, other = (
            plans["room"]().random_points(
                n, np.random.default_rng(seed), spacing=0.4, clearance=0.2
            )
            for seed in (7, 7, 8)
        )
        assert (first == second).all()
        assert not (first == other).any()


def test_people_are_spread_over_the_whole_area(plans) -> None:
    points = plans["corridor"]().random_points(
        400, np.random.default_rng(5), spacing=0.1, clearance=0.0
    )
    thirds = np.histogram(points[:, 0], bins=[0, 20 / 3, 40 / 3, 20])[0]
    # 133 expected in each third, standard deviation 9.4.
    assert (abs(thirds - 400 / 3) < 40).all()


def test_a_crowded_lattice_is_shaken(plans) -> None:
    region = shapely.box(0, 0, 10, 10)

    def fits(points: np.ndarray) -> np.ndarray:
        return shapely.contains_xy(region, points[:, 0], points[:, 1])

    points = lattice(region, fits, 300, np.random.default_rng(1), 0.4, np.empty((0, 2)))
    assert len(points) == 300
    assert pdist(points).min() >= 0.4
    # 300 places in 100 m² are about 0.62 m apart: people stray up to 0.1 m.
    nearest = np.sort(np.linalg.norm(points[:, None] - points, axis=2), axis=1)[:, 1]
    assert nearest.std() > 0.02


def test_places_keep_from_others_and_within(plans) -> None:
    others = np.array([[5.0, 4.0], [6.0, 4.0]])
    part = box(4, 3, 10, 8)
    points = plans["room"]().random_points(
        60, np.random.default_rng(2), spacing=0.5, clearance=0.2, avoid=others, within=part
    )
    assert np.hypot(*(points[:, None] - others).reshape(-1, 2).T).min() >= 0.5
    assert shapely.contains_xy(part, *points.T).all()


def test_closed_gates_are_walls(plans) -> None:
    plan = FloorPlan(
        box(0, 0, 4, 4),
        exits=[Exit("e", (0, 1), (0, 2))],
        gates=[Gate("door", (2, 0), (2, 4))],
    )
    plan.close_gate("door")
    points = plan.random_points(20, np.random.default_rng(0), spacing=0.3, clearance=0.4)
    assert abs(points[:, 0] - 2).min() >= 0.4


def test_nobody_starts_in_an_exit(plans) -> None:
    points = plans["corridor"]().random_points(
        200, np.random.default_rng(0), spacing=0.3, clearance=0.4
    )
    assert points[:, 0].min() >= 0.4
    assert points[:, 0].max() <= 19.6


def test_nobody_is_easily_placed(plans) -> None:
    rng = np.random.default_rng(0)
    assert plans["room"]().random_points(0, rng, spacing=1, clearance=9).shape == (0, 2)


@pytest.mark.parametrize(
    ("n", "options", "says"),
    [
        (5, {"spacing": 0.4, "clearance": 4.1}, "leaves room for 0 of 5 people"),
        (5, {"spacing": 0.4, "clearance": 0.2, "within": box(50, 50, 51, 51)}, "for 0 of 5"),
        (-1, {"spacing": 0.4, "clearance": 0.2}, "need n >= 0"),
        (5, {"spacing": 0.0, "clearance": 0.2}, "spacing > 0"),
        (5, {"spacing": 0.4, "clearance": np.nan}, "clearance >= 0"),
    ],
)
def test_bad_wishes(plans, n: int, options: dict, says: str) -> None:
    with pytest.raises(FloorPlanError, match=says):
        plans["room"]().random_points(n, np.random.default_rng(0), **options)


def test_how_many_have_room_is_said(plans) -> None:
    # One fits, in a strip of 0.2 m x 0.2 m; two would have to be 1 m apart.
    tiny = FloorPlan(box(0, 0, 1, 1), exits=[Exit("e", (0, 0.2), (0, 0.8))])
    with pytest.raises(
        FloorPlanError,
        match=r"room for 1 of 2 people, 1.0 m apart and 0.4 m from walls",
    ):
        tiny.random_points(2, np.random.default_rng(0), spacing=1.0, clearance=0.4)


@pytest.mark.parametrize("n", [10**6, 10**9, 10**15])
def test_room_for_millions_is_not_looked_for_where_there_is_none(n):
    plan = FloorPlan("POLYGON ((0 0, 4 0, 4 3, 0 3, 0 0))", exits=[Exit("out", (4, 1), (4, 2))])
    with pytest.raises(FloorPlanError, match=rf"leaves room for \d+ of {n} people"):
        plan.random_points(n, np.random.default_rng(1), spacing=0.5, clearance=0.3)


def pocket(gap: float, *, exits: tuple[Exit, ...] = (Exit("e", (0, 1), (0, 3)),)) -> FloorPlan:
    """10 m x 4 m, whose last 4 m lie behind a gap."""
    return FloorPlan(box(0, 0, 10, 4), exits=exits, obstacles=[box(5.8, 0, 6, 4 - gap)])


@pytest.mark.parametrize("clearance", [0.0, 0.1, 0.2, 0.4])
def test_nobody_is_put_where_no_way_leads_out(clearance) -> None:
    points = pocket(0.3).random_points(
        100, np.random.default_rng(0), spacing=0.2, clearance=clearance
    )
    assert points[:, 0].max() < 6.0
    assert points[:, 0].max() > 5.2


def test_people_are_put_behind_a_gap_that_they_pass() -> None:
    # Wider than a body with its clearance to walls, narrower than twice the clearance.
    points = pocket(0.4).random_points(100, np.random.default_rng(0), spacing=0.2, clearance=0.3)
    assert (points[:, 0] > 6.0).mean() > 0.2


def test_places_behind_closed_doors_have_a_way_out() -> None:
    door = Gate("door", (6, 0), (6, 4))
    plan = FloorPlan(box(0, 0, 10, 4), exits=[Exit("e", (0, 1), (0, 3))], gates=[door])
    plan.close_gate("door")
    plan.close_gate("e")
    points = plan.random_points(100, np.random.default_rng(0), spacing=0.2, clearance=0.2)
    assert (points[:, 0] > 6.0).mean() > 0.2


def test_all_places_count_where_none_has_a_way_out() -> None:
    narrow = pocket(0.3, exits=(Exit("e", (0, 1), (0, 1.25)),))
    for plan in (narrow, pocket(0.3)):
        points = plan.random_points(
            40, np.random.default_rng(0), within=box(6, 0, 10, 4), spacing=0.2, clearance=0.2
        )
        assert points[:, 0].min() > 6.0
