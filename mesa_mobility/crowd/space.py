"""Mesa's continuous space, with people leaving in batches."""

from __future__ import annotations

from typing import Any

from mesa.experimental.continuous_space import ContinuousSpace, ContinuousSpaceAgent

_FEW = 50


class CrowdSpace(ContinuousSpace):
    """A ``ContinuousSpace`` that can remove many agents at once.

    Mesa moves every later agent up at each removal, which costs 17 ms an agent at
    100,000; here that happens once a batch, and the two tables between agents and
    places are made again only when somebody asks for them.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self._indices: dict[ContinuousSpaceAgent, int] | None = None
        self._agents_by_index: dict[int, ContinuousSpaceAgent] | None = None
        super().__init__(*args, **kwargs)

    def take_out(self, places: list[int]) -> None:
        """Remove the agents at these places of ``active_agents``, in rising order.

        Positions are not moved up: they must be written anew.
        """
        agents: list[ContinuousSpaceAgent] = self.active_agents  # type: ignore[has-type]
        if len(places) < _FEW:
            # To move the rest of a list up is faster than to go through all of it.
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
        # Mesa writes to its tables; with two empty ones nobody has to make them anew for that.
        self._indices, self._agents_by_index = {}, {}
        place: int = super()._add_agent(agent)
        self._forget_tables()
        return place

    def _forget_tables(self) -> None:
        """Forget the tables between agents and places: they take 200 bytes a person."""
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
