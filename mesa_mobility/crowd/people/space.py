"""Mesa's continuous space, with people leaving in batches."""

from __future__ import annotations

from random import Random
from typing import Any

from mesa_mobility._mesa import ContinuousSpace, ContinuousSpaceAgent
from mesa_mobility.floorplan import FloorPlan

_FEW = 50


class CrowdSpace(ContinuousSpace):
    """A ``ContinuousSpace`` that can remove many agents at once.

    Mesa shifts all later agents at each removal, which costs 17 ms an agent with 100,000 of them.
    Here this happens once a batch, and the two tables between agents and indices are built only
    when they are used.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self._indices: dict[ContinuousSpaceAgent, int] | None = None
        self._agents_by_index: dict[int, ContinuousSpaceAgent] | None = None
        super().__init__(*args, **kwargs)

    def __getstate__(self) -> dict[str, Any]:
        state = dict(self.__dict__)
        del state["agent_positions"]  # a view
        state["_indices"] = state["_agents_by_index"] = None
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.agent_positions = self._agent_positions[: state["_n_agents"]]

    def take_out(self, places: list[int]) -> None:
        """Remove the agents at these ascending indices of ``active_agents``.

        Positions are not shifted: they must be written anew.
        """
        agents: list[ContinuousSpaceAgent] = self.active_agents  # type: ignore[has-type]
        if len(places) < _FEW:
            # Shifting the rest of a list is faster than filtering all of it.
            for place in reversed(places):
                del agents[place]
        else:
            leaving = set(places)
            agents = [agent for k, agent in enumerate(agents) if k not in leaving]
        self.active_agents = agents
        self._n_agents = len(self.active_agents)
        self.agent_positions = self._agent_positions[: self._n_agents]
        self._forget_tables()

    def _add_agent(self, agent: ContinuousSpaceAgent) -> int:
        # Mesa writes to its tables; empty ones spare building them for that.
        self._indices, self._agents_by_index = {}, {}
        place: int = super()._add_agent(agent)
        self._forget_tables()
        return place

    def _forget_tables(self) -> None:
        """Drop the tables between agents and indices, which take 200 bytes a person."""
        self._indices = self._agents_by_index = None

    @property
    def _agent_to_index(self) -> dict[ContinuousSpaceAgent, int]:
        if self._indices is None:
            self._indices = {agent: k for k, agent in enumerate(self.active_agents)}
        return self._indices

    @_agent_to_index.setter
    def _agent_to_index(self, table: dict[ContinuousSpaceAgent, int]) -> None:
        self._indices = table

    @property
    def _index_to_agent(self) -> dict[int, ContinuousSpaceAgent]:
        if self._agents_by_index is None:
            self._agents_by_index = dict(enumerate(self.active_agents))
        return self._agents_by_index

    @_index_to_agent.setter
    def _index_to_agent(self, table: dict[int, ContinuousSpaceAgent]) -> None:
        self._agents_by_index = table


def space_of(plan: FloorPlan, margin: float, random: Random) -> CrowdSpace:
    """A space for the people on a floor plan.

    Args:
        plan: the floor plan.
        margin: metres by which the space reaches beyond it: people who cross an exit end up a step
            outside.
        random: the model's generator.
    """
    x0, y0, x1, y1 = plan.bounds
    return CrowdSpace(
        [[x0 - margin, x1 + margin], [y0 - margin, y1 + margin]], random=random, n_agents=64
    )
