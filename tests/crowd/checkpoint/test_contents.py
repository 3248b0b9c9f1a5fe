"""A checkpoint of which one number is changed is refused, in a line that says where."""

import io
import json
import zipfile

import numpy as np
import pytest

from mesa_mobility import PedestrianModel, Tactic
from mesa_mobility.crowd.running.stall import StallWatch
from mesa_mobility.crowd.state.aggregates import Aggregates
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.errors import ModelError
from tests.fixtures.engine import ENGINE
from tests.fixtures.maps import strider, wanderer
from tests.fixtures.scenes import advance, corridor


class Counting(Tactic):
    """Counts its calls, and cannot take over a text."""

    name = "counting"

    def __init__(self):
        self.calls = 0

    def apply(self, deciding, desired):
        self.calls += 1

    def state(self):
        return {"calls": self.calls}

    def restore(self, state):
        self.calls = state["calls"] + 1


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """A checkpoint of six people, one of whom has left, and 100 records' room."""
    model = PedestrianModel(
        corridor(length=6.0),
        mobility_map=wanderer(5, options=30),
        rng=1,
        preset=ENGINE,
        record=True,
    )
    model.add_pedestrians([(1.0, 1.0), (2.0, 2.0), (3.0, 3.0), (4.0, 1.0), (2.5, 1.0), (1.0, 3.0)])
    model.tactics.append(Counting())
    advance(model, 40)
    path = tmp_path_factory.mktemp("saved") / "file.zip"
    model.save(path)
    return path


def load(path):
    return PedestrianModel.load(path, mobility_map=wanderer(5, options=30), plugins=[Counting()])


def arrays_of(path):
    """The entries of the file, its JSON, and the arrays by where the JSON names them."""
    with zipfile.ZipFile(path) as archive:
        entries = {name: archive.read(name) for name in archive.namelist()}
    return entries, json.loads(entries["checkpoint.json"])


def member(content, *names):
    """The packed value of a part's state by its names."""
    value = content["parts"]
    for name in names:
        value = dict((key, each) for key, each in value["$"][1])[name]
    return value


def write(path, entries):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in entries.items():
            archive.writestr(name, data)


def change_array(source, path, names, change):
    """Write the file with an array of a part changed in place, or another one for it."""
    entries, content = arrays_of(source)
    entry = member(content, *names)["$"][1] + ".npy"
    array = np.load(io.BytesIO(entries[entry]))
    changed = change(array)
    buffer = io.BytesIO()
    np.save(buffer, array if changed is None else changed)
    entries[entry] = buffer.getvalue()
    write(path, entries)


def put(field, row, value):
    def change(array):
        (array[field] if field else array)[row] = value

    return change


def test_the_sound_file_is_taken(saved):
    assert load(saved).inside > 3


@pytest.mark.parametrize("row", [64, 100, 1_000_000, -1])
def test_rows_of_people_who_are_not_there(saved, tmp_path, row):
    change_array(saved, tmp_path / "f", ("population", "present"), put("", -1, row))
    with pytest.raises(ModelError, match=rf"population, present\[\d\]: got {row}, expected"):
        load(tmp_path / "f")


@pytest.mark.parametrize(
    ("field", "value", "text"),
    [
        ("option", 10**6, r"records, option\[0\]: got 1000000"),
        ("option", -1, "pedestrian 0: (to_x|cluster|spacing|knots)"),
        ("cluster", 64, r"cluster\[0\]: got 64"),
        ("destination", -2, r"destination\[0\]: got -2"),
        ("type_index", 1, r"type_index\[0\]: got 1"),
        ("knots", 7, "pedestrian 0: knots is 7"),
        ("spacing", 0, r"spacing\[0\]: got 0"),
        ("end", 2**30, "pedestrian 0: end is"),
        ("gone", 1, "pedestrian 0: gone is 1"),
        ("x", np.nan, r"records, x\[0\]: got nan, expected a number, finite"),
        ("x", 3.5, r"pedestrian 0: x is 3\.5, expected what its movement says"),
        ("to_y", 1e308, r"to_y\[0\]: got 1e\+308"),
        ("vx", 3.0, r"pedestrian 0: vx is 3\.0"),
        ("core", 0.3, r"pedestrian 0: core is 0\.3"),
        ("active", False, "present: expected all who are active"),
    ],
)
def test_one_number_of_a_person(saved, tmp_path, field, value, text):
    change_array(saved, tmp_path / "f", ("population", "records"), put(field, 0, value))
    with pytest.raises(ModelError, match=text) as caught:
        load(tmp_path / "f")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("names", "change", "text"),
    [
        (("population", "agenda"), put("journey", 0, 3), r"agenda, journey\[0\]: got 3"),
        (("population", "agenda"), put("speed", 0, np.inf), r"agenda, speed\[0\]: got inf"),
        (("population", "records"), lambda a: a[:-1], r"records: shape \(5,\), expected \(6\)"),
        (("population", "present"), lambda a: a.astype("f8"), "present: got dtype..float64.."),
        (
            ("recorder", "x"),
            put("", 7, 1e3),
            "recorder, row .*: is more than 0.41 m from the frame",
        ),
        (("recorder", "x"), lambda a: a[:-1], r"recorder, (x|y): shape"),
    ],
)
def test_one_number_of_a_part(saved, tmp_path, names, change, text):
    change_array(saved, tmp_path / "f", names, change)
    with pytest.raises(ModelError, match=text):
        load(tmp_path / "f")


