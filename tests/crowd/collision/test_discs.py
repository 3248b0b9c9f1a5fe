"""Bodies of several discs: what hits what, against distances between sampled poses."""

import numpy as np
import pytest
import shapely
from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan, PedestrianModel, PedestrianType
from mesa_mobility.crowd.planning.explanation import FREE, Watch
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.results import Trajectories, check_safety
from tests.fixtures.maps import shipped_map, strider

CHAIR = ((-0.25, 0.35), (0.0, 0.35), (0.25, 0.35))
"""1.2 m long and 0.7 m wide."""


def chair(discs=CHAIR, **keywords) -> PedestrianType:
    return PedestrianType(
        mobility_map=MobilityMap.named("wheelchair_manual"), name="chair", discs=discs, **keywords
    )


def walker() -> PedestrianType:
    return PedestrianType(mobility_map=shipped_map(), name="walker")


def room(width: float = 6.0, length: float = 8.0) -> FloorPlan:
    return FloorPlan(box(0, 0, length, width), exits=[Exit("out", (length, 0.0), (length, width))])


def two_rooms(door: float) -> FloorPlan:
    low, high = 2.0 - door / 2, 2.0 + door / 2
    floor = union_all([box(0, 0, 5, 4), box(5, low, 5.2, high), box(5.2, 0, 8, 4)])
    return FloorPlan(floor, exits=[Exit("out", (8, 1), (8, 3))])


def mixed(plan: FloorPlan, seed: int = 1, **keywords) -> PedestrianModel:
    """Four chairs and eight walkers."""
    model = PedestrianModel(
        plan, pedestrian_types=[chair(), walker()], rng=seed, record=True, **keywords
    )
    places = [(x, y) for x in (0.8, 2.2) for y in (0.8, 3.2)]
    model.add_pedestrians(places, type_index=0, preferred_speeds=0.9)
    places = [(x, y) for x in (3.2, 3.8, 4.4) for y in (0.5, 2.0, 3.5)][:8]
    model.add_pedestrians(places, type_index=1)
    return model


def placed(x, y, heading, discs):
    """(poses * discs, 3) x, y and radius of the discs of a body in some poses."""
    x, y, heading = np.atleast_1d(x, y, heading)
    return np.concatenate([
        np.column_stack([x + o * np.cos(heading), y + o * np.sin(heading), np.full(len(x), r)])
        for o, r in discs
    ])  # fmt: skip


def shape_of(model, row):
    kind = model.pedestrian_types[int(model.crowd.type_index[row])]
    return kind.discs or ((0.0, kind.core_radius),)


@pytest.mark.parametrize(
    ("discs", "core", "half_width", "bounding"),
    [
        (CHAIR, 0.35, 0.35, 0.6),
        # A person of 0.25 m who pushes a pram of 0.3 m: 0.25 m about the person are in the body.
        (((0.0, 0.25), (0.5, 0.3)), 0.25, 0.3, 0.8),
        # Of the foremost disc 0.1 m are about the position.
        (((-0.3, 0.35), (0.2, 0.3)), 0.1, 0.35, 0.65),
        (((0.0, 0.2),), 0.2, 0.2, 0.2),
    ],
)
def test_widths_follow_from_the_discs(discs, core, half_width, bounding):
    kind = chair(discs)
    assert kind.core_radius == pytest.approx(core)
    assert kind.half_width == pytest.approx(half_width)
    assert kind.bounding_radius == pytest.approx(bounding)


def test_discs_are_scaled_to_a_core_radius():
    kind = chair(core_radius=0.28)
    assert kind.half_width == pytest.approx(0.28)
    assert kind.bounding_radius == pytest.approx(0.48)


@pytest.mark.parametrize(
    ("discs", "message"),
    [
        (((0.0, 0.3),) * 4, "one to 3"),
        (((0.0, "a"),), "one to 3"),
        ((0.0, 0.3), "one to 3"),
        (((0.0, -0.3),), "radii of 0 to 1 m"),
        (((0.0, 0.3), (float("nan"), 0.3)), "offsets within 2 m"),
        (((0.0, 0.3), (0.7, 0.3)), "touch one another"),
        (((0.4, 0.3), (0.7, 0.3)), "over the person's position"),
    ],
)
def test_bodies_that_are_none_are_refused(discs, message):
    with pytest.raises(ModelError, match=message):
        chair(discs)


