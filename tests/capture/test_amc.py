import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility.capture import read_amc, read_recording
from mesa_mobility.errors import CaptureError

ASF = """# a leg whose own axes are turned by 90 degrees about z
:version 1.10
:units
  length 0.45
  angle deg
:documentation
  begin with a hip
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name lhipjoint
    direction 2 0 0
    length 3
    axis 0 0 0 XYZ
  end
  begin
    id 2
    name lfemur
    direction 0 0 -1
    length 4
    axis 0 0 90 XYZ
    dof rx ry
    limits (-160.0 20.0)
           (-70.0 70.0)
  end
:hierarchy
  begin
    root lhipjoint
    lhipjoint lfemur
  end
"""

AMC = """#!OML:ASF
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 0 0 0
lfemur 0 0
2
root 1 2 3 0 90 0
lfemur 90 0
"""


@pytest.fixture
def amc(write):
    """Write an ASF and an AMC file, by default the ones above, and give the AMC's path."""

    def put(amc_text=AMC, asf_text=ASF):
        write("16.asf", asf_text)
        return write("16_11.amc", amc_text)

    return put


def test_a_bone_becomes_the_joint_at_its_start(amc):
    recording = read_amc(amc(), unit_to_m=0.1)
    assert recording.skeleton.names == ("root", "lhipjoint", "lfemur", "lfemur.end")
    assert recording.name == "16_11"
    assert recording.frame_rate == 120.0
    # Root at (X, Y, Z) = (1, 2, 3); the hip 3 along X; the knee 4 against Z.
    expected = [[0.3, 0.1, 0.2], [0.3, 0.1, 0.2], [0.3, 0.4, 0.2], [-0.1, 0.4, 0.2]]
    np.testing.assert_allclose(recording.positions()[0], expected, atol=1e-15)


def test_a_bone_turns_about_its_own_axes_below_what_the_root_turned(amc):
    # The bone's own x is the file's Y: 90 degrees take -Z to -X.  The root's 90 degrees about Y
    # take X to -Z and -X to Z.
    positions = read_amc(amc(), unit_to_m=1.0).positions()[1]
    np.testing.assert_allclose(positions, [[3, 1, 2], [3, 1, 2], [0, 1, 2], [4, 1, 2]], atol=1e-14)


def test_the_frame_rate_can_be_given(amc):
    assert read_amc(amc(), unit_to_m=1.0, frame_rate=60.0).frame_rate == 60.0
    assert read_recording(amc(), unit_to_m=1.0, frame_rate=60.0).frame_rate == 60.0


def test_angles_can_be_in_radians(amc):
    quarter = str(np.pi / 2)
    radians = AMC.replace(":DEGREES", ":RADIANS").replace("90", quarter)
    expected = read_amc(amc(), unit_to_m=1.0).positions()
    np.testing.assert_allclose(
        read_amc(amc(radians), unit_to_m=1.0).positions(), expected, atol=1e-14
    )
    skeleton = ASF.replace("angle deg", "angle rad").replace("0 0 90 XYZ", f"0 0 {quarter} XYZ")
    unsaid = radians.replace(":RADIANS\n", "")
    np.testing.assert_allclose(
        read_amc(amc(unsaid, skeleton), unit_to_m=1.0).positions(), expected, atol=1e-14
    )


def test_the_skeleton_is_found_by_the_clip_s_name_the_subject_s_or_as_the_only_one(write):
    path = write("16_11.amc", AMC)
    lengths = {}
    for name, length in (("other.asf", 1), ("16.asf", 2), ("16_11.asf", 3)):
        write(name, ASF.replace("length 4", f"length {length}"))
        lengths[name] = read_amc(path, unit_to_m=1.0).skeleton.offsets[3, 2]
    assert lengths == {"other.asf": -1, "16.asf": -2, "16_11.asf": -3}
    other = path.with_name("other.asf")
    assert read_amc(path, asf=other, unit_to_m=1.0).skeleton.offsets[3, 2] == -1


