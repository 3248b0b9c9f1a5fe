"""Frames as messages: what is written is read back, to the last bit."""

import json
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from mesa_mobility.errors import LiveError
from mesa_mobility.live.frames import COLUMNS, Frame, read_frame

FINITE = st.floats(allow_nan=False, allow_infinity=False)
AS_JSON = {
    "type": "frame",
    "number": 1,
    "frame": 2,
    "sent": 3.0,
    "paused": False,
    "person": [7],
    "x": [0.1],
    "y": [0.2],
    "heading": [0.3],
    "vx": [0.4],
    "vy": [0.5],
}


@st.composite
def frames(draw):
    n = draw(st.integers(0, 20))
    columns = [draw(arrays.arrays(np.float64, n, elements=FINITE)) for _ in COLUMNS]
    z = draw(st.none() | arrays.arrays(np.float64, n, elements=FINITE))
    level = None if z is None else draw(arrays.arrays(np.int16, n))
    person = draw(arrays.arrays(np.int32, n, elements=st.integers(0, 2**31 - 1)))
    return Frame(
        draw(st.integers(0, 2**64 - 1)),
        draw(st.integers(0, 2**31 - 1)),
        draw(FINITE),
        draw(st.booleans()),
        person,
        *columns,
        z,
        level,
    )


@given(frames(), st.booleans())
def test_either_form_is_read_back_to_the_last_bit(frame, binary):
    again = read_frame(frame.to_bytes() if binary else frame.to_json())
    for name in ("number", "frame", "paused"):
        assert getattr(again, name) == getattr(frame, name)
    assert struct.pack("<d", again.sent) == struct.pack("<d", frame.sent)
    np.testing.assert_array_equal(again.person, frame.person)
    for name in COLUMNS:
        assert getattr(again, name).tobytes() == getattr(frame, name).tobytes()
    assert (again.z is None) == (again.level is None) == (frame.z is None)
    if frame.z is not None:
        assert again.z.tobytes() == frame.z.tobytes()
        assert again.level.tolist() == frame.level.tolist()


def test_the_binary_form_is_the_documented_one():
    frame = Frame(
        5,
        90,
        1.5,
        True,
        np.array([3, 8], dtype=np.int32),
        np.array([0.5, 1.0]),
        np.array([2.0, 3.0]),
        np.array([0.25, -1.0]),
        np.array([1.25, 0.0]),
        np.array([0.0, -1.0]),
    )
    expected = b"MMLF" + bytes.fromhex(
        "0100"
        "0100"
        "5a000000"
        "02000000"
        "0500000000000000"
        "000000000000f83f"
        "000000000000e03f"
        "000000000000f03f"
        "0000000000000040"
        "0000000000000840"
        "000000000000d03f"
        "000000000000f0bf"
        "000000000000f43f"
        "0000000000000000"
        "0000000000000000"
        "000000000000f0bf"
        "03000000"
        "08000000"
    )
    assert frame.to_bytes() == expected
    assert len(expected) == 32 + 44 * 2


def test_in_a_building_height_and_level_follow_the_rest():
    one = [np.array([value]) for value in (0.1, 0.2, 0.3, 0.4, 0.5)]
    person, z, level = np.array([7], dtype=np.int32), np.array([1.5]), np.array([-2], np.int16)
    plain = Frame(1, 2, 3.0, False, person, *one)
    frame = Frame(1, 2, 3.0, False, person, *one, z, level)
    expected, before = frame.to_bytes(), plain.to_bytes()
    # Bit 1 of the flags, then all as on a floor plan, then 1.5 and -2.
    assert expected[:6] + expected[8:-10] == before[:6] + before[8:]
    assert expected[6:8] == b"\2\0"
    assert expected[-10:] == bytes.fromhex("000000000000f83ffeff")
    assert json.loads(frame.to_json()) == AS_JSON | {"z": [1.5], "level": [-2]}


def test_the_json_form_has_a_list_for_each_column():
    one = [np.array([value]) for value in (0.1, 0.2, 0.3, 0.4, 0.5)]
    frame = Frame(1, 2, 3.0, False, np.array([7], dtype=np.int32), *one)
    assert json.loads(frame.to_json()) == AS_JSON


@given(st.binary(max_size=200) | st.text(max_size=200))
def test_whatever_else_comes_is_refused_on_one_line(message):
    with pytest.raises(LiveError) as refused:
        read_frame(message)
    assert len(str(refused.value).splitlines()) == 1


@given(frames(), st.data())
def test_a_frame_that_is_cut_or_longer_is_refused(frame, data):
    message = frame.to_bytes()
    length = data.draw(st.integers(0, len(message) - 1))
    for wrong in (message[:length], message + b"\0"):
        with pytest.raises(LiveError, match="expected"):
            read_frame(wrong)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"type": "scene"}, "a message of type 'scene'"),
        ({"x": [1.0, 2.0]}, "unequal length"),
        ({"person": [2**40]}, "not readable"),
        ({"vy": None}, "unequal length"),
        ({"y": ["north"]}, "not readable"),
        ({"z": [1.0]}, "not readable: KeyError 'level'"),
        ({"z": [1.0], "level": []}, "unequal length"),
        ({"z": [1.0], "level": [2**15]}, "not readable"),
    ],
)
def test_a_json_frame_with_other_values_is_refused(changes, message):
    with pytest.raises(LiveError, match=message):
        read_frame(json.dumps(AS_JSON | changes))
