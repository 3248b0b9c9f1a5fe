import numpy as np
import pytest

from mesa_mobility.capture import Skeleton, leg_joints
from mesa_mobility.capture.legs import counterparts, leg_length
from mesa_mobility.errors import CaptureError

CHAINS = (-1, 0, 1, 2, 3, 0, 5, 6, 7)


def skeleton(left, right, root="Hips", parents=CHAINS):
    offsets = np.zeros((len(parents), 3))
    offsets[2:4, 1] = -0.5, -0.4
    offsets[6:8, 1] = -0.3, -0.4
    return Skeleton((root, *left.split(), *right.split()), parents, offsets)


@pytest.mark.parametrize(
    ("left", "right"),
    [
        (
            "LeftUpLeg LeftLeg LeftFoot LeftToeBase",
            "RightUpLeg RightLeg RightFoot RightToeBase",
        ),
        ("LeftUpLeg LeftLeg LeftFoot LeftToe", "RightUpLeg RightLeg RightFoot RightToe"),
        ("lfemur ltibia lfoot ltoes", "rfemur rtibia rfoot rtoes"),
        ("UpperLeg_L LowerLeg_L Foot_L Toes_L", "UpperLeg_R LowerLeg_R Foot_R Toes_R"),
        (
            "mixamorig:LeftUpLeg mixamorig:LeftLeg mixamorig:LeftFoot mixamorig:LeftToeBase",
            "mixamorig:RightUpLeg mixamorig:RightLeg mixamorig:RightFoot mixamorig:RightToeBase",
        ),
        ("LeftHip LeftKnee LeftAnkle LeftToe", "RightHip RightKnee RightAnkle RightToe"),
        (
            "LeftHip LeftKnee LeftAnkle LeftAnkle.end",
            "RightHip RightKnee RightAnkle RightAnkle.end",
        ),
        (
            "LeftUpperLeg LeftLowerLeg LeftFoot LeftToe",
            "RightUpperLeg RightLowerLeg RightFoot RightToe",
        ),
    ],
)
def test_legs_and_sides_are_known_by_the_names_in_use(left, right):
    known = skeleton(left, right)
    legs = leg_joints(known)
    assert legs.left == (1, 2, 3, 4)
    assert legs.right == (5, 6, 7, 8)
    assert counterparts(known).tolist() == [0, 5, 6, 7, 8, 1, 2, 3, 4]


def test_the_right_leg_may_come_first():
    legs = leg_joints(skeleton("rfemur rtibia rfoot rtoes", "lfemur ltibia lfoot ltoes"))
    assert legs.left == (5, 6, 7, 8)
    assert legs.right == (1, 2, 3, 4)


def test_unknown_names_are_listed_with_the_known_ones():
    with pytest.raises(CaptureError) as error:
        leg_joints(skeleton("a b c d", "e f g h", root="pelvis"))
    assert "no legs among the joints pelvis, a, b, c, d, e, f, g, h: expected " in str(error.value)
    for name in ("LeftUpLeg", "lfemur", "UpperLeg_L"):
        assert name in str(error.value)


def test_one_leg_is_not_enough():
    with pytest.raises(CaptureError) as error:
        leg_joints(skeleton("lfemur ltibia lfoot ltoes", "rfemur rtibia rfoot other"))
    assert str(error.value) == (
        "no legs: found lfemur, ltibia, lfoot, rfemur, rtibia, rfoot (CMU ASF), but not one of "
        "rtoes, or a single joint below rfoot that is called toe, toes, toebase, forefoot, ball "
        "(there: other)"
    )


@pytest.mark.parametrize(
    ("left", "right"),
    [
        ("LeftForeFoot", "RightForeFoot"),
        ("L_Ball", "R_Ball"),
        ("ball.L", "ball.R"),
        ("lForefoot", "rForefoot"),
        ("mixamorig:LeftToes", "mixamorig:RightToes"),
    ],
)
def test_the_joint_below_the_ankle_has_many_names(left, right):
    known = "{0}UpLeg {0}Leg {0}Foot {1}"
    legs = leg_joints(skeleton(known.format("Left", left), known.format("Right", right)))
    assert (legs.left, legs.right) == ((1, 2, 3, 4), (5, 6, 7, 8))


def test_two_joints_that_could_be_the_toes_are_named():
    parents = (-1, 0, 1, 2, 3, 3, 0, 6, 7, 8)
    names = (
        "Hips LeftUpLeg LeftLeg LeftFoot LeftToe1 LeftToe2 RightUpLeg RightLeg RightFoot RightToe"
    )
    with pytest.raises(
        CaptureError, match="but not one of LeftToeBase, LeftToe, or a single"
    ) as error:
        leg_joints(Skeleton(names.split(), parents, np.zeros((10, 3))))
    assert str(error.value).endswith("(there: LeftToe1, LeftToe2)")


def test_a_joint_that_is_missing_is_named():
    with pytest.raises(CaptureError) as error:
        leg_joints(
            skeleton(
                "LeftUpLeg LeftShin LeftFoot LeftToe", "RightUpLeg RightLeg RightFoot RightToe"
            )
        )
    assert str(error.value) == (
        "no legs: found LeftUpLeg, LeftFoot, RightUpLeg, RightLeg, RightFoot (CMU and ACCAD BVH, "
        "Mixamo), but not LeftLeg"
    )


def test_a_leg_must_hang_together():
    apart = skeleton(
        "lfemur ltibia lfoot ltoes",
        "rfemur rtibia rfoot rtoes",
        parents=(-1, 0, 1, 2, 3, 0, 0, 6, 7),
    )
    with pytest.raises(CaptureError, match="'rtibia' does not hang from 'rfemur'"):
        leg_joints(apart)


def test_a_joint_between_hip_and_knee_belongs_to_the_leg():
    names = "Hips LeftUpLeg twist LeftLeg LeftFoot LeftToe RightUpLeg RightLeg RightFoot RightToe"
    offsets = np.zeros((10, 3))
    offsets[2:5, 1] = -0.25, -0.25, -0.4
    offsets[7:9, 1] = -0.5, -0.4
    long = Skeleton(names.split(), (-1, 0, 1, 2, 3, 4, 0, 6, 7, 8), offsets)
    assert leg_joints(long).left == (1, 3, 4, 5)
    assert leg_length(long) == pytest.approx(0.9)


def test_leg_length_is_the_mean_of_both_legs():
    legs = skeleton("lfemur ltibia lfoot ltoes", "rfemur rtibia rfoot rtoes")
    assert leg_length(legs) == pytest.approx(0.8)


def test_joints_without_a_counterpart_stay_where_they_are():
    names = ("root", "lowerback", "lprop", "lfemur", "rfemur", "lfemur.end", "rfemur.end")
    single = Skeleton(names, (-1, 0, 1, 0, 0, 3, 4), np.zeros((7, 3)))
    assert counterparts(single).tolist() == [0, 1, 2, 4, 3, 6, 5]


def test_names_that_pair_off_in_circles_stay_where_they_are():
    # rX_l pairs with rX_r by its end; lX_l would pair with rX_l by its beginning.
    names = ("root", "rX_l", "rX_r", "lX_l")
    circle = Skeleton(names, (-1, 0, 0, 0), np.zeros((4, 3)))
    assert counterparts(circle).tolist() == [0, 2, 1, 3]
