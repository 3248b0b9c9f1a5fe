from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, Optional

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility import Files, Range
from mesa_mobility.distributions import Distribution, LogNormal
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.parameters import chosen, descriptions, parameters

if TYPE_CHECKING:
    from somewhere import FloorPlan


class Model:
    def __init__(
        self,
        people: int = 60,
        width: float = 1.0,
        quiet: bool = False,
        name: str = "hall",
        door: Literal["left", "right", 3] = "left",
        limit: float | None = None,
        shape: Optional[int] = None,  # noqa: UP045
        either: str | int = "x",
        plan: FloorPlan | str | None = None,
        only_python: FloorPlan | None = None,
        delay: Distribution | float = 0.0,
        free=2,
        *,
        preset: str = "default",
        mobility_map: str | None = None,
        record: bool = False,
        rng: int | None = None,
    ) -> None:
        pass


def value(setting):
    (found,) = chosen(Model, "hall", [setting]).values()
    return found


@pytest.mark.parametrize(
    ("setting", "expected"),
    [
        ("people=750", 750),
        ("people=-3", -3),
        ("width=1", 1.0),
        ("width=1e-1", 0.1),
        ("quiet=yes", True),
        ("quiet=False", False),
        ("name=a=b", "a=b"),
        ("name=", ""),
        ("name=none", "none"),
        ("door=right", "right"),
        ("door=3", 3),
        ("limit=none", None),
        ("delay=2.5", 2.5),
        ("delay=lognormal(3.44, 0.94)", LogNormal(3.44, 0.94)),
        ("limit=2.5", 2.5),
        ("shape=None", None),
        ("shape=4", 4),
        ("either=7", 7),
        ("either=seven", "seven"),
        ("plan=hall.geojson", "hall.geojson"),
        ("free=7", 7),
        (" people =5", 5),
        ("name= a ", " a "),
    ],
)
def test_texts_become_what_the_parameter_takes(setting, expected):
    found = value(setting)
    assert found == expected
    assert type(found) is type(expected)


@given(st.integers())
def test_every_whole_number_arrives(number):
    assert value(f"people={number}") == number


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_number_arrives(number):
    assert value(f"width={number!r}") == number


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("people=many", "model hall: people: got 'many', expected a whole number$"),
        ("people=1.5", "people: got '1.5', expected a whole number$"),
        ("people=", "people: got nothing, expected a whole number$"),
        ("people=none", "got 'none', expected a whole number$"),
        ("width=nan", "expected a number$"),
        ("width=inf", "expected a number$"),
        ("quiet=perhaps", "expected yes or no$"),
        ("door=middle", "expected left or right or 3$"),
        ("limit=soon", "limit: got 'soon', expected a number or none$"),
        ("only_python=x", "expected none$"),
        ("people", "--set people: expected NAME=VALUE"),
        ("rng=1", "--set rng=1: use --seed"),
        ("preset=paper", "--set preset=paper: use --preset"),
        ("mobility_map=a.npz", "use --map"),
        ("record=true", "unknown parameter 'record'"),
        ("peeple=3", "unknown parameter 'peeple', did you mean 'people'"),
        ("=3", "unknown parameter ''"),
    ],
)
def test_what_does_not_fit_is_refused(setting, message):
    with pytest.raises(ModelError, match=message) as caught:
        chosen(Model, "hall", [setting])
    assert "\n" not in str(caught.value)


def test_an_unknown_name_lists_types_and_defaults():
    with pytest.raises(ModelError) as caught:
        chosen(Model, "hall", ["nothing=1"])
    assert "people: int = 60; width: float = 1.0; quiet: bool = False" in str(caught.value)
    assert "rng" not in str(caught.value)


def test_a_name_can_be_set_once():
    with pytest.raises(ModelError, match="people is set twice"):
        chosen(Model, "hall", ["people=1", "width=2", "people=3"])


def test_keywords_that_take_anything_are_no_parameters():
    class Open:
        def __init__(self, people: int = 1, **others: int) -> None:
            pass

    assert list(parameters(Open)) == ["people"]