def test_a_single_disc_given_is_the_body_of_before():
    tracks = []
    for discs in ((), ((0.0, 0.14),)):
        kind = PedestrianType(
            mobility_map=strider(), core_radius=0.0 if discs else 0.14, discs=discs
        )
        model = PedestrianModel(room(), pedestrian_types=[kind], rng=4, record=True)
        model.add_pedestrians([(1.0, 1.0), (1.0, 2.0), (2.0, 1.5)])
        model.run(max_seconds=3.0)
        tracks.append(Trajectories.of(model))
    assert tracks[0].x.tobytes() == tracks[1].x.tobytes()
    assert tracks[0].discs is tracks[1].discs is None


@pytest.mark.thorough
def test_verdicts_are_those_of_sampled_poses():
    model = mixed(two_rooms(1.0))
    model.run(max_seconds=2.5)
    walls = shapely.MultiLineString(list(model.floor_plan.walls.reshape(-1, 2, 2)))
    judged = {True: 0, False: 0}
    for person in list(model.agents)[:6]:
        found = model.explain(person.row)
        crowd = model.crowd
        others = [
            j for j in model.rows if j != person.row
            and np.hypot(crowd.x[j] - crowd.x[person.row], crowd.y[j] - crowd.y[person.row]) < 3.0
        ]  # fmt: skip
        # Everybody else stands, so that their outlines are enough.
        for j in others:
            crowd.option[j], crowd.knots[j], crowd.end[j] = -1, 1, model.frame
            crowd.to_x[j] = crowd.from_x[j] = crowd.x[j]
            crowd.to_y[j] = crowd.from_y[j] = crowd.y[j]
            crowd.to_heading[j] = crowd.from_heading[j] = crowd.heading[j]
            crowd.start[j], crowd.spacing[j], crowd.gone[j] = model.frame, 1, -1
            crowd.box[j] = crowd.x[j], crowd.y[j], crowd.x[j], crowd.y[j]
        found = model.explain(person.row)
        others = np.concatenate(
            [placed(crowd.x[j], crowd.y[j], crowd.heading[j], shape_of(model, j)) for j in others]
        )
        shape = shape_of(model, person.row)
        for k in range(0, len(found.candidates), 11):
            knots = found.paths[k][:, : found.knots[k]]
            if knots[0].max() > 7.0:  # may leave by the exit
                continue
            times = np.arange(0, knots.shape[1] - 1 + 1e-9, 1 / 6)
            x, y, heading = (np.interp(times, np.arange(len(a)), a) for a in knots)
            own = placed(x, y, heading, shape)
            to_walls = (shapely.distance(shapely.points(own[:, :2]), walls) - own[:, 2]).min()
            apart = np.hypot(*(own[:, None, :2] - others[:, :2]).transpose(2, 0, 1))
            to_others = (apart - own[:, None, 2] - others[:, 2]).min()
            gap = min(to_walls, to_others)
            free = found.verdicts[k] == FREE
            judged[bool(free)] += 1
            # Twice a frame; between them a body may come as near as it moves.
            assert gap > 0.0 if free else gap < 0.02, (person.row, k, gap)
    assert min(judged.values()) > 20


def test_the_search_finds_the_cheapest_option_that_is_free():
    model = mixed(two_rooms(1.0), frames_per_step=1)
    model.run(max_seconds=1.5)
    compared = long = 0
    for turn in range(480):
        due = [person.row for person in model.agents if person.next_decision < 1e-9]
        if not due:
            model.step()
            continue
        model.watch = Watch(due[turn % len(due)])
        model.step()
        decision = model.watch.decision
        free = decision.verdicts == FREE
        if not free.any():
            assert decision.chosen == -1
            continue
        compared += 1
        long += decision.candidates.cores[0] > 0.3
        assert free[decision.chosen]
        least = decision.totals[free].min()
        assert decision.totals[decision.chosen] == pytest.approx(least, abs=1e-9)
    assert compared > 40
    assert long > 10


