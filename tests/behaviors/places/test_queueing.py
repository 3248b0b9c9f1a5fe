"""People line up before counters and are served one after the other."""

import numpy as np
import pytest
from mesa_mobility.behaviors import Counter, Queueing
from shapely import box

from mesa_mobility import Exit, FloorPlan, Gate, MobilityMap, PedestrianModel, PedestrianType
from mesa_mobility.distributions import Uniform
from mesa_mobility.errors import ModelError
from tests.fixtures.checkpoints import check_going_on
from tests.fixtures.maps import shipped_map
from tests.fixtures.oracles.counting import overlaps, wall_crossings
from tests.fixtures.scenes import core_of, model_of


def hall(**keywords):
    """16 m by 8 m, with a way out at the lower right."""
    return FloorPlan(box(0, 0, 16, 8), exits=[Exit("out", (16, 0), (16, 2))], **keywords)


def serve(counter, places, *, plan=None, seconds=200, route=None, rng=1, **keywords):
    """The model after everybody has left, who was served from when to when, and how far apart
    those in the line stood while all of them stood."""
    queueing = Queueing([counter])
    model = model_of(plan or hall(), shipped_map(), frames_per_step=3, rng=rng)
    model.add_tactic(queueing)
    people = model.add_pedestrians(places, route=route or [counter.visit], **keywords)
    times, apart = {}, []
    while model.inside and model.elapsed < seconds:
        model.step()
        for person in people:
            if person in model.agents and not person.gates_crossed and person.waiting:
                at = np.hypot(*(person.position - counter.line[0])) < 0.3
                if at and queueing.line(counter)[:1] == [person.row]:
                    times.setdefault(person.row, [model.elapsed, 0.0])[1] = model.elapsed
        line = [people[row] for row in queueing.line(counter)]
        if len(line) > 2 and max(person.speed for person in line) < 0.01:
            apart += np.hypot(*np.diff([p.position for p in line], axis=0).T).tolist()
    return model, np.array(sorted(times.values())), apart


def test_the_last_of_six_is_served_after_six_service_times():
    counter = Counter([(10, 6), (3, 6)], service=4.0, spacing=0.6)
    model, times, apart = serve(counter, [(5.0 + 0.7 * k, 3.0) for k in range(6)])
    assert model.inside == 0
    assert len(times) == 6
    # Everybody is served for 4 s, as far as steps of 0.1 s tell.
    assert times[:, 1] - times[:, 0] == pytest.approx(4.0, abs=0.25)
    # In between the next one walks 0.6 m: more than 0.4 s, the shortest movement, and less than
    # at a fifth of a metre a second.
    moving_up = times[1:, 0] - times[:-1, 1]
    assert (moving_up > 0.4).all()
    assert moving_up.mean() < 3.0
    assert 6 * 4.0 + 5 * 0.4 < times[-1, 1] - times[0, 0] < 6 * 4.25 + 5 * 3.0
    assert np.mean(apart) == pytest.approx(0.6, abs=0.08)
    rows = model.recorder.arrays()
    assert overlaps(rows, core_of(model)) == 0


def test_nobody_waits_where_nobody_is_before():
    counter = Counter([(10, 6), (3, 6)], service=2.0)
    model, times, _ = serve(counter, [(9.0, 3.0), (1.0, 1.0)], preferred_speeds=1.2)
    assert model.inside == 0
    # The second one has 6.5 m more to walk, more than the first is served for.
    assert times[1, 0] > times[0, 1] + 1.0
    assert (times[:, 1] - times[:, 0]) == pytest.approx(2.0, abs=0.25)


def test_a_line_may_bend_round_a_wall_and_the_way_goes_on_by_a_gate():
    plan = hall(obstacles=[box(5, 3, 8, 4)], gates=[Gate("back", (12, 6), (12, 8))])
    counter = Counter([(9, 4.5), (4.2, 4.5), (4.2, 1.0)], service=Uniform(1.0, 2.0))
    places = [(1.0, 1.0 + 0.8 * k) for k in range(6)]
    model, times, _ = serve(counter, places, plan=plan, route=[counter.visit, "back"])
    assert model.inside == 0
    assert len(times) == 6
    served = times[:, 1] - times[:, 0]
    assert (served > 0.8).all()
    assert (served < 2.2).all()
    assert served.max() - served.min() > 0.2
    assert wall_crossings(model.recorder.arrays(), plan.walls) == 0


def test_places_in_a_line():
    counter = Counter([(2, 0), (1, 0), (1, 2)], service=1.0, spacing=0.5)
    expected = [(2, 0), (1.5, 0), (1, 0), (1, 0.5), (1, 1), (1, 1.5), (1, 2), (1, 2.5)]
    assert counter.places(8) == pytest.approx(np.array(expected))


