from __future__ import annotations

from typing import TYPE_CHECKING, Literal, Optional

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.commands.parameters import chosen, descriptions, parameters
from mesa_mobility.distributions import Distribution, LogNormal
from mesa_mobility.errors import ModelError

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
        ("free=text", "text"),
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
        ("people=many", r"people=many is not int \(parameter people: int = 60\)"),
        ("people=1.5", "is not int"),
        ("people=", "is not int"),
        ("people=none", "is not int"),
        ("width=nan", "is not float"),
        ("width=inf", "is not float"),
        ("quiet=perhaps", "is not bool"),
        ("door=middle", "is not left or right or 3"),
        ("limit=soon", "is not float or none"),
        ("only_python=x", "is not none"),
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