def change_text(source, path, change):
    entries, content = arrays_of(source)
    change(content)
    entries["checkpoint.json"] = json.dumps(content).encode()
    write(path, entries)


def behaviour(content, group, name):
    [found] = [each for each in content["behaviors"][group] if each["name"] == name]
    return found["state"]["$"][1]


def weigh(content):
    behaviour(content, "terms", "target_distance")[0][1] = {"$": ["float", "nan"]}


def hide(content):
    behaviour(content, "terms", "target_distance").append(["bounds_only", 5])
    behaviour(content, "terms", "target_distance").append(["is_for", 5])


def overlap(content):
    content["people"]["unique_ids"][0] = content["people"]["unique_ids"][1]


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (weigh, "behaviour 'target_distance': weight of 'target_distance': got nan"),
        (hide, "behaviour 'target_distance': state, is_for: expected the name of an attribute"),
        (
            lambda c: behaviour(c, "tactics", "counting")[0].__setitem__(1, "7"),
            r"behaviour 'counting': no state of it, after the member 'calls' \(TypeError",
        ),
        (overlap, "people, number of different unique_ids"),
        (lambda c: c["own"].update(run=5), "own, run: expected the name of an attribute"),
        (lambda c: c["own"].update(frame=5), "own, frame: expected attributes that all models"),
        (lambda c: c["parts"]["$"][1].pop(), "parts: missing"),
        (lambda c: c.update(x=1), "checkpoint: unknown 'x'"),
        (lambda c: c["counters"]["$"][1][0].__setitem__(1, -1), "counters, frame: got -1"),
        (lambda c: c["arguments"].update(frames_per_step=2**62), "frames_per_step: got"),
    ],
)
def test_one_value_of_the_text(saved, tmp_path, change, text):
    change_text(saved, tmp_path / "f", change)
    with pytest.raises(ModelError, match=text) as caught:
        load(tmp_path / "f")
    assert "\n" not in str(caught.value)


def test_members_that_nothing_refers_to(saved, tmp_path):
    entries, _ = arrays_of(saved)
    write(tmp_path / "f", {**entries, "x.npy": entries["a0.npy"]})
    with pytest.raises(ModelError, match="arrays that nothing refers to: x"):
        load(tmp_path / "f")


def test_a_file_that_unpacks_to_a_gigabyte(saved, tmp_path):
    entries, _ = arrays_of(saved)
    with zipfile.ZipFile(tmp_path / "f", "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, data in entries.items():
            archive.writestr(name, data)
        with archive.open("x.npy", "w") as large:
            for _ in range(25):
                large.write(bytes(10_000_000))
    assert (tmp_path / "f").stat().st_size < 1_500_000
    with pytest.raises(ModelError, match="arrays of 250 MB, expected at most"):
        load(tmp_path / "f")


def test_what_packs_to_next_to_nothing_can_be_read_again(tmp_path):
    model = PedestrianModel(corridor(), mobility_map=strider(), rng=1)
    model.zeros = np.zeros(12_000_000)
    model.save(tmp_path / "f")
    assert not PedestrianModel.load(tmp_path / "f", mobility_map=strider()).zeros.any()


def test_a_number_of_numpy_is_a_number_again(tmp_path):
    model = PedestrianModel(corridor(), mobility_map=strider(), rng=1)
    model.number = np.float32(0.5)
    model.save(tmp_path / "f")
    found = PedestrianModel.load(tmp_path / "f", mobility_map=strider()).number
    assert (type(found), found) == (np.float32, 0.5)


def test_a_crowd_with_fewer_records_than_before_is_watched_on():
    """After loading, there is room for fewer people than the watch has seen."""
    watch, before, now = StallWatch(), Crowd(128), Crowd(70)
    rows, seen = np.arange(3), Aggregates(3, 0.0, 3, 0)
    for crowd in (before, now):
        crowd.route[:3] = 5.0
    for crowd, frame in ((before, 0), (before, 30), (now, 60)):
        assert not watch.stalled(frame, rows, crowd, seen, 0, 0)
