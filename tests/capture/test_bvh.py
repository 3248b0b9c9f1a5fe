import lzma

import numpy as np
import pytest

from mesa_mobility.capture import read_bvh, read_recording
from mesa_mobility.errors import CaptureError

ALL_SIX = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"


def one_bone(row, *, root_channels=ALL_SIX, root_offset="500 600 700", offset="0 10 0"):
    return (
        f"HIERARCHY\nROOT Hips\n{{\n  OFFSET {root_offset}\n  {root_channels}\n"
        f"  End Site\n  {{\n    OFFSET {offset}\n  }}\n}}\n"
        f"MOTION\nFrames: 1\nFrame Time: 0.01\n{row}\n"
    )


def test_the_file_s_y_is_up_and_its_z_is_forwards(write):
    recording = read_bvh(write("a.bvh", one_bone("1 2 3 0 0 0")), unit_to_m=0.01)
    # (X, Y, Z) = (1, 2, 3) cm is (x, y, z) = (3, 1, 2) cm; the bone points up by 10 cm.
    np.testing.assert_allclose(
        recording.positions()[0], [[0.03, 0.01, 0.02], [0.03, 0.01, 0.12]], atol=1e-15
    )
    assert recording.skeleton.names == ("Hips", "Hips.end")
    assert recording.name == "a"
    assert recording.frame_rate == 100.0


@pytest.mark.parametrize(
    ("channels", "row", "end"),
    [
        # Rz(90) Rx(90) takes Y to Z, which is the world's x.
        ("CHANNELS 2 Zrotation Xrotation", "90 90", [1, 0, 0]),
        # Rx(90) Rz(90) takes Y to -X, which is the world's -y.
        ("CHANNELS 2 Xrotation Zrotation", "90 90", [0, -1, 0]),
        ("CHANNELS 1 Xrotation", "90", [1, 0, 0]),
        ("CHANNELS 1 Zrotation", "90", [0, -1, 0]),
        ("CHANNELS 1 Yrotation", "90", [0, 0, 1]),
        # Ry(90) Rx(90) Rz(180) takes Y to -Y, -Z and -X.
        ("CHANNELS 3 Yrotation Xrotation Zrotation", "90 90 180", [0, -1, 0]),
        # Positions between rotations; the order of the rotations among themselves counts.
        (
            "CHANNELS 5 Zrotation Zposition Xrotation Yposition Xposition",
            "90 3 90 2 1",
            [4, 1, 2],
        ),
    ],
)
def test_channels_apply_in_the_order_in_which_they_are_listed(write, channels, row, end):
    text = one_bone(row, root_channels=channels, root_offset="0 0 0", offset="0 1 0")
    positions = read_bvh(write("a.bvh", text), unit_to_m=1.0).positions()
    np.testing.assert_allclose(positions[0, 1], end, atol=1e-15)


def test_an_axis_without_a_position_channel_keeps_the_offset(write):
    text = one_bone("5", root_channels="CHANNELS 1 Yposition", root_offset="1 2 3")
    positions = read_bvh(write("a.bvh", text), unit_to_m=1.0).positions()
    np.testing.assert_allclose(positions[0, 0], [3, 1, 5], atol=1e-15)


def nested(rows, *, world="0 0 0", child_offset="0 90 0", leg_channels=""):
    """A fixed world joint above hips that move, as in the files of Bandai-Namco."""
    return (
        f"HIERARCHY\nROOT World\n{{\nOFFSET {world}\n{ALL_SIX}\n"
        f"JOINT Hips\n{{\nOFFSET {child_offset}\n{ALL_SIX}\n"
        f"JOINT Left\n{{\nOFFSET 0 -40 0\nCHANNELS {leg_channels or '0'}\n}}\n"
        "JOINT Right\n{\nOFFSET 0 -40 0\nCHANNELS 0\n}\n}\n}\n"
        f"MOTION\nFrames: {len(rows)}\nFrame Time: 0.0333333\n" + "\n".join(rows) + "\n"
    )


def test_hips_that_move_below_a_fixed_joint_are_the_root(write):
    # The world joint turns by 90 degrees about Y, which takes the hips' Z to X.
    rows = ["1 0 0  0 0 90   0 95 10  0 0 0", "1 0 0  0 0 90   0 95 20  0 0 0"]
    recording = read_bvh(write("a.bvh", nested(rows)), unit_to_m=0.01)
    assert recording.skeleton.names == ("Hips", "Left", "Right")
    assert recording.skeleton.parents.tolist() == [-1, 0, 0]
    np.testing.assert_allclose(
        recording.root_position, [[0, 0.11, 0.95], [0, 0.21, 0.95]], atol=1e-15
    )
    np.testing.assert_allclose(recording.positions()[1, 1], [0, 0.21, 0.55], atol=1e-15)


