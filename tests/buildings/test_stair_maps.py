"""People on stairs walk by the maps for stairs, and all that knows of maps goes along."""

from itertools import pairwise

import numpy as np
import pytest

from mesa_mobility import MobilityMap, PedestrianModel, PedestrianType, Trajectories
from mesa_mobility.buildings import ON_STAIRS
from mesa_mobility.compiled import threads
from mesa_mobility.crowd import Watch
from mesa_mobility.results.decisions import Decisions, read_decisions
from mesa_mobility.verification.scenarios.buildings.stairs import lone_climber
from tests.fixtures.buildings import two_storeys

OFFICE = two_storeys()
OWN, DOWN = MobilityMap.load(), MobilityMap.named("able_bodied_down")
SECONDS = 60


def model_of(people=1, kind=None, **keywords):
    kinds = [PedestrianType.named("able_bodied") if kind is None else kind]
    model = PedestrianModel(OFFICE, pedestrian_types=kinds, rng=1, **keywords)
    places = OFFICE.random_points(people, model.rng, level=1, spacing=0.6, clearance=0.25)
    model.add_pedestrians(places)
    return model


def steps(model):
    """The frames of a run that ends."""
    while model.inside:
        assert model.frame < 30 * SECONDS
        yield model.frame
        model.step()


def test_people_walk_down_by_the_map_for_stairs():
    model = model_of(record="decisions", frames_per_step=1)
    [person] = model.agents
    used = []
    for _ in steps(model):
        used.append(person.capability.map)
        assert 0 <= person.cluster < used[-1].n_clusters
    changes = [used[0], *(b for a, b in pairwise(used) if a is not b)]
    [own, up, down] = model.mobility_maps[0]
    assert [own.digest, down.digest] == [OWN.digest, DOWN.digest]
    assert up.pedestrian_type == "able_bodied_up"
    # The dog-leg or the straight stair, with a landing or without.
    assert changes in ([own, down, own], [own, down, own, down, own])
    tracks = Trajectories.of(model)
    decisions = tracks.decisions
    on_stairs = decisions.option >= own.n_options + up.n_options
    assert on_stairs.any()
    assert not ((decisions.option >= own.n_options) & ~on_stairs).any()
    level = dict(zip(tracks.frame.tolist(), tracks.level.tolist(), strict=True))
    # Movements by the map for stairs begin on the flight, or within a step before it.
    begun = [level[frame] for frame in decisions.frame[on_stairs].tolist()]
    assert np.mean([each == ON_STAIRS for each in begun]) > 0.7


def states(step):
    model = model_of(60, frames_per_step=step)
    model.run(max_seconds=20)
    return model.crowd.records[: model.population.count].tobytes()


def test_neither_steps_nor_threads_change_anything(monkeypatch):
    alone = states(30)
    for step in (1, 3):
        assert states(step) == alone
    monkeypatch.setattr(threads, "MANY", 1)
    for count in (1, 2):
        monkeypatch.setattr(threads, "THREADS", count)
        threads._pool.cache_clear()
        assert states(3) == alone
    threads._pool.cache_clear()


def test_a_model_saved_while_people_are_on_stairs_goes_on(tmp_path):
    model = model_of(30, record="decisions")
    for _ in steps(model):
        if (model.crowd.cluster[model.rows] >= OWN.n_clusters).sum() > 5:
            break
    model.save(tmp_path / "saved.zip")
    again = PedestrianModel.load(tmp_path / "saved.zip", floor_plan=OFFICE)
    end = model.elapsed + 5.0
    for each in (model, again):
        each.run(max_seconds=end)
    for one, other in zip(model.decided().values(), again.decided().values(), strict=True):
        assert one.tobytes() == other.tobytes()


def test_a_decision_on_stairs_is_explained_by_its_map():
    model = model_of(frames_per_step=1)
    model.watch = Watch(0)
    seen = set()
    for _ in steps(model):
        told = model.watch.decision
        if told is None or not told.taken or told.frame != model.frame - 1:
            continue
        seen.add(told.capability.map)
        assert told.chosen >= 0
        options = told.capability.table.options[told.candidates.options]
        assert told.candidates.speeds.tolist() == options.speed.tolist()
        assert told.verdicts[told.chosen] == 0
        assert told.totals[told.chosen] == told.totals[told.verdicts == 0].min()
    assert {each.digest for each in seen} == {OWN.digest, DOWN.digest}


def test_files_of_decisions_name_the_maps_for_stairs(tmp_path):
    model = model_of(record="decisions")
    model.run(max_seconds=1)
    decisions = Decisions.of(model)
    [own, *others] = model.mobility_maps[0]
    assert decisions.maps == (own.digest,)
    assert decisions.stairs == (tuple((each.digest, 1.0) for each in others),)
    decisions.to_parquet(tmp_path / "decisions.parquet")
    again = read_decisions(tmp_path / "decisions.parquet")
    assert (again.maps, again.stairs) == (decisions.maps, decisions.stairs)
    flat = PedestrianModel(OFFICE.floor_plan_of(0), record="decisions", rng=1)
    assert Decisions.of(flat).stairs == ()
    assert again.bank_of(0).n_options == sum(each.n_options for each in model.mobility_maps[0])


@pytest.mark.parametrize("name", ["cane", "slow"])
def test_types_without_maps_for_stairs_keep_their_own(name):
    kind = PedestrianType.named(name)
    model = model_of(2, kind)
    assert model.mobility_maps == ((kind.mobility_map,),)
    model.run(max_seconds=1)


@pytest.mark.thorough
@pytest.mark.parametrize("up", [False, True])
def test_people_who_are_older_or_use_aids_are_slower_on_stairs(up):
    speeds = []
    for kind in ("able_bodied", "older_adult", "cane", "walking_frame"):
        each = PedestrianType.named(kind)
        prefers = float(each.draw_speeds(1000, np.random.default_rng(1)).mean())
        stair = {"risers": 18, "riser": 0.17, "tread": 0.29}
        alone = lone_climber(1, up=up, preferred=prefers, kind=kind, **stair)
        speeds.append(alone["speed_mps"])
        # On stairs like these, the speed in the SFPE Handbook is 0.96 of 1.19 m/s; up, 0.8 of it.
        assert speeds[-1] == pytest.approx(0.96 / 1.19 * (0.8 if up else 1.0) * prefers, rel=0.06)
    assert speeds == sorted(speeds, reverse=True)
