"""What cannot be saved or loaded is refused in one line."""

import json
import zipfile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from mesa_mobility import CostTerm, PedestrianModel, Source
from mesa_mobility.crowd.checkpoint.plain import Packer, Unpacker
from mesa_mobility.distributions import Normal
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import wanderer
from tests.fixtures.scenes import advance, corridor, model_of


def model(**keywords):
    made = PedestrianModel(corridor(), mobility_map=wanderer(5, options=10), rng=1, **keywords)
    made.add_pedestrians([(1.0, 1.0), (2.0, 2.0)])
    return made


class Remembering(CostTerm):
    name = "remembering"

    def __init__(self, kept):
        super().__init__()
        self.kept = kept

    def cost(self, candidates):
        return np.zeros(len(candidates))


class WithHooks(Remembering):
    def state(self):
        return {}

    def restore(self, state):
        pass


def refused(text, made, tmp_path):
    with pytest.raises(ModelError, match=text) as error:
        made.save(tmp_path / "file.zip")
    assert "\n" not in str(error.value)
    assert not list(tmp_path.iterdir())


def test_what_is_no_data(tmp_path):
    made = model()
    made.report = print
    refused(
        r"PedestrianModel\.report: a builtin_function_or_method cannot be saved", made, tmp_path
    )
    made = model()
    next(iter(made.agents)).friend = object()
    refused(r"Pedestrian\.friend of pedestrian 0: a object cannot be saved", made, tmp_path)
    made = model()
    made.terms.append(Remembering({"a": [object()]}))
    refused(r"behaviour 'remembering', kept\['a'\]: a object cannot be saved", made, tmp_path)
    made.terms[-1] = WithHooks(object())
    made.save(tmp_path / "file.zip")


def test_functions_that_people_wait_for(tmp_path):
    made = model()
    next(iter(made.agents)).wait(until=lambda: False)
    refused(r"1 people wait until a function says so", made, tmp_path)


def test_files_that_are_no_checkpoints(tmp_path):
    for name, content in (("none", None), ("empty", b""), ("text", b"hello")):
        path = tmp_path / name
        if content is not None:
            path.write_bytes(content)
        with pytest.raises(ModelError, match=f"{name}: (no such file|not a readable checkpoint)"):
            PedestrianModel.load(path)
    with zipfile.ZipFile(tmp_path / "zip", "w") as archive:
        archive.writestr("checkpoint.json", "{}")
    with pytest.raises(ModelError, match="not a checkpoint of a model"):
        PedestrianModel.load(tmp_path / "zip")


def changed(path, change):
    """The same file with another JSON."""
    with zipfile.ZipFile(path) as archive:
        entries = {name: archive.read(name) for name in archive.namelist()}
    content = json.loads(entries["checkpoint.json"])
    change(content)
    entries["checkpoint.json"] = json.dumps(content).encode()
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in entries.items():
            archive.writestr(name, data)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (lambda c: c.update(format_version=99), "format version 99, expected 1"),
        (lambda c: c.update(model="somewhere:Else"), "a checkpoint of somewhere:Else"),
        (lambda c: c.update(map_sha256=["0"]), "its mobility maps are others"),
        (lambda c: c.pop("parts"), "checkpoint: missing 'parts', expected the members"),
        (lambda c: c["own"].update(x={"$": ["code", "1+1"]}), "not one of a checkpoint"),
    ],
)
def test_files_that_do_not_fit(tmp_path, change, text):
    made = model()
    made.step()
    path = tmp_path / "file.zip"
    made.save(path)
    changed(path, change)
    with pytest.raises(ModelError, match=text):
        PedestrianModel.load(path, mobility_map=wanderer(5, options=10))


def test_arguments_that_are_not_in_the_file(tmp_path):
    made = model()
    made.save(tmp_path / "file.zip")
    with pytest.raises(ModelError, match=r"expected load\(path, mobility_map=\.\.\.\)"):
        PedestrianModel.load(tmp_path / "file.zip")


def test_a_model_before_anybody_has_come(tmp_path):
    made = PedestrianModel(corridor(), mobility_map=wanderer(5, options=10), rng=1)
    made.save(tmp_path / "file.zip")
    again = PedestrianModel.load(tmp_path / "file.zip", mobility_map=wanderer(5, options=10))
    assert (again.inside, again.frame) == (0, 0)


def test_declared_fields_are_in_the_file(tmp_path):
    made = model(fields={"mood": float, "infected": bool})
    made.crowd.fields["mood"][:2] = [0.5, -1.0]
    made.save(tmp_path / "file.zip")
    again = PedestrianModel.load(tmp_path / "file.zip", mobility_map=wanderer(5, options=10))
    assert [person.mood for person in again.agents] == [0.5, -1.0]
    assert again.crowd.fields["infected"].dtype == bool


def test_a_loaded_model_has_a_floor_of_its_own(tmp_path):
    made = model_of(corridor(), wanderer(5, options=10))
    made.add_pedestrians([(1.0, 1.0)])
    advance(made, 3)
    made.save(tmp_path / "file.zip")
    again = PedestrianModel.load(tmp_path / "file.zip", pedestrian_types=made.pedestrian_types)
    again.floor_plan.add_obstacle(box(10, 1, 11, 2))
    assert not made.floor_plan.obstacles
    assert again.add_pedestrians([(5.0, 2.0)])[0].unique_id == 2


values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda inner: (
        st.lists(inner)
        | st.tuples(inner, inner)
        | st.dictionaries(st.text() | st.integers(), inner)
    ),
    max_leaves=12,
)


@settings(deadline=None)
@given(values)
def test_values_come_back_as_they_were(value):
    packer = Packer([])
    packed = json.loads(json.dumps(packer.pack(value, "value"), allow_nan=False))
    found = Unpacker(packer.arrays, {}).unpack(packed)
    assert found == value
    assert type(found) is type(value)


def test_objects_come_back_as_they_were():
    rng = np.random.default_rng(5)
    there = [
        np.arange(6.0).reshape(2, 3),
        np.float32(0.1),
        {1, 2},
        box(0, 0, 1, 0.1),
        Normal(1.0, 0.2),
        Source(area=box(0, 0, 1, 1), times=[1.0, 2.0]),
        float("nan"),
        float("-inf"),
        rng,
        bool,
        float,
    ]
    packer = Packer([])
    found = Unpacker(packer.arrays, {}).unpack(packer.pack(there, "there"))
    assert (found[0] == there[0]).all()
    assert (found[1].dtype, found[1:5]) == (np.float32, there[1:5])
    assert found[5].times.tolist() == [1.0, 2.0]
    assert np.isnan(found[6])
    assert found[7] == -np.inf
    assert found[8].random(3).tolist() == rng.random(3).tolist()
    assert found[9:] == [bool, float]