class Documented:
    """A model.

    Args:
        people: how many; more than that
            do not fit.
        width: of the door, metres: 0.6 or more.

    Raises:
        ModelError: never.
    """


def test_descriptions_come_from_the_docstring():
    assert descriptions(Documented) == {
        "people": "how many; more than that do not fit.",
        "width": "of the door, metres: 0.6 or more.",
    }
    assert descriptions(Model) == {}


class Plain:
    """Nothing is annotated: defaults tell the types."""

    def __init__(
        self,
        people=40,
        width=1.5,
        quiet=False,
        name="hall",
        limit=None,
        delay=LogNormal(3.44, 0.94),  # noqa: B008
        file=Path("hall.geojson"),
        places=((1.0, 2.0),),
    ):
        pass


@pytest.mark.parametrize(
    ("setting", "expected"),
    [
        ("people=12", 12),
        ("width=2", 2.0),
        ("quiet=yes", True),
        ("name=12", "12"),
        ("limit=none", None),
        ("limit=3", 3),
        ("limit=2.5", 2.5),
        ("limit=near", "near"),
        ("delay=2", 2.0),
        ("delay=lognormal(3.44, 0.94)", LogNormal(3.44, 0.94)),
        ("file=a.geojson", Path("a.geojson")),
    ],
)
def test_a_default_tells_the_type_where_nothing_is_annotated(setting, expected):
    (found,) = chosen(Plain, "plain", [setting]).values()
    assert found == expected
    assert type(found) is type(expected)


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("people=many", "people: got 'many', expected a whole number$"),
        ("people=" + "9" * 5000, f"people: got '{'9' * 40}...', expected a whole number$"),
        ("people=1\n2", r"people: got '1\\n2', expected a whole number$"),
        ("file=", "file: got nothing, expected a file$"),
        ("places=1", "places: got '1', expected a value that only Python can give$"),
    ],
)
def test_what_does_not_fit_a_default_is_refused(setting, message):
    with pytest.raises(ModelError, match=message):
        chosen(Plain, "plain", [setting])


def test_ranges_and_files_stand_beside_the_type():
    class Hall:
        def __init__(
            self,
            people: Annotated[int, Range(1, 500)] = 60,
            width: Annotated[float, Range(0.5, 2)] | None = None,
            plan: Annotated[Path | None, Files("*.geojson")] = None,
            free: int = 1,
        ):
            pass

    found = parameters(Hall)
    assert found["people"].range == Range(1, 500)
    assert found["width"].range == Range(0.5, 2)
    assert found["width"].kinds == (float, type(None))
    assert found["plan"].files == Files("*.geojson")
    assert found["free"].range is None
    assert found["free"].files is None


@pytest.mark.parametrize("ends", [(1, 1), (2, 1), (0, math.inf), (math.nan, 1)])
def test_a_range_has_two_ends(ends):
    with pytest.raises(ModelError, match=r"Range: got .*, expected a low and a high end"):
        Range(*ends)


@pytest.mark.parametrize(
    ("ends", "inside", "outside", "text"),
    [
        (Range(0, 2, "m"), [0, 1.5, 2], [-0.1, 2.1, math.inf, math.nan], "0 to 2 m"),
        (Range(0, unit="s", above=True), [1e-9, 1e300], [0, -1, math.inf], "more than 0 s"),
        (Range(0.5), [0.5, 9], [0.4, math.nan], "0.5 or more"),
        (Range(0, 1, below=True), [0, 0.9], [1, -1], "0 or more and less than 1"),
        (Range(0, 1, "s", above=True), [0.1, 1], [0, 2], "more than 0 and at most 1 s"),
        (Range(1, endless=True), [1, math.inf], [0, -math.inf, math.nan], "1 or more, or inf"),
    ],
)
def test_what_is_in_a_range(ends, inside, outside, text):
    assert str(ends) == text
    assert all(value in ends for value in inside)
    assert not any(value in ends for value in outside)
