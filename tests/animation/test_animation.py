"""Files of moving people: read back by other readers than the writers."""

import json
import shutil
import struct
import subprocess

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp
from shapely import box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.animation import Selection, walkers, write_bvh, write_film, write_glb
from mesa_mobility.animation.figures.figure import human_figure, rest_positions
from mesa_mobility.animation.keyed import within_of
from mesa_mobility.animation.scenery import surfaces
from mesa_mobility.bodies.skeleton import JOINTS, PARENTS
from mesa_mobility.capture.bvh import read_bvh
from mesa_mobility.errors import ResultsError

TYPES = {5120: "i1", 5126: "<f4", 5122: "<i2", 5123: "<u2", 5121: "u1"}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def read_glb(path):
    """The JSON of a binary glTF file, and a function that gives an accessor's values."""
    content = path.read_bytes()
    assert struct.unpack("<4sII", content[:12]) == (b"glTF", 2, len(content))
    length = struct.unpack("<I", content[12:16])[0]
    described = json.loads(content[20 : 20 + length])
    binary = content[28 + length :]

    def values(number):
        accessor = described["accessors"][number]
        view = described["bufferViews"][accessor["bufferView"]]
        kind, width = np.dtype(TYPES[accessor["componentType"]]), WIDTHS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        found = np.frombuffer(binary, kind, accessor["count"] * width, start)
        found = found.reshape(accessor["count"], width).astype(np.float64)
        most = {5122: 32767, 5120: 127}
        return found / most[accessor["componentType"]] if accessor.get("normalized") else found

    return described, values


def joints_in_glb(path, person, seconds):
    """(22, 3) world positions, y up, that a viewer shows at a time: nodes one below the other."""
    described, values = read_glb(path)
    nodes = described["nodes"]
    animation = described["animations"][0]
    moved = {}
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        times, output = values(sampler["input"])[:, 0], values(sampler["output"])
        at = max(int(np.searchsorted(times, seconds + 1e-6)) - 1, 0)
        what, now = channel["target"]["path"], output[at]
        if sampler["interpolation"] == "LINEAR" and seconds > times[at] and at + 1 < len(times):
            share = (seconds - times[at]) / (times[at + 1] - times[at])
            if what == "rotation":
                now = Slerp([0, 1], Rotation.from_quat(output[at : at + 2]))(share).as_quat()
            else:
                now = (1 - share) * now + share * output[at + 1]
        moved[channel["target"]["node"], what] = now
    parents = {child: k for k, node in enumerate(nodes) for child in node.get("children", [])}

    def matrix(k):
        node, found = nodes[k], np.eye(4)
        turned = moved.get((k, "rotation"), node.get("rotation", [0, 0, 0, 1]))
        size = moved.get((k, "scale"), node.get("scale", [1, 1, 1]))
        found[:3, :3] = Rotation.from_quat(turned).as_matrix() * size
        found[:3, 3] = moved.get((k, "translation"), node.get("translation", [0, 0, 0]))
        return matrix(parents[k]) @ found if k in parents else found

    names = {node.get("name"): k for k, node in enumerate(nodes)}
    return np.array([matrix(names[f"{person}.{joint}"])[:3, 3] for joint in JOINTS])


def test_joints_in_a_glb_are_where_ours_are(run, plan, tmp_path):
    path = tmp_path / "crowd.glb"
    write_glb(walkers(run, Selection()), plan, path)
    off = []
    for person in (0, 1):
        motion = run.poses(person)
        for frame in (0, 7, 20, 31, 40):
            found = joints_in_glb(path, person, frame / 30)
            x, y, z = motion.at(frame).positions[0].T
            off.append(np.linalg.norm(found - np.column_stack([x, z, -y]), axis=1))
    # Each joint on the way to a foot or a hand, and the pelvis, may add 5 mm.
    assert np.max(off) < 0.025
    assert np.mean(off) < 0.005


def test_a_large_crowd_is_told_more_coarsely(run, plan, tmp_path):
    assert [within_of(people) for people in (1, 60, 100)] == [0.005] * 3
    assert within_of(750) == pytest.approx(0.025, abs=0.0005)
    sizes = []
    for within in (0.005, 0.025):
        path = tmp_path / f"{within}.glb"
        write_glb(walkers(run, Selection()), plan, path, within=within)
        described, values = read_glb(path)
        animation = described["animations"][0]
        outputs = [
            described["accessors"][animation["samplers"][each["sampler"]]["output"]]
            for each in animation["channels"]
            if each["target"]["path"] == "rotation"
        ]
        sizes.append(sum(each["count"] * (4 if within > 0.01 else 8) for each in outputs))
        for each in outputs:
            length = np.linalg.norm(values(described["accessors"].index(each)), axis=1)
            assert np.abs(length - 1).max() < 0.0077  # of Khronos' validator
        off = []
        for frame in range(0, 60, 7):
            found = joints_in_glb(path, 0, frame / 30)
            x, y, z = run.poses(0).at(frame).positions[0].T
            off.append(np.linalg.norm(found - np.column_stack([x, z, -y]), axis=1))
        assert np.mean(off) < within
        assert np.max(off) < 4 * within
    assert sizes[1] < 0.25 * sizes[0]
    with pytest.raises(ResultsError, match="within 0 m"):
        write_glb(walkers(run, Selection()), plan, path, within=0)


