"""Commands to a running model, as JSON texts."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import LiveError, MobilityError
from mesa_mobility.live.fields import Fields, shown, text_of
from mesa_mobility.live.levels import in_plane, in_true_places
from mesa_mobility.live.run import Command, Run

Reader: TypeAlias = Callable[[Fields, Hashable], Command]
"""Takes the fields of a client's command, and gives the function that executes it."""


def read_command(text: str, client: Hashable = None) -> tuple[Any, Command]:
    """Read a command from a JSON text.

    Args:
        text: a JSON object.
        client: the client that gives the command.

    Returns:
        The command's ``id``, None if it has none, and a function that executes it.

    Raises:
        Refused: the text is not a valid command.
    """
    number = None
    try:
        fields = Fields(text)
        given = fields.take("id", None)
        if not (given is None or (isinstance(given, int | str) and len(shown(given)) <= 60)):
            raise LiveError("id: expected a short text or a whole number")
        number = given
        name = fields.text("do")
        if name not in _COMMANDS:
            raise LiveError(f"do: got {shown(name)}, expected one of {', '.join(_COMMANDS)}")
        command = _COMMANDS[name](fields, client)
        fields.none_left()
    except LiveError as error:
        raise Refused(str(error), number) from None
    return number, command


class Refused(LiveError):
    """A command that cannot be executed.

    Attributes:
        id: the command's, or None.
    """

    def __init__(self, message: str, number: Any = None) -> None:
        super().__init__(message)
        self.id = number


def _walk(fields: Fields, client: Hashable) -> Command:
    people, place = fields.people(), fields.pair("to")
    level, stay = fields.level(), fields.number("stay", None)

    def command(run: Run) -> dict[str, Any]:
        [[x, y]] = in_plane(run.model, "to", [place], level).tolist()
        run.orders.walk(_inside(run, people), (x, y), stay)
        return {}

    return command


def _steer(fields: Fields, client: Hashable) -> Command:
    people, velocity = fields.people(), fields.pair("velocity")

    def command(run: Run) -> dict[str, Any]:
        run.orders.steer(_inside(run, people), velocity)
        run.hold(client, people)
        return {}

    return command


def _release(fields: Fields, client: Hashable) -> Command:
    people = fields.people()

    def command(run: Run) -> dict[str, Any]:
        run.orders.release(_inside(run, people))
        return {}

    return command


def _leave(fields: Fields, client: Hashable) -> Command:
    people, exits = fields.people(), _exits(fields)

    def command(run: Run) -> dict[str, Any]:
        rows = _inside(run, people)
        for row in rows.tolist():
            run.model.population.send(row, exits, (), run.model.frame)
        run.orders.release(rows)
        return {}

    return command


def _wait(fields: Fields, client: Hashable) -> Command:
    people, seconds = fields.people(), fields.number("seconds")

    def command(run: Run) -> dict[str, Any]:
        model = run.model
        for row in _inside(run, people).tolist():
            model.waits.tell(row, seconds, None, model.frame, model.crowd)
        return {}

    return command


def _changing(*, opens: bool) -> Reader:
    """Reads a command that opens or closes a gate or exit, or stairs or a lift."""

    def read(fields: Fields, client: Hashable) -> Command:
        name = fields.text("opening")

        def command(run: Run) -> dict[str, Any]:
            building, plan = run.model.building, run.model.floor_plan
            if building is not None:
                (building.open if opens else building.close)(name)
            else:
                (plan.open_gate if opens else plan.close_gate)(name)
            return {}

        return command

    return read


def _add(fields: Fields, client: Hashable) -> Command:
    positions, exits = fields.pairs("positions"), _exits(fields)
    speed, kind = fields.number("speed", None), fields.text("type", None)
    heading, level = fields.number("heading", None), fields.level()

    def command(run: Run) -> dict[str, Any]:
        types = [each.name for each in run.model.pedestrian_types]
        if kind is not None and kind not in types:
            raise LiveError(f"type: got {shown(kind)}, expected one of {', '.join(types)}")
        points = in_plane(run.model, "positions", positions, level)
        try:
            people = run.model.add_pedestrians(
                points,
                headings=None if heading is None else [heading] * len(positions),
                preferred_speeds=None if speed is None else [speed] * len(positions),
                exits=exits,
                type_index=None if kind is None else types.index(kind),
            )
        except MobilityError as error:
            raise LiveError(in_true_places(str(error), points, positions)) from error
        return {"people": [person.row for person in people]}

    return command


def _playing(playing: bool) -> Reader:
    """Reads a command that lets time go by, or not."""

    def command(run: Run) -> dict[str, Any]:
        run.set_playing(playing)
        return {}

    return lambda fields, client: command


_COMMANDS: dict[str, Reader] = {
    "walk": _walk,
    "steer": _steer,
    "release": _release,
    "leave": _leave,
    "wait": _wait,
    "open": _changing(opens=True),
    "close": _changing(opens=False),
    "add": _add,
    "pause": _playing(False),
    "resume": _playing(True),
}


def _exits(fields: Fields) -> list[str] | None:
    """Names of exits; None, or no field, stands for all."""
    if fields.peek("exits") is None:
        fields.take("exits", None)
        return None
    return fields.each("exits", text_of)


def _inside(run: Run, people: list[int]) -> NDArray[np.int64]:
    """(n,) rows of people who are all inside; nobody gets an order if one of them is not.

    Raises:
        LiveError: somebody who has left, or has never been there.
    """
    for row in people:
        if not (row < run.model.population.count and run.model.crowd.active[row]):
            raise LiveError(f"person {row}: expected somebody inside")
    return np.array(people, dtype=np.int64)
