"""A model loaded from a checkpoint goes on to the same bytes."""

import hashlib
import subprocess
import sys
import textwrap

import numpy as np
import pytest
from shapely import box

from mesa_mobility import CostTerm, PedestrianModel, PedestrianType, Source
from mesa_mobility.crowd import Pedestrian
from mesa_mobility.errors import ModelError
from tests.crowd.checkpoint.test_copies import all_there_is, state
from tests.fixtures.maps import wanderer
from tests.fixtures.scenes import advance, corridor


class Visitor(Pedestrian):
    def __init__(self, model, row):
        super().__init__(model, row)
        self.seen = []

    def step(self):
        self.seen.append(round(self.speed, 3))
        if self.infected and self.model.rng.random() < 0.1:
            self.mood += 1.0


class Restless(CostTerm):
    """Draws from the model's generator, and counts."""

    name = "restless"

    def __init__(self, weight=None):
        super().__init__(weight)
        self.calls = 0

    def bind(self, model):
        self.model = model

    def cost(self, candidates):
        self.calls += 1
        return candidates.rng.random(len(candidates))


class Museum(PedestrianModel):
    def __init__(self, people=12, rng=None):
        super().__init__(
            corridor(length=30.0),
            mobility_map=wanderer(5, options=20),
            pedestrian_class=Visitor,
            fields={"infected": bool, "mood": float},
            record=True,
            frames_per_step=1,
            rng=rng,
        )
        places = self.floor_plan.random_points(people, self.rng, spacing=0.6, clearance=0.3)
        self.visitors = self.add_pedestrians(places, fields={"infected": np.arange(people) % 2 > 0})
        self.terms.append(Restless(weight=0.1))
        self.flow = self.add_source(Source(area=box(0.5, 0.5, 3, 2), rate=1.0))
        self.history = {"steps": (1, 2), "area": box(0, 0, 1, 1)}


def same(one, other):
    assert state(one) == state(other)
    for name, values in one.recorder.arrays().items():
        assert values.tobytes() == other.recorder.arrays()[name].tobytes()
    for name, values in one.crowd.fields.items():
        assert (
            values[: one.population.count].tobytes()
            == other.crowd.fields[name][: one.population.count].tobytes()
        )
    assert one.summary() == other.summary()
    frames = [each.datacollector.get_model_vars_dataframe() for each in (one, other)]
    assert frames[0].equals(frames[1])


@pytest.mark.slow
def test_sources_journeys_groups_and_waits_go_on(tmp_path):
    model = all_there_is()
    advance(model, 60)
    model.floor_plan.add_obstacle(box(9, 5, 10, 7))
    model.floor_plan.close_gate("a")
    advance(model, 30)
    model.save(tmp_path / "at_3_s.zip")
    types = [
        PedestrianType(mobility_map=wanderer(seed, options=n)) for seed, n in ((5, 30), (6, 20))
    ]
    again = PedestrianModel.load(tmp_path / "at_3_s.zip", pedestrian_types=types)
    same(model, again)
    for each in (model, again):
        advance(each, 90)
        each.floor_plan.open_gate("a")
        each.floor_plan.remove_obstacle(1)
        advance(each, 60)
    same(model, again)


def test_what_subclasses_add_goes_on_too(tmp_path):
    model = Museum(rng=3)
    advance(model, 45)
    model.save(tmp_path / "museum.zip")
    again = Museum.load(tmp_path / "museum.zip")
    assert again.history == model.history
    assert [each.row for each in again.visitors] == [each.row for each in model.visitors]
    assert again.flow is again.sources[0]
    assert again.terms[-1].model is again
    for each in (model, again):
        advance(each, 60)
    same(model, again)
    assert [p.seen for p in model.agents] == [p.seen for p in again.agents]
    assert model.terms[-1].calls == again.terms[-1].calls > 5
    assert model.crowd.fields["mood"].max() > 0.0


def test_a_checkpoint_of_a_checkpoint_is_the_same_file(tmp_path):
    model = Museum(rng=3)
    advance(model, 20)
    model.save(tmp_path / "one.zip")
    Museum.load(tmp_path / "one.zip").save(tmp_path / "two.zip")
    digests = {
        hashlib.sha256((tmp_path / f"{n}.zip").read_bytes()).digest() for n in ("one", "two")
    }
    assert len(digests) == 1


def test_a_term_that_only_the_user_can_make(tmp_path):
    model = PedestrianModel(corridor(), rng=1)
    model.terms.append(Restless(weight=0.2))
    model.add_pedestrians([(1.0, 1.0)])
    model.step()
    model.save(tmp_path / "file.zip")
    with pytest.raises(ModelError, match=r"behaviour 'restless' .* expected load\(path, plugins="):
        PedestrianModel.load(tmp_path / "file.zip")
    again = PedestrianModel.load(tmp_path / "file.zip", plugins=[Restless()])
    assert [term.weight for term in again.terms] == [term.weight for term in model.terms]


@pytest.mark.parametrize(
    "scenario",
    [
        pytest.param("Doorway(pedestrians=40, rng=4, record=True), 3.0", id="doorway"),
        pytest.param(
            "Auditorium(rng=1, record=True), 30.0", id="auditorium", marks=pytest.mark.slow
        ),
    ],
)
@pytest.mark.slow
def test_in_another_process(tmp_path, scenario):
    digest = textwrap.dedent(
        """
        def ends(model):
            import hashlib
            model.run(max_seconds=model.elapsed + 400.0)
            found = hashlib.sha256(repr(model.summary()).encode())
            for values in model.recorder.arrays().values():
                found.update(values.tobytes())
            print(found.hexdigest())
        """
    )
    save = (
        "from mesa_mobility.models import Auditorium, Doorway\n"
        f"model, seconds = {scenario}\n"
        f"model.run(max_seconds=seconds)\nmodel.save({str(tmp_path / 'at')!r})\nends(model)\n"
    )
    load = (
        "from mesa_mobility import PedestrianModel\n"
        f"ends(PedestrianModel.load({str(tmp_path / 'at')!r}))\n"
    )
    printed = [
        subprocess.run(
            [sys.executable, "-c", digest + code], capture_output=True, text=True, check=True
        ).stdout
        for code in (save, load)
    ]
    assert printed[0] == printed[1] != ""
