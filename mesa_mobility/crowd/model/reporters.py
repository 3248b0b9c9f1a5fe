"""What a model's ``DataCollector`` collects after each step, and more of it at any time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.errors import ModelError

Reporter = Callable[..., Any] | str
"""A function of a model or an agent, or the name of an attribute."""


def add_reporter(model: CrowdModel, name: str, reporter: Reporter) -> None:
    """Collect a value of the model after each step from now on.

    Earlier rows have None. A reporter of this name is replaced, and its values stay: after
    ``load``, which knows the values but no functions, the same call goes on with them.

    Args:
        name: of the column.
        reporter: function of the model, or the name of one of its attributes.

    Raises:
        ModelError: the reporter is neither.
    """
    _check(name, reporter)
    collector = model.datacollector
    rows = max(map(len, collector.model_vars.values()), default=0)
    values = collector.model_vars.setdefault(name, [None] * rows)
    values += [None] * (rows - len(values))
    # As a function of its own: Mesa calls objects and methods without the model.
    collector.model_reporters[name] = (
        reporter if isinstance(reporter, str) else lambda model: reporter(model)
    )


def add_agent_reporter(model: CrowdModel, name: str, reporter: Reporter) -> None:
    """Collect a value of each agent after each step from now on.

    Earlier rows have None. People are agents, and so are those of other classes.

    Args:
        name: of the column.
        reporter: function of the agent, or the name of an attribute; None where it has none.

    Raises:
        ModelError: the reporter is neither, or there is one of this name.
    """
    _check(name, reporter)
    collector = model.datacollector
    if name in collector.agent_reporters:
        raise ModelError(f"agent reporter {name!r}: there is one, expected another name")
    collector.agent_reporters[name] = (
        reporter if callable(reporter) else lambda agent: getattr(agent, reporter, None)
    )
    # Rows are tuples with a value for each reporter behind the time and the agent's number.
    for rows in collector._agent_records.values():
        rows[:] = [row + (None,) * (len(collector.agent_reporters) + 2 - len(row)) for row in rows]


def _check(name: str, reporter: Reporter) -> None:
    if not (isinstance(reporter, str) or callable(reporter)):
        raise ModelError(
            f"reporter {name!r}: got {reporter!r:.80}, expected a function or an attribute's name"
        )
