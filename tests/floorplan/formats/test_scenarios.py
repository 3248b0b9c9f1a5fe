"""Scenarios of JuPedSim and Vadere as floor plans."""

import json
import warnings
import zipfile
from copy import deepcopy

import pytest

from mesa_mobility import FloorPlan
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.scenario import read_scenario
from tests.floorplan.formats.mutations import damaged, read_all


def rectangle(x, y, width, height):
    return {"x": x, "y": y, "width": width, "height": height, "type": "RECTANGLE"}


def element(number, shape, **more):
    return {"id": number, "shape": shape, **more}


TRIANGLE = {"type": "POLYGON", "points": [{"x": 8, "y": 8}, {"x": 10, "y": 8}, {"x": 8, "y": 10}]}
VADERE = {
    "name": "hall",
    "scenario": {
        "topography": {
            "attributes": {
                "bounds": {"x": 0.0, "y": 0.0, "width": 22.0, "height": 17.0},
                "boundingBoxWidth": 1.0,
                "bounded": True,
            },
            "obstacles": [element(1, rectangle(5, 5, 1, 2)), element(2, TRIANGLE)],
            "targets": [
                element(3, rectangle(20.2, 4, 0.5, 2), absorber={"enabled": True}),
                element(4, rectangle(2, 2, 1, 1), absorber={"enabled": False}),
            ],
            "stairs": [element(5, rectangle(12, 2, 2, 3), upwardDirection={"x": 0, "y": 2.0})],
            "sources": [
                element(
                    6,
                    rectangle(2, 8, 2, 2),
                    targetIds=[4, 3],
                    spawner={"constraintsTimeEnd": 4.0, "eventElementCount": 2},
                )
            ],
        }
    },
}
CONFIG = {
    "exits": {
        "jps-exits_0": {"type": "polygon", "coordinates": [[9.2, 2], [9.8, 2], [9.8, 4], [9.2, 4]]}
    },
    "distributions": {
        "a": {
            "coordinates": [[1, 1], [3, 1], [3, 3], [1, 3]],
            "parameters": {"number": 2, "v0": 1.2, "v0_distribution": "gaussian", "v0_std": 0.1},
            "journey_weights": [{"journey_id": "b", "weight": 100}],
        }
    },
    "checkpoints": {"c": {"coordinates": [[6, 6], [7, 6], [7, 7]], "waiting_time": 2}},
    "journeys_v2": [{"id": "b", "sequence": ["c", "jps-exits_0"]}],
}
GEOMETRY = "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0), (4 4, 5 4, 5 5, 4 5, 4 4))"


def read(path, **options):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        plan = FloorPlan.from_file(path, **options)
    return plan, "\n".join(str(each.message) for each in found)


def zipped(path, config=CONFIG, geometry=GEOMETRY):
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("hall/geometry.wkt", geometry)
        archive.writestr("hall/config.json", json.dumps(config))
    return path


def test_a_topography_of_vadere(tmp_path):
    (tmp_path / "hall.scenario").write_text(json.dumps(VADERE))
    plan, said = read(tmp_path / "hall.scenario")
    assert (plan.name, plan.bounds) == ("hall", (1, 1, 21, 16))
    assert plan.area == 20 * 15 - 1 * 2 - 2 * 2 / 2
    (way_out,) = plan.exits
    assert sorted([way_out.a, way_out.b]) == [(21, 4), (21, 6)]
    (stairs,) = plan.zones
    assert (stairs.factor, stairs.downhill, stairs.area.area) == (0.5, (0, -1), 6)
    # Two at the start, and those who come later.
    assert "left out people of 2 sources: this is the floor plan alone" in said


@pytest.mark.parametrize("folder", [False, True])
def test_a_scenario_of_jupedsim(tmp_path, folder):
    path = tmp_path / "hall.zip"
    if folder:
        path = tmp_path / "hall"
        path.mkdir()
        (path / "geometry.wkt").write_text(GEOMETRY)
        (path / "config.json").write_text(json.dumps(CONFIG))
    else:
        zipped(path)
    plan, said = read(path, exits="longest")
    assert plan.area == 79
    assert [(each.name, each.length) for each in plan.exits] == [("jps-exits_0", 2)]
    assert plan.exits[0].midpoint == (10, 3)
    for part in ("left out people of 1 sources", "by 0.20 m", "--exits is ignored"):
        assert part in said


