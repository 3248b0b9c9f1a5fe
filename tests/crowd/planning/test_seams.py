"""People who cross a seam walk as on one floor."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility import CostTerm, PedestrianModel, Trajectories
from mesa_mobility.compiled import threads
from mesa_mobility.errors import ModelError
from mesa_mobility.results import check_safety
from tests.fixtures.engine import ENGINE
from tests.fixtures.seams import APART, cut_corridor, overlaps, room_with_corridor, true_x


def evacuation(plan, seed, people=40):
    """A model in which these people have left the room."""
    model = PedestrianModel(plan, preset=ENGINE, record=True, rng=seed)
    room = box(-8, -3, 0, 3)
    rng = np.random.default_rng(seed)
    model.add_pedestrians(plan.random_points(people, rng, within=room, spacing=0.5, clearance=0.2))
    model.run(max_seconds=200)
    return model


def on_one_floor(tracks):
    """(n, 3) places on the whole floor."""
    return np.column_stack([true_x(tracks.x), tracks.y, np.zeros(len(tracks))])


def test_nobody_is_lost_doubled_or_walks_through_others_or_walls():
    model = evacuation(cut_corridor(0.9), 1)
    tracks = Trajectories.of(model)
    assert model.inside == 0
    # A row for each person and frame, without gaps, and the way out at the true exit.
    first, later = tracks.steps()
    assert len(first) == len(tracks) - 40
    places = on_one_floor(tracks)
    step = np.hypot(*(places[later] - places[first])[:, :2].T)
    assert step.max() < 0.1
    last = np.array([tracks.rows_of(person)[-1] for person in range(40)])
    assert (places[last, 0] >= 12.0).all()
    assert overlaps(tracks.frame, places, tracks.radii[tracks.person]) == 0
    # Everybody has changed sheets once, and beyond the line of the seam.
    changes = np.abs(tracks.x[later] - tracks.x[first]) > APART / 2
    assert np.bincount(tracks.person[first[changes]]).tolist() == [1] * 40
    assert (places[later[changes], 0] > 6.0).all()
    whole = room_with_corridor(0.9)
    walked = Trajectories(
        tracks.frame,
        tracks.person,
        places[:, 0],
        tracks.y,
        tracks.heading,
        core_radius=tracks.radii,
        inside_at_end=[],
    )
    assert check_safety(walked, whole.walls, whole.free).passed


def test_a_queue_across_a_seam_keeps_its_distances():
    """At a narrow exit people queue through the seam: none stands where another is drawn."""
    plan = cut_corridor(0.9)
    plan.close_gate("east")
    model = PedestrianModel(plan, preset=ENGINE, record=True, rng=2)
    model.add_pedestrians(
        plan.random_points(
            30, np.random.default_rng(2), within=box(-4, -3, 0, 3), spacing=0.5, clearance=0.2
        ),
        exits=["east"],
    )
    plan.open_gate("east")
    for _ in range(150):
        model.step()
        if model.elapsed == pytest.approx(6.0):
            plan.close_gate("east")
    tracks = Trajectories.of(model)
    places = on_one_floor(tracks)
    there = places[tracks.frame == tracks.frames - 1, 0]
    assert (np.abs(there - 6.0) < 2.0).any()
    assert overlaps(tracks.frame, places, tracks.radii[tracks.person]) == 0


def test_threads_change_nothing(monkeypatch):
    """Whoever decides waits for those near their twin, on the other sheet."""
    monkeypatch.setattr(threads, "MANY", 1)
    found = []
    for count in (1, 2):
        monkeypatch.setattr(threads, "THREADS", count)
        threads._pool.cache_clear()
        tracks = Trajectories.of(evacuation(cut_corridor(1.6), 3, 60))
        found.append([each.tobytes() for each in (tracks.x, tracks.y, tracks.heading)])
    threads._pool.cache_clear()
    assert found[0] == found[1]


def test_nobody_comes_in_where_the_other_sheet_is_drawn():
    plan = cut_corridor(1.6)
    model = PedestrianModel(plan, rng=1)
    for place in ((8.0, 0.0), (4.0 + APART, 0.0)):
        with pytest.raises(ModelError, match="belongs to another sheet"):
            model.add_pedestrians([place])
    assert model.inside == 0


def test_newcomers_keep_clear_of_people_beyond_the_seam():
    model = PedestrianModel(cut_corridor(1.6), preset=ENGINE, rng=1)
    model.add_pedestrians([(5.9, 0.0)])
    with pytest.raises(ModelError, match="too close to where pedestrian 0 is"):
        model.add_pedestrians([(6.1 + APART, 0.0)])
    model.add_pedestrians([(6.5 + APART, 0.0)])
    assert model.inside == 2


def test_twins_leave_no_trace():
    """Rows behind the last person are empty for those who come next."""
    model = evacuation(cut_corridor(1.6), 1, 20)
    records = model.crowd.records[model.population.count :]
    assert records.tobytes() == bytes(records.nbytes)


class Crowded(CostTerm):
    """Says whom each person sees."""

    name = "crowded"

    def __init__(self):
        super().__init__(1.0)
        self.seen = []

    def cost(self, candidates):
        """Nothing."""
        self.seen.append((candidates.pedestrians.tolist(), candidates.neighbours.tolist()))
        return np.zeros(len(candidates))


def test_terms_see_people_across_the_seam_under_their_own_rows():
    model = PedestrianModel(cut_corridor(1.6), preset=ENGINE, rng=1)
    model.add_pedestrians([(5.5, 0.0), (6.5 + APART, 0.0), (-7.0, 2.0)])
    candidates = model.candidates(np.array([0, 1]))
    assert candidates.neighbours.tolist() == [1, 0]
    assert candidates.neighbour_offsets.tolist() == [0, 1, 2]
    # A metre ahead of the first, and behind the second, on the sheet of each.
    assert candidates.neighbour_positions.tolist() == [[6.5, 0.0], [5.5 + APART, 0.0]]
    model.terms.append(term := Crowded())
    model.step()
    who, others = term.seen[-1]
    assert sorted(who) == [0, 1, 2]
    assert sorted(others) == [0, 1]


def test_an_explanation_names_who_is_in_the_way_beyond_the_seam():
    model = PedestrianModel(cut_corridor(0.9), preset=ENGINE, rng=1)
    model.add_pedestrians([(5.8, 0.0), (6.2 + APART, 0.0)], headings=0.0)
    explained = model.explain(0)
    assert explained.candidates.neighbours.tolist() == [1]
    # Bodies of 0.28 m 0.4 m apart: most steps ahead end in the other.
    assert set(explained.blockers[explained.blockers >= 0].tolist()) == {1}
    assert (explained.blockers == 1).sum() > 100
    assert np.allclose(explained.neighbour_ends, [[6.2, 0.0]])
