"""OpenUSD files, read back by Pixar's own library."""

import sys
from dataclasses import replace

import numpy as np
import pytest

from mesa_mobility.animation import Selection, walkers, write_usd
from mesa_mobility.animation.figures.aids import figure_with
from mesa_mobility.animation.figures.figure import human_figure
from mesa_mobility.animation.people import Walker
from mesa_mobility.bodies import BodyMotion
from mesa_mobility.bodies.skeleton import JOINTS
from mesa_mobility.errors import ResultsError


@pytest.fixture(scope="module")
def pxr():
    return pytest.importorskip("pxr", reason="OpenUSD files need usd-core")


@pytest.fixture(scope="module")
def stage(pxr, run, plan, tmp_path_factory):
    from pxr import Usd

    path = tmp_path_factory.mktemp("usd") / "crowd.usd"
    write_usd(walkers(run, Selection()), plan, path)
    return Usd.Stage.Open(str(path))


def person_in(stage, person, frame):
    """World positions of somebody's joints and of the corners of its skin, as pxr has them."""
    from pxr import Usd, UsdGeom, UsdSkel

    root = UsdSkel.Root.Get(stage, f"/world/person_{person}")
    cache, time = UsdSkel.Cache(), Usd.TimeCode(frame)
    cache.Populate(root, Usd.PrimDefaultPredicate)
    (binding,) = cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate)
    (skinned,) = binding.GetSkinningTargets()
    skeleton = cache.GetSkelQuery(binding.GetSkeleton())
    names = [str(name).rpartition("/")[2] for name in skeleton.GetJointOrder()]
    assert names == list(JOINTS)
    corners = UsdGeom.Mesh(skinned.GetPrim()).GetPointsAttr().Get()
    assert skinned.ComputeSkinnedPoints(skeleton.ComputeSkinningTransforms(time), corners, time)
    placed = np.array(UsdGeom.Xformable(root).ComputeLocalToWorldTransform(time))
    joints = np.array(skeleton.ComputeJointSkelTransforms(time))[:, 3, :3]
    return tuple(each @ placed[:3, :3] + placed[3, :3] for each in (joints, np.array(corners)))


def visible(stage, person, frame):
    from pxr import Usd, UsdGeom

    prim = UsdGeom.Imageable.Get(stage, f"/world/person_{person}")
    return prim.ComputeVisibility(Usd.TimeCode(frame)) == UsdGeom.Tokens.inherited


def test_joints_are_where_ours_are(stage, run):
    for person in (0, 1):
        motion = run.poses(person)
        for frame in (0, 7, 20, 31, 40):
            joints, _ = person_in(stage, person, frame)
            np.testing.assert_allclose(joints, motion.at(frame).positions[0], atol=1e-5)


def test_somebody_who_walks_stands_on_the_floor(stage, run):
    lowest = [person_in(stage, 0, frame)[1][:, 2].min() for frame in range(0, 41, 2)]
    # The tip of the shoe, which no joint holds, is up to 4 cm too low while the heel rises.
    assert np.mean(lowest) == pytest.approx(0.0, abs=0.025)
    assert -0.04 < min(lowest) <= max(lowest) < 0.02


def test_skin_is_round_the_joints(stage, run):
    joints, corners = person_in(stage, 0, 20)
    assert len(corners) == len(human_figure().vertices)
    # Nothing further from a joint than half a trunk is long.
    apart = np.linalg.norm(corners[:, None] - joints, axis=2).min(axis=1)
    assert apart.max() < 0.25
    from pxr import Usd, UsdSkel

    low, high = UsdSkel.Root.Get(stage, "/world/person_0").GetExtentAttr().Get(Usd.TimeCode(20))
    assert np.all(corners >= np.array(low))
    assert np.all(corners <= np.array(high))


def test_people_are_seen_while_they_are_there(stage, run):
    gone = int(run.exit_frames[1])
    assert gone > 0
    last = int(run.poses(1).frames[-1])
    assert [visible(stage, 1, frame) for frame in (0, last, last + 1)] == [True, True, False]
    assert visible(stage, 0, last + 1)