def test_motion_is_told_by_fewer_frames_than_there_are(run, plan, tmp_path):
    path = tmp_path / "crowd.glb"
    write_glb(walkers(run, Selection()), plan, path)
    described, _ = read_glb(path)
    animation = described["animations"][0]
    keys = [described["accessors"][each["output"]]["count"] for each in animation["samplers"]]
    # Of 17 joints and a pelvis, 30 frames a second.
    frames = sum(len(run.poses(person).frames) for person in (0, 1))
    assert sum(keys) < 0.6 * 18 * frames


def test_who_has_left_is_seen_no_more(run, plan, tmp_path):
    path = tmp_path / "crowd.glb"
    write_glb(walkers(run, Selection()), plan, path)
    gone = run.exit_frames[1]
    assert gone > 0
    spread = np.ptp(joints_in_glb(path, 1, (gone + 2) / 30), axis=0)
    np.testing.assert_allclose(spread, 0.0, atol=1e-6)


def test_all_people_share_one_mesh(run, plan, tmp_path):
    path = tmp_path / "crowd.glb"
    write_glb(walkers(run, Selection()), plan, path)
    described, _ = read_glb(path)
    places = {
        mesh["primitives"][0]["attributes"]["POSITION"]
        for mesh in described["meshes"]
        if mesh["name"] == "person"
    }
    assert len(places) == 1
    assert len(described["skins"]) == 2


@pytest.mark.slow
def test_khronos_finds_nothing_to_complain_about(run, plan, tmp_path):
    npm, node = shutil.which("npm"), shutil.which("node")
    if npm is None or node is None:
        pytest.skip("no npm, which Khronos' validator needs")
    got = subprocess.run(
        [npm, "install", "--prefix", tmp_path, "gltf-validator@2.0.0-dev.3.10"],
        capture_output=True,
        text=True,
    )
    if got.returncode != 0:
        pytest.skip(f"npm cannot install gltf-validator: {got.stderr.strip()[-200:]}")
    write_glb(walkers(run, Selection()), plan, tmp_path / "crowd.glb")
    script = (
        "require('gltf-validator').validateBytes(new Uint8Array("
        "require('fs').readFileSync('crowd.glb'))).then(r => console.log(JSON.stringify(r.issues)))"
    )
    said = subprocess.run([node, "-e", script], cwd=tmp_path, capture_output=True, text=True)
    issues = json.loads(said.stdout)
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues


def test_a_bvh_file_reads_back_as_the_same_motion(run, tmp_path):
    motion = run.poses(0)
    write_bvh(motion, tmp_path / "person.bvh")
    again = read_bvh(tmp_path / "person.bvh", unit_to_m=0.01)
    assert again.frame_rate == 30
    positions = again.positions()
    plain = {name: j for j, name in enumerate(again.skeleton.names)}
    ends = {
        "crown": "head",
        "left_wrist": "left_elbow",
        "left_toe": "left_ankle",
        "right_wrist": "right_elbow",
        "right_toe": "right_ankle",
    }
    for j, joint in enumerate(JOINTS):
        number = again.skeleton.names.index(ends[joint] + ".end") if joint in ends else plain[joint]
        np.testing.assert_allclose(positions[:, number], motion.positions[:, j], atol=0.001)


def test_the_figure_is_whole():
    figure = human_figure()
    np.testing.assert_allclose(figure.weights.sum(axis=1), 1.0, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(figure.normals, axis=1), 1.0, atol=1e-5)
    assert figure.joints.max() < len(JOINTS)
    assert figure.triangles.max() == len(figure.vertices) - 1
    # Soles at the height of the floor, below a pelvis at rest; as tall as an adult.
    height = np.ptp(figure.vertices[:, 2])
    assert 1.65 < height < 1.85
    rest = rest_positions()
    bones = np.linalg.norm(rest[1:] - rest[PARENTS[1:]], axis=1)
    assert bones.max() == pytest.approx(0.431)


def test_only_whom_and_when_one_asks_for(run):
    (only,) = walkers(run, Selection(people=(0,), start=0.5, end=1.0))
    assert (only.person, only.first, len(only.motion)) == (0, 15, 16)
    for wrong, what in (
        (Selection(people=(7,)), "person 7"),
        (Selection(start=2.0, end=1.0), "from 2 to 1 s"),
        (Selection(end=99.0), "within the run's"),
    ):
        with pytest.raises(ResultsError, match=what):
            list(walkers(run, wrong))


@pytest.mark.thorough
def test_a_film_has_a_picture_for_each_fifteenth_of_a_second(run, plan, tmp_path):
    from PIL import Image

    path = tmp_path / "crowd.gif"
    seen = []
    write_film(run, plan, path, Selection(end=1.0), progress=lambda done, of: seen.append(done))
    with Image.open(path) as film:
        assert film.n_frames == 16
    assert seen == list(range(1, 17))
    with pytest.raises(ResultsError, match="films end with"):
        write_film(run, plan, tmp_path / "crowd.avi")
    with pytest.raises(ResultsError, match="speed -1"):
        write_film(run, plan, path, speed=-1.0)


def test_walls_are_divided_among_meshes_of_so_many_vertices():
    blocks = [box(2 * k + 1, 1, 2 * k + 2, 2) for k in range(4)]
    plan = FloorPlan(box(0, 0, 10, 4), obstacles=blocks, exits=[Exit("door", (10, 1), (10, 2))])
    (whole,) = (len(each.vertices) for each in surfaces(plan) if each.name == "walls")
    # Walls round the floor have 12 faces with an exit; a block has 4; 4 corners each.
    assert whole == 4 * 12 + 4 * 4 * 4
    parts = [len(each.vertices) for each in surfaces(plan, 48) if each.name == "walls"]
    assert sorted(parts) == [16, 48, 48]
