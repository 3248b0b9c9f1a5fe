import lzma
import random
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility.capture import read_bvh, read_recording, text
from mesa_mobility.capture.bvh import parse_bvh
from mesa_mobility.errors import CaptureError

GOOD = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Leg
  {
    OFFSET 0 -40 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -5 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.0333333
1 2 3 4 5 6 7 8 9
1 2 3 4 5 6 7 8 9
"""

BAD = [
    ("HIERARCHY", "HIERARCHIE", "line 1: 'HIERARCHIE', expected HIERARCHY"),
    ("ROOT Hips", "JOINT Hips", "line 2: JOINT outside of a joint, expected ROOT first"),
    ("ROOT Hips", "ROOT", "line 2: ROOT without a name"),
    ("ROOT Hips\n{", "ROOT Hips\n", "line 4: OFFSET outside of a joint's braces"),
    ("ROOT Hips\n{", "ROOT Hips\n{ {", "line 3: unexpected '{'"),
    ("JOINT Leg", "JOINT Hips", "line 6: joint 'Hips' occurs twice, expected distinct names"),
    ("JOINT Leg", "ROOT Leg", "line 6: a second ROOT, expected one skeleton in the file"),
    ("  JOINT Leg\n", "  BONE Leg\n", "line 6: 'BONE Leg', expected a joint, OFFSET, CHANNELS"),
    ("    OFFSET 0 -40 0\n", "", "line 9: joint 'Leg' has no OFFSET before this line"),
    ("OFFSET 0 -40 0", "OFFSET 0 -40", "line 8, OFFSET: 2 values, expected 3"),
    ("OFFSET 0 -40 0", "OFFSET 0 -4O 0", "line 8, OFFSET: '-4O', expected a finite number"),
    ("OFFSET 0 -40 0", "OFFSET 0 nan 0", "line 8, OFFSET: 'nan', expected a finite number"),
    ("OFFSET 0 -40 0", "OFFSET 0 1e300 0", "line 8, OFFSET: '1e300', expected a finite number"),
    ("OFFSET 0 -40 0", "OFFSET 0 -40 0\nOFFSET 0 0 0", "line 9: a second OFFSET of joint 'Leg'"),
    ("    CHANNELS 3 Z", "    #CHANNELS 3 Z", "line 9: '#CHANNELS 3 Zrotation Xrotation Yrot"),
    ("3 Zrotation", "4 Zrotation", "line 9: CHANNELS 4, but 3 are named"),
    ("CHANNELS 3 Z", "CHANNELS three Z", "CHANNELS: 'three', expected a whole number"),
    ("3 Zrotation", "3 Wrotation", "line 9: channel 'Wrotation', expected Xposition"),
    ("3 Zrotation X", "3 Xrotation X", "line 9: channel Xrotation occurs twice in one joint"),
    ("      OFFSET 0 -5 0\n", "", "line 12: joint 'Leg.end' has no OFFSET before this line"),
    ("OFFSET 0 -5 0", "CHANNELS 1 Xrotation", "line 12: unexpected CHANNELS of 'Leg.end'"),
    ("OFFSET 0 -5 0", "OFFSET 0 -5 0\nJOINT Toe", "line 13: JOINT inside of an End Site"),
    ("  }\n}\nMOTION", "  }\nMOTION", "line 15: MOTION inside of joint 'Hips'"),
    ("}\nMOTION", "}\n}\nMOTION", "line 16: '}' outside of a joint's braces"),
    ("Frames: 2", "Frames: two", "line 17, Frames: 'two', expected a whole number"),
    ("Frames: 2", "Frames: 0", "line 17: 0 frames, expected at least one"),
    ("Frames: 2", "Frames: -2", "line 17: -2 frames, expected at least one"),
    ("Frames: 2\n", "", "line 17: 'Frame Time: 0.0333333', expected Frames:"),
    ("Frame Time: 0.0333333\n", "", "line 18: '1 2 3 4 5 6 7 8 9', expected Frame Time:"),
    ("Time: 0.0333333", "Time: 0", "line 18: frame time 0 s, expected 1e-05 to 0.0833333 s"),
    ("Time: 0.0333333", "Time: -0.03", "line 18: frame time -0.03 s, expected"),
    ("Time: 0.0333333", "Time: 5e-324", "line 18: frame time 4.94066e-324 s, expected"),
    ("Time: 0.0333333", "Time: inf", "line 18, Frame Time: 'inf', expected a finite number"),
    ("Time: 0.0333333", "Time:", "line 18, Frame Time: '', expected a finite number"),
    ("1 2 3 4 5 6 7 8 9\n1", "1 2 3 4 5 6 7 8\n1", "line 19: 8 values, expected 9"),
    ("8 9\n1", "8 9 10\n1", "line 19: 10 values, expected 9"),
    ("8 9\n1 2 3 4 5", "8 9\n1 2 3 4 nan", "line 20: 'nan', expected a finite number"),
    ("8 9\n1 2 3 4 5", "8 9\n1 2 3 4 -inf", "line 20: '-inf', expected a finite number"),
    ("8 9\n1 2 3 4 5", "8 9\n1 2 3 4 1.#IND", "line 20: '1.#IND', expected a finite number"),
    ("8 9\n1 2 3 4 5", "8 9\n1 2 3 4 5_5", "line 20: '5_5', expected a finite number"),
    ("Frames: 2", "Frames: 0_2", "line 17, Frames: '0_2', expected a whole number"),
    ("8 9\n1 2 3 4 5", "8 9\n1 2 3 4 5,5", "line 20: '5,5', expected a finite number"),
    ("Frames: 2", "Frames: 1", "line 20: 2 rows of motion, expected 1"),
    ("Frames: 2", "Frames: 9", "ends at line 20 after 2 rows of motion, expected 9 (truncated?)"),
]


def test_the_file_that_the_bad_ones_are_made_from_is_good(write):
    recording = read_bvh(write("good.bvh", GOOD), unit_to_m=0.01)
    assert recording.frames == 2
    assert recording.skeleton.names == ("Hips", "Leg", "Leg.end")


@pytest.mark.parametrize(("good", "bad", "message"), BAD)
def test_a_bad_file_is_named_with_the_line_and_what_was_expected(write, good, bad, message):
    assert GOOD.count(good) >= 1
    path = write("bad.bvh", GOOD.replace(good, bad, 1))
    with pytest.raises(CaptureError) as error:
        read_bvh(path, unit_to_m=0.01)
    assert str(error.value).startswith(str(path))
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_a_skeleton_without_channels_cannot_move(write):
    text = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n}\nMOTION\nFrames: 1\nFrame Time: 1\n\n"
    with pytest.raises(CaptureError, match="no joint has channels"):
        read_bvh(write("a.bvh", text), unit_to_m=1.0)


def test_motion_needs_a_skeleton(write):
    with pytest.raises(CaptureError, match="line 2: MOTION before ROOT"):
        read_bvh(write("a.bvh", "HIERARCHY\nMOTION\nFrames: 1\n"), unit_to_m=1.0)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.bvh", b"", "empty file"),
        ("a.bvh", b" \n\n", "empty file"),
        ("a.bvh", b"HIERARCHY\nROOT\0", "line 2: zero byte, expected a text file"),
        ("a.bvh", bytes(range(128, 256)), "line 1: .*expected HIERARCHY"),
        ("a.bvh.xz", b"HIERARCHY\n", "not a complete xz file"),
        ("a.bvh.xz", lzma.compress(GOOD.encode())[:-9], "not a complete xz file"),
        ("a.bvh.xz", lzma.compress(b""), "empty file"),
        ("a.fbx", GOOD.encode(), r"unknown kind of file, expected \.bvh, \.bvh\.xz, \.amc"),
    ],
)
def test_files_that_are_no_recordings_are_refused(write, name, content, message):
    path = write(name, content)
    with pytest.raises(CaptureError, match=message) as error:
        read_recording(path, unit_to_m=0.01)
    assert str(error.value).startswith(str(path))


def test_a_missing_file_and_a_folder_are_named(tmp_path):
    with pytest.raises(CaptureError, match=r"nowhere\.bvh: cannot be read \(No such file"):
        read_bvh(tmp_path / "nowhere.bvh", unit_to_m=0.01)
    with pytest.raises(CaptureError, match="cannot be read"):
        read_bvh(tmp_path, unit_to_m=0.01)


@pytest.mark.parametrize("unit", [0.0, -1.0, float("nan"), float("inf")])
def test_units_must_be_positive(write, unit):
    with pytest.raises(CaptureError, match="expected a positive length"):
        read_bvh(write("a.bvh", GOOD), unit_to_m=unit)


def test_a_small_file_that_unpacks_to_a_large_one_is_not_unpacked(write, monkeypatch):
    monkeypatch.setattr(text, "LARGEST_FILE", 100_000)
    packed = lzma.compress(b"0 " * 10_000_000, preset=0)
    path = write("a.bvh.xz", packed + bytes(4) + packed)
    unpacked: list[int] = []
    monkeypatch.setattr(text, "_unpack", lambda data, f=text._unpack: counted(f(data), unpacked))
    with pytest.raises(CaptureError, match="MB of text, expected a shorter recording"):
        read_recording(path, unit_to_m=0.01)
    assert unpacked == [100_001]


def counted(data, lengths):
    lengths.append(len(data))
    return data


def test_xz_files_may_have_several_streams_but_nothing_else(write):
    streams = [lzma.compress(part.encode()) for part in (GOOD[:100], GOOD[100:])]
    path = write("a.bvh.xz", streams[0] + bytes(8) + streams[1])
    assert read_recording(path, unit_to_m=0.01).frames == 2
    write("a.bvh.xz", streams[0] + streams[1] + b"rest")
    with pytest.raises(CaptureError, match="not a complete xz file"):
        read_recording(path, unit_to_m=0.01)


def test_files_of_absurd_size_are_refused_before_they_are_read(write, monkeypatch):
    with pytest.raises(CaptureError, match="line 17: 9999999999 frames of 3 joints, expected at "):
        parse(GOOD.replace("Frames: 2", "Frames: 9999999999"))
    deep = "JOINT {}\n{{\nOFFSET 0 0 0\nCHANNELS 0\n"
    with pytest.raises(CaptureError, match="more than 500 joints, expected a body"):
        parse("HIERARCHY\nROOT a\n" + deep[9:].format() + "".join(map(deep.format, range(600))))
    monkeypatch.setattr(text, "MOST_LINES", 15)
    with pytest.raises(CaptureError, match="more than 15 lines, expected a shorter recording"):
        parse(GOOD)


def parse(content):
    return parse_bvh(content.encode(), Path("a.bvh"), unit_to_m=0.01)


def test_a_file_cut_off_anywhere_is_refused():
    for end in range(len(GOOD.rstrip())):
        with pytest.raises(CaptureError):
            parse_bvh(GOOD[:end].encode(), Path("cut.bvh"), unit_to_m=0.01)


@settings(deadline=None, max_examples=200)
@given(st.binary(max_size=300))
def test_no_bytes_raise_anything_but_a_capture_error(data):
    with pytest.raises(CaptureError):
        parse_bvh(data, Path("noise.bvh"), unit_to_m=0.01)


@settings(deadline=None, max_examples=200)
@given(st.integers(0, 2**32 - 1))
def test_damaged_files_are_read_or_refused_in_one_line(seed):
    rng = random.Random(seed)
    text = list(GOOD)
    for _ in range(rng.randint(1, 6)):
        text[rng.randrange(len(text))] = rng.choice("\0\n{} 0-e.xJOINT\xe9\u2028")
    message = ""
    try:
        parse_bvh("".join(text).encode(), Path("damaged.bvh"), unit_to_m=0.01)
    except CaptureError as error:
        message = str(error)
    assert "\n" not in message