def test_an_amc_file_without_its_skeleton_is_refused(write):
    path = write("16_11.amc", AMC)
    with pytest.raises(CaptureError, match=r"without its ASF, expected 16\.asf .* no \.asf file$"):
        read_amc(path, unit_to_m=1.0)
    write("a.asf", ASF)
    write("b.asf", ASF)
    with pytest.raises(CaptureError, match=r"expected 16\.asf beside it, found a\.asf, b\.asf$"):
        read_amc(path, unit_to_m=1.0)
    with pytest.raises(CaptureError, match=r"gone\.asf: cannot be read"):
        read_amc(path, asf=path.with_name("gone.asf"), unit_to_m=1.0)


BAD_AMC = [
    ("1\nroot", "root", "line 4: 'root 1 2 3 0 0 0', expected the number of a frame"),
    ("lfemur 90 0\n", "", "line 7: frame without lfemur (truncated?)"),
    ("lfemur 0 0\n", "", "line 4: frame without lfemur (truncated?)"),
    ("lfemur 90 0", "lfemur 90", "line 9: 1 values, expected 2"),
    ("lfemur 90 0", "lfemur 90 0 0", "line 9: 3 values, expected 2"),
    ("lfemur 90 0", "lfemur 90 nan", "line 9: 'nan', expected a finite number"),
    ("root 1 2 3 0 90", "root 1 2 inf 0 90", "line 8: 'inf', expected a finite number"),
    ("lfemur 0 0", "lfemur 0 0\nlfemur 0 0", "line 7: bone 'lfemur' occurs twice in the frame"),
    ("lfemur 0 0", "ltibia 0", "line 6: 'ltibia', expected a bone that has channels in the ASF"),
    ("lfemur 0 0", "lhipjoint 0", "line 6: 'lhipjoint', expected a bone that has channels"),
    ("\n2\n", "\n3\n", "line 7: frame 3, expected 2"),
    ("\n2\n", f"\n{'9' * 5000}\n", "expected a whole number"),
    (AMC, ":FULLY-SPECIFIED\n:DEGREES\n", "no frames (truncated?)"),
    (AMC, "", "empty file"),
    ("root 1 2 3 0 0 0", "root\0", "line 5: zero byte, expected a text file"),
]


@pytest.mark.parametrize(("good", "bad", "message"), BAD_AMC)
def test_a_bad_amc_file_is_named_with_the_line_and_what_was_expected(amc, good, bad, message):
    assert good in AMC
    path = amc(AMC.replace(good, bad, 1))
    with pytest.raises(CaptureError) as error:
        read_amc(path, unit_to_m=1.0)
    assert str(error.value).startswith(str(path))
    assert message in str(error.value)
    assert "\n" not in str(error.value)