@pytest.mark.parametrize("seed", [1, 2])
def test_bodies_keep_out_of_one_another_and_of_walls(seed):
    model = mixed(two_rooms(1.0), seed)
    model.run(max_seconds=15.0)
    tracks = Trajectories.of(model)
    report = check_safety(tracks, model.floor_plan.walls)
    assert (report.overlaps, report.wall_crossings) == (0, 0)
    _, discs = tracks.placed_discs(np.arange(len(tracks)))
    walls = shapely.MultiLineString(list(model.floor_plan.walls.reshape(-1, 2, 2)))
    inside = discs[:, 0] < 7.9
    away = shapely.distance(shapely.points(discs[inside, :2]), walls)
    assert (away >= discs[inside, 2] - 1e-6).all()
    assert tracks.person[tracks.frame == 0].tolist() == list(range(12))
    heading = tracks.heading[tracks.person == 0]
    assert np.ptp(heading) > 0.08  # it has turned, and not only slid


def test_a_passage_narrower_than_a_chair_is_long_leaves_no_room_to_turn():
    # 0.9 m wide, and a circle of 1.2 m is needed.
    plan = FloorPlan(box(0, 0, 12, 0.9), exits=[Exit("out", (0, 0), (0, 0.9))])
    model = PedestrianModel(plan, pedestrian_types=[chair()], rng=1, record=True)
    with pytest.raises(ModelError, match=r"0\.450 m from a wall, expected room for its body, 0\.6"):
        model.add_pedestrians([(5.0, 0.45)])
    model.add_pedestrians([(5.0, 0.45)], headings=0.0, preferred_speeds=0.7)
    # Those who drive backwards need not face where they go.
    (sideways,) = (term for term in model.terms if term.name == "sideways")
    sideways.weight_by_type = {model.pedestrian_types[0].name: 0.0}
    model.run(max_seconds=60.0)
    # Its target is behind it: it backs out.
    assert model.inside == 0
    tracks = Trajectories.of(model)
    assert np.abs(tracks.heading).max() < np.deg2rad(45.0)


def test_who_is_too_wide_for_a_gap_is_refused_or_led_round():
    floor = union_all([box(0, 0, 4, 6), box(4, 1, 4.2, 1.6), box(4.2, 0, 8, 6)])
    plan = FloorPlan(floor, exits=[Exit("out", (8, 1), (8, 5))])
    model = PedestrianModel(plan, pedestrian_types=[chair(), walker()], rng=1)
    model.add_pedestrians([(1.0, 3.0)], type_index=1)
    with pytest.raises(FloorPlanError, match=r"too narrow for bodies of 0\.35 m radius"):
        model.add_pedestrians([(2.0, 3.0)], type_index=0)
    wide = FloorPlan(union_all([floor, box(4, 4, 4.2, 5.2)]), exits=plan.exits)
    model = PedestrianModel(wide, pedestrian_types=[chair(), walker()], rng=1)
    low, high = model.add_pedestrians([(2.0, 1.3), (1.0, 1.3)], type_index=[1, 0])
    assert low.target[1] < 2.0
    assert high.target[1] > 3.0


@pytest.mark.parametrize("fits", [False, True])
def test_nobody_is_put_where_a_chair_turns(fits):
    model = PedestrianModel(room(), pedestrian_types=[chair(), walker()], rng=1)
    model.add_pedestrians([(3.0, 3.0)], type_index=0)
    apart = 0.6 + walker().core_radius + (0.01 if fits else -0.01)
    if fits:
        model.add_pedestrians([(3.0, 3.0 + apart)], type_index=1)
        return
    with pytest.raises(ModelError, match="where pedestrian 0 is"):
        model.add_pedestrians([(3.0, 3.0 + apart)], type_index=1)


@pytest.mark.thorough
def test_a_saved_run_goes_on_with_the_same_bodies(tmp_path):
    model = mixed(two_rooms(1.0))
    model.run(max_seconds=2.0)
    model.save(tmp_path / "run.zip")
    other = PedestrianModel.load(tmp_path / "run.zip", pedestrian_types=model.pedestrian_types)
    model.run(max_seconds=4.0)
    other.run(max_seconds=4.0)
    assert Trajectories.of(model).x.tobytes() == Trajectories.of(other).x.tobytes()
    assert Trajectories.of(other).discs.tolist() == Trajectories.of(model).discs.tolist()
