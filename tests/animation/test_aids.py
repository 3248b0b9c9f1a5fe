"""Sticks, frames and wheelchairs."""

from dataclasses import replace

import numpy as np
import pytest

from mesa_mobility.animation import Selection, walkers, write_glb
from mesa_mobility.animation.figures.aids import FLOOR, aid_of, figure_with
from mesa_mobility.animation.figures.clothes import PARTS
from mesa_mobility.animation.figures.figure import human_figure
from mesa_mobility.animation.figures.levels import jointed_figures, rigid_figures, seated_head
from mesa_mobility.bodies.skeleton import JOINT
from tests.animation.test_animation import joints_in_glb, read_glb


@pytest.mark.parametrize(
    ("type_name", "aid"),
    [("cane", "cane"), ("wheelchair_powered", "wheelchair"), ("child", ""), ("", "")],
)
def test_what_types_hold_or_sit_in(type_name, aid):
    assert aid_of(type_name) == aid


@pytest.mark.parametrize(
    ("aid", "carriers", "floor"),
    [
        ("cane", {"left_elbow"}, FLOOR),
        ("crutches", {"left_elbow", "right_elbow"}, FLOOR),
        ("walking_frame", {"pelvis"}, FLOOR),
        ("wheelchair", {"pelvis"}, -0.55),
    ],
)
def test_aids_are_rigid_and_reach_the_floor(aid, carriers, floor):
    plain, figure = human_figure(), figure_with(aid)
    # The body is as without; what is held comes after it.
    own = len(plain.vertices)
    np.testing.assert_array_equal(figure.vertices[:own], plain.vertices)
    assert set(figure.joints[own:, 0].tolist()) == {JOINT[name] for name in carriers}
    np.testing.assert_array_equal(figure.weights[own:, 0], 1.0)
    assert 0.0 <= figure.vertices[own:, 2].min() - floor <= 0.031
    assert figure.triangles.max() == len(figure.vertices) - 1


def test_a_wheelchair_takes_the_room_of_one():
    chair = figure_with("wheelchair").vertices[len(human_figure().vertices) :]
    long, wide = np.ptp(chair[:, :2], axis=0)
    # 1.20 m with the feet, 0.70 m.
    assert 0.9 < long <= 1.2
    assert 0.55 < wide <= 0.70


@pytest.mark.parametrize("level", ["near", "far"])
def test_somebody_who_sits_is_bent_and_not_stretched(level):
    upright, sitting = jointed_figures()[f"person_{level}"], rigid_figures()[f"seated_{level}"]
    edges = upright.triangles[:, :2]
    # Parts that one joint moves.
    own = (upright.weights[edges, 0] == 1.0).all(axis=1)
    own &= upright.joints[edges[:, 0], 0] == upright.joints[edges[:, 1], 0]
    assert own.mean() > 0.4
    before, after = (
        np.linalg.norm(np.diff(each.vertices[edges[own]], axis=1)[:, 0], axis=1)
        for each in (upright, sitting)
    )
    np.testing.assert_allclose(after, before, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(sitting.normals, axis=1), 1.0, atol=0.3)
    # Hips 0.55 m above the floor: shanks of 0.42 m and 0.08 m of foot are upright below the knees.
    assert 0.0 < sitting.vertices[:, 2].min() < 0.1
    shank = sitting.vertices[upright.joints[:, 0] == JOINT["left_ankle"]]
    assert 0.3 < shank[:, 0].mean() < 0.6
    x, y, z = seated_head()
    head = sitting.vertices[
        (upright.joints[:, 0] == JOINT["head"]) & (upright.parts == PARTS.index("skin"))
    ]
    np.testing.assert_allclose(head.mean(axis=0), [x + 0.02, y, z + 0.07], atol=0.02)


@pytest.mark.parametrize("level", ["near", "far"])
def test_aids_of_the_view_are_those_of_the_files(level):
    for aid in ("cane", "crutches", "walking_frame", "wheelchair"):
        drawn = {**jointed_figures(), **rigid_figures()}[f"{aid}_{level}"].vertices
        whole = figure_with(aid).vertices[len(human_figure().vertices) :]
        whole = whole + np.array([0.0, 0.0, 0.55 if aid == "wheelchair" else 0.0])
        # The fewer corners a bar has, the narrower it may be: by half of the widest wheel's radius
        # at three, and by 0.14 of it at six.
        for side in (np.min, np.max):
            np.testing.assert_allclose(side(drawn, axis=0), side(whole, axis=0), atol=0.045)


def test_people_in_wheelchairs_sit_and_need_no_poses(run, plan, tmp_path):
    types = np.array(["wheelchair_manual", "cane"])
    mixed = replace(run, person_data={"type": types})
    path = tmp_path / "crowd.glb"
    write_glb(walkers(mixed, Selection()), plan, path)
    rows = run.rows_of(0)
    for frame in (0, 31):
        joints = joints_in_glb(path, 0, frame / 30)
        pelvis = joints[JOINT["pelvis"]]
        np.testing.assert_allclose(
            pelvis, [run.x[rows[frame]], 0.55, -run.y[rows[frame]]], atol=0.0055
        )
        assert joints[JOINT["left_knee"], 1] == pytest.approx(0.55, abs=0.0005)
    described, values = read_glb(path)
    sizes = {
        len(values(mesh["primitives"][0]["attributes"]["POSITION"]))
        for mesh in described["meshes"]
        if mesh["name"] == "person"
    }
    assert sizes == {len(figure_with(aid).vertices) for aid in ("wheelchair", "cane")}