def test_places_leave_as_much_free_between_larger_bodies():
    counter = Counter([(10, 6), (3, 6)], service=4.0, spacing=0.6)
    # 0.32 m between two cores of 0.14 m; 0.81, 1.02 and 0.89 m from middle to middle.
    found = counter.places_of([0.14, 0.35, 0.35, 0.22])
    assert found == pytest.approx(np.array([(10, 6), (9.19, 6), (8.17, 6), (7.28, 6)]))
    assert counter.places_of([0.14] * 3) == pytest.approx(counter.places(3))


def first_to_last(kind, rng):
    """Seconds from the first of six who is served to the last."""
    counter = Counter([(10, 6), (1, 6)], service=2.0)
    queueing = Queueing([counter])
    model = model_of(hall(), MobilityMap.named(kind), frames_per_step=3, record=False, rng=rng)
    model.add_tactic(queueing)
    model.add_pedestrians([(3.0 + 0.9 * k, 3.0) for k in range(6)], route=[counter.visit])
    served = {}
    while len(served) < 6 and model.elapsed < 100:
        model.step()
        for row in queueing.line(counter)[:1]:
            if model.journeys.stays.stands(row):
                served.setdefault(row, model.elapsed)
    return max(served.values()) - min(served.values()) if len(served) == 6 else np.inf


# Before, some of them joined behind people whom they then stood in front of, for ever.
@pytest.mark.parametrize(("kind", "rng"), [("crutches", 1), ("wheelchair_manual", 5)])
def test_a_queue_with_walking_aids_moves_up(kind, rng):
    assert first_to_last(kind, rng) < 1.5 * first_to_last("able_bodied", rng)


def test_others_do_not_care():
    tracks = []
    for there in (False, True):
        model = model_of(hall(), shipped_map(), frames_per_step=3)
        if there:
            model.add_tactic(Queueing([Counter([(10, 6), (3, 6)], service=4.0)]))
        model.add_pedestrians([(3.0 + k, 6.0) for k in range(5)])
        model.run(max_seconds=5)
        tracks.append(model.recorder.arrays()["x"])
    assert np.array_equal(*tracks)


def test_it_goes_on_from_a_checkpoint(tmp_path):
    class Office(PedestrianModel):
        def __init__(self, rng=None):
            super().__init__(hall(), mobility_map=shipped_map(), record=True, rng=rng)
            counter = Counter([(10, 6), (3, 6)], service=Uniform(1.0, 3.0))
            self.add_tactic(Queueing([counter]))
            self.add_pedestrians([(7.0 + k, 5.0) for k in range(4)], route=[counter.visit])

    check_going_on(Office(rng=1), tmp_path, saved_at=6, until=12)


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        ({"line": [(0, 0)]}, r"line \[\(0, 0\)\], expected two points"),
        ({"line": "here"}, "line 'here', expected two points"),
        ({"line": [(0, 0), (0, 0)]}, "expected finite, different points"),
        ({"line": [(0, 0), (np.nan, 0)]}, "expected finite, different points"),
        ({"spacing": 0.3}, "spacing 0.3, expected 0.5 m or more"),
        ({"service": -1.0}, "visit: stay -1.0, expected a distribution, or 0 to"),
    ],
)
def test_counters_that_are_none_are_refused(wrong, text):
    with pytest.raises(ModelError, match=text):
        Counter(**{"line": [(0, 0), (1, 0)], "service": 1.0, **wrong})


# 19: two in wheelchairs come to the counter from both sides, as near to it as each other. 3, 10:
# the last in line stands before the first, face to face.
@pytest.mark.parametrize("seed", [3, 10, 19])
def test_whoever_is_in_the_way_of_the_first_in_line_goes_first(seed):
    rng = np.random.default_rng([seed, 3])
    head, long, y = rng.uniform(8.0, 12.0), rng.uniform(3.0, 6.0), rng.uniform(2.0, 6.0)
    starts = hall().random_points(
        6, rng, within=box(0.0, 0.0, head, 8.0), spacing=0.9, clearance=0.45
    )
    counter = Counter([(head, y), (head - long, y)], service=2.0)
    wheelchairs = [PedestrianType.named("wheelchair_manual")]
    model = PedestrianModel(hall(), pedestrian_types=wheelchairs, rng=seed)
    model.add_tactic(Queueing([counter]))
    model.add_pedestrians(starts, route=[counter.visit], preferred_speeds=0.6)
    model.run(max_seconds=100)
    assert model.inside == 0