def test_constant_position_channels_take_the_place_of_the_offset(write):
    rows = [f"0 0 {k} 0 0 0   0 0 0 0 0 0   0 -30 0" for k in range(3)]
    text = nested(rows, child_offset="0 90 0", leg_channels="3 Xposition Yposition Zposition")
    positions = read_bvh(write("a.bvh", text), unit_to_m=0.01).positions()
    # World, hips (at the channels' 0, not the offset's 90), a leg of 30 and one of 40 cm.
    np.testing.assert_allclose(positions[2, :, 2], [0, 0, -0.3, -0.4], atol=1e-15)


def test_bones_that_stretch_are_refused(write):
    rows = [f"0 0 0 0 0 0   0 90 0 0 0 0   0 {-40 - k} 0" for k in range(3)]
    text = nested(rows, leg_channels="3 Xposition Yposition Zposition")
    with pytest.raises(CaptureError, match=r"line 10: joint 'Left' moves 0\.010 m against its"):
        read_bvh(write("a.bvh", text), unit_to_m=0.01)


@pytest.mark.parametrize(
    ("frame_time", "rate"),
    [("0.0083333", 120), (".00833", 120), ("0.033333", 30), ("0.0166667", 60), ("0.04", 25)],
)
def test_frame_times_of_few_digits_give_whole_rates(write, walker_bvh, frame_time, rate):
    path = write("a.bvh", walker_bvh(2, frame_time))
    assert read_bvh(path, unit_to_m=0.01).frame_rate == rate


@pytest.mark.parametrize(("frame_time", "rate"), [("0.0417083", 23.97604), ("0.0333", 30.03003)])
def test_a_rate_that_is_not_whole_stays(write, walker_bvh, frame_time, rate):
    path = write("a.bvh", walker_bvh(2, frame_time))
    assert read_bvh(path, unit_to_m=0.01).frame_rate == pytest.approx(rate, abs=1e-5)


def rewritten(text):
    """The same file in other hands' layout."""
    return {
        "windows": text.replace("\n", "\r\n"),
        "old mac": text.replace("\n", "\r"),
        "tabs": text.replace("Frames: ", "Frames:\t").replace("OFFSET ", "OFFSET\t"),
        "braces": text.replace("\n{\nOFFSET", " {\nOFFSET").replace("}\n}\n", "} }\n"),
        "byte order mark": "\ufeff" + text,
        "blank lines": text.replace("\n", "\n\n"),
        "lower case": text.replace("rotation", "ROTATION").replace("JOINT", "joint"),
        "no last line end": text.rstrip("\n"),
    }


@pytest.mark.parametrize("layout", list(rewritten("")))
def test_layouts_in_use_read_alike(write, walker_bvh, layout):
    plain = read_bvh(write("a.bvh", walker_bvh(3)), unit_to_m=0.01)
    text = rewritten(walker_bvh(3))[layout]
    assert text != walker_bvh(3)
    other = read_bvh(write("b.bvh", text), unit_to_m=0.01)
    assert other.skeleton.names == plain.skeleton.names
    np.testing.assert_array_equal(other.positions(), plain.positions())


def test_names_that_are_not_ascii_or_have_spaces_are_kept(write, walker_bvh):
    text = walker_bvh(2).replace("ROOT Hips", "ROOT Bip01 H\xfcfte")
    for encoding in ("utf-8", "latin-1"):
        path = write("a.bvh", text.encode(encoding))
        assert read_bvh(path, unit_to_m=0.01).skeleton.names[0] == "Bip01 H\xfcfte"


def test_xz_files_read_like_plain_ones(write, walker_bvh):
    text = walker_bvh(3)
    plain = read_bvh(write("walk.bvh", text), unit_to_m=0.01)
    packed = read_recording(write("walk.bvh.xz", lzma.compress(text.encode())), unit_to_m=0.01)
    assert packed.name == plain.name == "walk"
    np.testing.assert_array_equal(packed.positions(), plain.positions())


def test_two_ends_of_one_joint_get_two_names(write):
    end = "End Site\n{\nOFFSET 0 1 0\n}\n"
    text = one_bone("0 0 0 0 0 0").replace("  End Site", f"{end}  End Site")
    names = read_bvh(write("a.bvh", text), unit_to_m=1.0).skeleton.names
    assert names == ("Hips", "Hips.end", "Hips.end2")