BAD_ASF = [
    (":version", "version", "line 2: 'version 1.10', expected an ASF keyword"),
    ("angle deg", "angle gon", "line 5: angle 'gon', expected deg or rad"),
    ("  order TX TY TZ RX RY RZ\n", "", "section :root has no order"),
    ("order TX TY", "order TX TX", "line 9: channel 'tx', expected each of tx, ty, tz, rx"),
    ("position 0 0 0", "position 0 1 0", "line 11: root position 0 1 0, expected 0 0 0"),
    ("orientation 0 0 0", "orientation 0 0", "line 12: 2 values, expected 3"),
    (":bonedata", ":bones", "no section :bonedata"),
    (ASF[ASF.index(":hierarchy") :], "", "no section :hierarchy (truncated, or no ASF?)"),
    ("    root lhipjoint\n    lhipjoint lfemur\n  end\n", "", ":hierarchy has no 'end'"),
    ("  end\n  begin\n    id 2", "  begin\n    id 2", "line 20: 'begin' inside of a bone"),
    ("(-70.0 70.0)\n  end", "(-70.0 70.0)", "line 21: bone without 'end' (truncated?)"),
    ("  begin\n    id 1", "    id 1", "line 14: 'id', expected 'begin' of a bone"),
    ("    name lfemur\n", "", "line 21: bone without name"),
    ("name lfemur", "name", "line 23: '', expected the name of a bone"),
    ("name lfemur", "name lhipjoint", "line 21: bone 'lhipjoint' occurs twice"),
    ("name lfemur", "name root", "line 21: bone 'root' occurs twice"),
    ("    direction 0 0 -1\n", "", "line 21: bone without direction"),
    ("direction 0 0 -1", "direction 0 0 0", "line 21: bone lfemur has no length in any direction"),
    ("direction 0 0 -1", "direction 0 0 nan", "line 24: 'nan', expected a finite number"),
    ("length 4", "length -4", "line 21: bone lfemur has no length in any direction"),
    ("length 4", "length", "line 25: 0 values, expected 1"),
    ("0 0 90 XYZ", "0 0 90 XYY", "line 26: axis order 'xyy', expected XYZ or another order"),
    ("0 0 90 XYZ", "0 0 90", "line 26: axis order '90', expected XYZ or another order"),
    ("0 0 90 XYZ", "", "line 26: axis order '', expected XYZ or another order"),
    ("0 0 90 XYZ", "0 90 XYZ", "line 26: 2 values, expected 3"),
    ("dof rx ry", "dof rx tx", "line 27: channel 'tx', expected each of rx, ry, rz at most once"),
    ("    lhipjoint lfemur\n", "", "line 21: bone 'lfemur' does not hang from the root"),
    ("lhipjoint lfemur\n", "lhipjoint ltibia\n", "line 34: bone 'ltibia' is not in :bonedata"),
    ("lhipjoint lfemur\n", "lhipjoint root\n", "line 34: bone 'root' has a second parent"),
    ("root lhipjoint\n", "root lhipjoint lfemur\n", "line 34: bone 'lfemur' has a second parent"),
    (ASF, "", "empty file"),
    (ASF, "\0\1\2", "line 1: zero byte"),
]


@pytest.mark.parametrize(("good", "bad", "message"), BAD_ASF)
def test_a_bad_asf_file_is_named_with_the_line_and_what_was_expected(amc, good, bad, message):
    assert good in ASF
    path = amc(asf_text=ASF.replace(good, bad, 1))
    with pytest.raises(CaptureError) as error:
        read_amc(path, unit_to_m=1.0)
    assert str(error.value).startswith(str(path.with_name("16.asf")))
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_bones_that_hang_from_each_other_are_refused(amc):
    circle = ASF.replace("root lhipjoint\n", "lfemur lhipjoint\n")
    with pytest.raises(CaptureError, match="'lhipjoint' does not hang from the root"):
        read_amc(amc(asf_text=circle), unit_to_m=1.0)


def test_a_motion_cut_off_within_a_frame_is_refused(amc):
    second = AMC.index("2\nroot")
    for end in range(second + 2, len(AMC) - 3):
        with pytest.raises(CaptureError):
            read_amc(amc(AMC[:end]), unit_to_m=1.0)


def test_a_skeleton_cut_off_anywhere_is_refused(amc):
    for end in range(len(ASF.rstrip())):
        with pytest.raises(CaptureError):
            read_amc(amc(asf_text=ASF[:end]), unit_to_m=1.0)


@settings(deadline=None, max_examples=150)
@given(seed=st.integers(0, 2**32 - 1), noise=st.binary(max_size=40))
def test_damaged_files_are_read_or_refused_in_one_line(tmp_path_factory, seed, noise):
    rng = random.Random(seed)
    folder = tmp_path_factory.mktemp("damaged")
    for name, text in (("16.asf", ASF), ("16_11.amc", AMC)):
        data = bytearray(text.encode())
        for _ in range(rng.randint(0, 3)):
            data[rng.randrange(len(data))] = rng.choice(b"\0\n:# 0-e.xbeginend\xe9")
        at = rng.randrange(len(data))
        data[at : at + len(noise)] = noise
        (folder / name).write_bytes(data)
    message = ""
    try:
        read_amc(folder / "16_11.amc", unit_to_m=0.1)
    except CaptureError as error:
        message = str(error)
    assert "\n" not in message
