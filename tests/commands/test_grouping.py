"""Options of commands in groups."""

from dataclasses import dataclass
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from mesa_mobility.commands.grouping import grouped


@dataclass(frozen=True)
class Crowd:
    people: Annotated[int, typer.Option("--count", min=1)] = 3
    names: Annotated[list[str] | None, typer.Option("--name")] = None


@dataclass(frozen=True)
class LargeCrowd(Crowd):
    people: Annotated[int, typer.Option("--count", min=100)] = 500


@dataclass(frozen=True)
class Place:
    width: Annotated[float, typer.Option()]


def run(command, *arguments):
    app = typer.Typer()
    app.command()(command)
    return CliRunner().invoke(app, arguments)


@grouped
def walk(where: str, crowd: Crowd, place: Place, *, fast: bool = False) -> None:
    """Walk."""
    print(where, crowd, place, fast)


def test_fields_of_groups_are_options_and_the_command_gets_the_groups():
    result = run(walk, "hall", "--width", "2.5", "--count", "7", "--name", "a", "--name", "b")
    assert result.exit_code == 0
    assert result.output == f"hall {Crowd(7, ['a', 'b'])} {Place(2.5)} False\n"


def test_what_is_not_given_is_the_default_of_the_field():
    result = run(walk, "hall", "--width", "1", "--fast")
    assert result.output == f"hall {Crowd(3, None)} {Place(1.0)} True\n"


@pytest.mark.parametrize(
    "arguments", [["hall"], ["--width", "1"], ["hall", "--width", "1", "--count", "0"]]
)
def test_a_field_without_a_default_is_required_and_bounds_hold(arguments):
    assert run(walk, *arguments).exit_code == 2


def test_a_group_may_change_an_option_of_another():
    @grouped
    def march(crowd: LargeCrowd) -> None:
        print(crowd)

    assert run(march).output == f"{LargeCrowd(500)}\n"
    assert run(march, "--count", "99").exit_code == 2