def test_metres_seconds_and_the_plan(stage, run, plan):
    from pxr import UsdGeom

    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert UsdGeom.GetStageUpAxis(stage) == "Z"
    assert stage.GetTimeCodesPerSecond() == 30
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0, round(run.duration * 30))
    walls = np.array(UsdGeom.Mesh.Get(stage, "/world/walls").GetPointsAttr().Get())
    # The room of 8 m x 4 m with walls of 0.15 m, on the floor that reaches 0.5 m further.
    np.testing.assert_allclose(walls.min(axis=0), [-0.15, -0.15, 0], atol=1e-6)
    np.testing.assert_allclose(walls.max(axis=0), [8.15, 4.15, 1.2], atol=1e-6)
    floor = np.array(UsdGeom.Mesh.Get(stage, "/world/floor").GetPointsAttr().Get())
    assert (floor.min(axis=0).tolist(), floor.max(axis=0).tolist()) == (
        [-0.5, -0.5, 0],
        [8.5, 4.5, 0],
    )


def test_people_share_one_mesh(stage):
    layer = stage.GetRootLayer()
    owners = [
        path
        for path in ("/figure/body", "/world/person_0/body", "/world/person_1/body")
        if "points" in layer.GetPrimAtPath(path).attributes
    ]
    assert owners == ["/figure/body"]


def test_pixars_validators_find_nothing(stage):
    from pxr import Usd

    if Usd.GetVersion() < (0, 26, 11):
        pytest.skip("the wheels of usd-core 25.8 and 25.11 lack a file that their validators open")
    validation = pytest.importorskip("pxr.UsdValidation")
    registry = validation.ValidationRegistry()
    context = validation.ValidationContext(registry.GetOrLoadAllValidators())
    found = context.Validate(stage)
    assert [f"{each.GetName()}: {each.GetMessage()}" for each in found] == []


def test_small_people_are_small(pxr, run, plan, tmp_path):
    from pxr import Usd

    adult = run.poses(0)
    child = BodyMotion(
        adult.frames, adult.positions * 0.7, adult.rotations, adult.bearing, scale=0.7
    )
    write_usd([Walker(0, 0, child)], plan, tmp_path / "child.usda")
    small = Usd.Stage.Open(str(tmp_path / "child.usda"))
    joints, corners = person_in(small, 0, 31)
    np.testing.assert_allclose(joints, 0.7 * adult.positions[31], atol=1e-5)
    assert np.ptp(corners[:, 2]) < 0.7 * 1.85


def test_people_in_wheelchairs_sit(pxr, run, plan, tmp_path):
    from pxr import Usd

    mixed = replace(run, person_data={"type": np.array(["wheelchair_manual", "able_bodied"])})
    write_usd(walkers(mixed, Selection()), plan, tmp_path / "mixed.usd")
    again = Usd.Stage.Open(str(tmp_path / "mixed.usd"))
    joints, corners = person_in(again, 0, 31)
    row = run.rows_of(0)[31]
    np.testing.assert_allclose(joints[0], [run.x[row], run.y[row], 0.55], atol=1e-5)
    assert len(corners) == len(figure_with("wheelchair").vertices)
    # Wheels of ten corners stand on the floor; a head is 1.2 m to 1.5 m up.
    assert corners[:, 2].min() == pytest.approx(0.0, abs=0.005)
    assert 1.2 < corners[:, 2].max() < 1.5
    assert len(person_in(again, 1, 31)[1]) == len(human_figure().vertices)


def test_what_cannot_be_written(pxr, run, plan, tmp_path, monkeypatch):
    people = list(walkers(run, Selection(people=(1,), end=0.5)))
    with pytest.raises(ResultsError, match=r"crowd\.fbx: expected a name that ends with \.usd"):
        write_usd(people, plan, tmp_path / "crowd.fbx")
    with pytest.raises(ResultsError, match="cannot be written"):
        write_usd(people, plan, tmp_path / "absent" / "crowd.usd")
    monkeypatch.setitem(sys.modules, "pxr", None)
    with pytest.raises(ResultsError, match=r"pip install 'mesa-mobility\[usd\]'"):
        write_usd(people, plan, tmp_path / "crowd.usd")
