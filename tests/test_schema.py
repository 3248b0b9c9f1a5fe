"""The checker of what files hold: what fits passes, all else is one line with its place."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.errors import ContentError, MapError
from mesa_mobility.schema import (
    Anything,
    Array,
    Each,
    Either,
    Flag,
    Maybe,
    Members,
    Object,
    Real,
    Records,
    Several,
    Text,
    Whole,
    check,
)

PAIR = np.dtype([("at", "i4"), ("share", "f8")])
PAIRS = Records(
    PAIR, {"at": Array("i4", low=-1, below="people"), "share": Array("f8", low=0.0)}, ("people",)
)
SIZES = {"people": 3, "names": ["east", "west"]}


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (True, Flag()),
        ("east", Text("names")),
        (2, Whole(below="people")),
        (np.int32(7), Whole(0, 7)),
        (0.5, Real(0.0, 1.0)),
        (math.inf, Real(0.0, infinite=True)),
        (math.nan, Real(missing=True)),
        (np.arange(3), Array("i8", ("people",), 0, below="people", rising=True)),
        (np.empty((0, 2)), Array("f8", (None, 2))),
        (np.zeros((1, 2)), Array("f8", (None, 2), filled=True)),
        (np.zeros(3, PAIR), PAIRS),
        (None, Maybe(Whole())),
        ([1, 2], Several(Whole())),
        ({1: "east"}, Several(Whole(), dict, values=Text("names"))),
        ({3}, Several(Whole(), set, length=1)),
        ((1, "x"), Each(Whole(), Text())),
        ("x", Either(Whole(), Text())),
        (
            {"a": np.zeros(4), "b": np.zeros((4, 2))},
            Members({"a": Array("f8", ("n",)), "b": Array("f8", ("n", 2))}),
        ),
        (PAIR, Object(np.dtype)),
        (object(), Anything()),
    ],
)
def test_what_fits(value, kind):
    check(value, kind, "file", SIZES)


@pytest.mark.parametrize(
    ("value", "kind", "text"),
    [
        (1, Flag(), "file: got 1, expected true or false"),
        ("north", Text("names"), "file: got 'north', expected one of east, west"),
        (3, Whole(below="people"), "file: got 3, expected a whole number, 0 to 2"),
        (True, Whole(), r"file: got True, expected a whole number"),
        (1.0, Whole(), r"file: got 1\.0, expected a whole number"),
        (10**400, Real(), "file: got 10+.*, expected a number"),
        (math.nan, Real(), "file: got nan, expected a number, finite"),
        ("1", Real(), "file: got '1', expected a number"),
        (
            np.array([0, 64]),
            Array("i8", below="people", low=0),
            r"file\[1\]: got 64, expected a number, finite, 0 to 2",
        ),
        (np.array([[0.0, math.inf]]), Array("f8", (1, 2)), r"file\[0, 1\]: got inf, expected"),
        (
            np.empty((0, 2)),
            Array("f8", (None, 2), filled=True),
            "file: has no numbers, expected some",
        ),
        (np.array([1, 1]), Array("i8", rising=True), "file: goes back, expected rising numbers"),
        (np.zeros(2), Array("f8", ("people",)), r"file: shape \(2,\), expected \(3\)"),
        (
            np.zeros(3, "f4"),
            Array("f8"),
            "file: got dtype..float32.., expected an array of float64",
        ),
        (np.array([(3, 0.5)] * 3, PAIR), PAIRS, r"file, at\[0\]: got 3, expected a number"),
        (np.zeros(2, PAIR), PAIRS, r"file: shape \(2,\)"),
        ([1, -1], Several(Whole()), r"file\[1\]: got -1, expected a whole number"),
        ((1,), Several(Whole()), "expected a list"),
        ({1: 2}, Several(Whole(), dict, values=Text()), r"file\[1\]: got 2, expected a text"),
        ((1, 2, 3), Each(Whole(), Whole()), "expected a tuple of 2"),
        ({}, Members({"a": Flag()}), "file: missing 'a', expected the members a"),
        (
            {"a": True, "b\n": 1},
            Members({"a": Flag()}),
            "file: unknown 'b.*n', expected the members a",
        ),
        (
            {"a": np.zeros(4), "b": np.zeros((3, 2))},
            Members({"a": Array("f8", ("n",)), "b": Array("f8", ("n", 2))}),
            r"file, b: shape \(3, 2\), expected \(4, 2\)",
        ),
        (None, Object(np.dtype), "expected a dtype"),
    ],
)
def test_what_does_not_fit(value, kind, text):
    with pytest.raises(ContentError, match=text) as caught:
        check(value, kind, "file", SIZES)
    assert "\n" not in str(caught.value)


def test_the_reader_s_own_error():
    with pytest.raises(MapError, match=r"^file: got 1, expected true or false$"):
        check(1, Flag(), "file", error=MapError)


@given(st.lists(st.floats(width=32), min_size=1), st.floats(-10, 10), st.booleans(), st.booleans())
def test_ranges_are_those_of_each_number(numbers, low, infinite, missing):
    fits = all(
        missing if math.isnan(n) else infinite if math.isinf(n) else low <= n <= 20.0
        for n in numbers
    )
    kind = Array("f8", (None,), low, 20.0, infinite=infinite, missing=missing)
    try:
        check(np.array(numbers), kind, "numbers")
    except ContentError:
        assert not fits
    else:
        assert fits
