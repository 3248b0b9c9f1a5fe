"""The agents of a model in a checkpoint."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mesa_mobility.crowd.checkpoint.checking import check_alike
from mesa_mobility.crowd.checkpoint.plain import Packer, Unpacker
from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.crowd.people.pedestrian import last_number
from mesa_mobility.errors import ModelError

_FRAMEWORK = {"model", "unique_id", "row", "pos", "space", "_mesa_index"}
"""What every agent has."""


def pack_people(model: CrowdModel, packer: Packer) -> dict[str, Any]:
    """Numbers of the agents inside, in order of their rows, and what subclasses add to them.

    Raises:
        ModelError: agents of other classes, or an attribute that cannot be saved.
    """
    agents = model.space.active_agents
    if len(model.agents) != len(agents):
        raise ModelError(
            f"{type(model).__name__}: has agents who are not in its population, which cannot be "
            "saved; expected pedestrians alone"
        )
    own = {}
    for agent in agents:
        added = {name: each for name, each in vars(agent).items() if name not in _FRAMEWORK}
        if added:
            own[str(agent.row)] = {
                name: packer.pack(each, f"{type(agent).__name__}.{name} of pedestrian {agent.row}")
                for name, each in added.items()
            }
    return {
        "unique_ids": [agent.unique_id for agent in agents],
        "last_id": last_number(model),
        "own": own,
    }


def restore_attributes(model: CrowdModel, saved: Mapping[str, Any], unpacker: Unpacker) -> None:
    """Give the agents their own attributes."""
    agents = {str(agent.row): agent for agent in model.space.active_agents}
    for row, packed in saved["own"].items():
        if row not in agents:
            raise ModelError(f"people, own: got {row!r:.40}, expected the row of somebody inside")
        agent = agents[row]
        own = {name: unpacker.unpack(value) for name, value in packed.items()}
        where = f"{type(agent).__name__} {row}, "
        for name in _FRAMEWORK & own.keys():
            raise ModelError(f"{where}{name}: expected attributes that not everybody has")
        check_alike(vars(agent), own, type(agent), where)
        for name, value in own.items():
            object.__setattr__(agent, name, value)