def changed(**more):
    data = deepcopy(VADERE)
    data["scenario"]["topography"].update(more)
    return data


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({}, "has no topography, expected a scenario of Vadere"),
        ([], "expected an object, found list"),
        (changed(obstacles={}), "topography: obstacles: expected a list, found dict"),
        (changed(obstacles=[element(1, {"type": "STAR"})]), "obstacle 1: shape 'STAR', expected"),
        (changed(obstacles=[element(1, rectangle(0, 0, -1, 1))]), "-1 by 1 m, expected more"),
        (changed(targets=[element(1, rectangle(0, 0, "2", 1))]), "got '2', expected a number"),
        (changed(targets=[]), "the floor plan has no exit"),
    ],
)
@pytest.mark.filterwarnings("ignore")
def test_faulty_topographies(tmp_path, data, message):
    (tmp_path / "hall.scenario").write_text(json.dumps(data))
    with pytest.raises(FloorPlanError, match=message):
        FloorPlan.from_file(tmp_path / "hall.scenario")


def test_faulty_archives(tmp_path):
    (tmp_path / "a.zip").write_bytes(b"PK no")
    with pytest.raises(FloorPlanError, match=r"a.zip: not a readable zip \(File is not a zip"):
        FloorPlan.from_file(tmp_path / "a.zip")
    with zipfile.ZipFile(tmp_path / "b.zip", "w") as archive:
        archive.writestr("config.json", "{}")
    with pytest.raises(FloorPlanError, match=r"b.zip: has 0 files geometry.wkt, expected one"):
        FloorPlan.from_file(tmp_path / "b.zip")
    with pytest.raises(FloorPlanError, match="one of the formats imdf or jupedsim"):
        FloorPlan.from_file(tmp_path)
    zipped(tmp_path / "c.zip", config={"exits": {"a": {"coordinates": [[0, 0], [1]]}}})
    with pytest.raises(FloorPlanError, match="exits: a: expected corners of two numbers"):
        FloorPlan.from_file(tmp_path / "c.zip")


def people_of(path, **options):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        _, people = read_scenario(path, **options)
    return people, "\n".join(str(each.message) for each in found)


def test_journeys_are_found_whatever_their_ids_are(tmp_path):
    """A number in one place and a text in another; a list is no id. Names of exits may be long."""
    config = deepcopy(CONFIG)
    long = "exit " * 20
    config["exits"][long] = config["exits"].pop("jps-exits_0")
    config["journeys_v2"] = [{"id": 7, "sequence": ["c", long]}]
    weights = [{"journey_id": "7", "weight": 1}, {"journey_id": ["b"], "weight": 3}]
    config["distributions"]["a"]["journey_weights"] = weights
    [one], _ = people_of(zipped(tmp_path / "hall.zip", config))
    assert (len(one.stops), one.exits) == (1, (long[:40],))


def test_all_people_of_a_scenario_are_counted(tmp_path):
    config = deepcopy(CONFIG)
    many = {**config["distributions"]["a"], "parameters": {"number": 15_000}}
    config["distributions"] = {"a": many, "b": many}
    with pytest.raises(FloorPlanError, match="b: more than 20,000 people in all"):
        people_of(zipped(tmp_path / "hall.zip", config))
    data = deepcopy(VADERE)
    sources = data["scenario"]["topography"]["sources"]
    sources[0]["spawner"] = {"eventElementCount": 15_000}
    sources.append(sources[0])
    (tmp_path / "hall.scenario").write_text(json.dumps(data))
    with pytest.raises(FloorPlanError, match="source 2: more than 20,000 people in all"):
        people_of(tmp_path / "hall.scenario")


def test_missing_targets_are_named_once(tmp_path):
    data = deepcopy(VADERE)
    data["scenario"]["topography"]["sources"][0]["targetIds"] = [*range(100, 200), "x", 3] * 50
    (tmp_path / "hall.scenario").write_text(json.dumps(data))
    _, said = people_of(tmp_path / "hall.scenario")
    assert said.count("there is no target") == 1
    assert "there is no target 'x', 100, 101" in said


@pytest.mark.parametrize("count", [60, pytest.param(1500, marks=pytest.mark.slow)])
def test_damaged_scenarios_are_plans_or_refused(tmp_path, count):
    assert read_all(json.dumps(VADERE).encode(), tmp_path / "hall.scenario", count) > 0
    whole = zipped(tmp_path / "hall.zip").read_bytes()
    assert read_all(whole, tmp_path / "hall.zip", count) > 0
    folder = tmp_path / "hall"
    folder.mkdir()
    (folder / "geometry.wkt").write_text(GEOMETRY)
    plans = 0
    for data in damaged(json.dumps(CONFIG).encode(), count):
        (folder / "config.json").write_bytes(data)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                FloorPlan.from_file(folder, exits="longest")
            plans += 1
        except FloorPlanError:
            continue
    assert plans > 0
