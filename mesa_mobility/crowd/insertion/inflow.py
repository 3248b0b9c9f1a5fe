"""Inflows: people who come in from the sources of a model, frame by frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, overload

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.insertion.arrivals import Arrivals
from mesa_mobility.crowd.insertion.newcomers import Newcomers, check_types
from mesa_mobility.crowd.insertion.source import MOST_PEOPLE, Source
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.scene import Scene
from mesa_mobility.crowd.state.clearances import passing_of
from mesa_mobility.crowd.types.pedestrian_type import indices_of
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan.entrance import Entrance, read_entrance
from mesa_mobility.populations import Population
from mesa_mobility.schema import Each, Kind, Members, Object, Real, Several, Whole, check

PLACES_TRIED = 16
"""Places tried in a frame for the next person."""

DECK = 100
"""People of a population who are drawn together."""


class Inflow(Saved):
    """A source in a model, with its counts.

    Args:
        source: the source.
        newcomers: a description of the people of each type, by index of the type.
        entrances: where people of each type come in, by index of the type.
        population: the shares of types; None if everybody is of the type ``source.type_index``.
        frame: the current frame, before which nobody comes.
        rng: the model's generator.

    Attributes:
        source: the source.
        arrived: number of people who have come, those held back included.
        entered: number of people who have entered.
    """

    saved: ClassVar[Mapping[str, Kind]] = {
        "arrived": Whole(high=MOST_PEOPLE),
        "entered": Whole(below="people+1"),
        "_next": Real(0.0, infinite=True),
        "_deck": Several(Whole(below="types")),
    }

    def __init__(
        self,
        source: Source,
        newcomers: Mapping[int, Newcomers],
        entrances: Mapping[int, Entrance],
        population: Population | None,
        frame: int,
        rng: np.random.Generator,
    ) -> None:
        self.source = source
        self.arrived = 0
        self.entered = 0
        self._entrances = entrances
        self._newcomers = newcomers
        self._kinds = list(entrances)
        self._population = population
        self._deck: list[int] = []
        self._rng = rng
        times = source.times
        self._times: NDArray[np.float64] | None = None if times is None else np.asarray(times)
        self._arriving = source.arriving
        self._next = max(source.start, frame * FRAME_SECONDS)
        self._draw_next()

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        super().restore(state)
        check(self.entered, Whole(high=self.arrived), "entered")
        if len(self._deck) > DECK or not self._newcomers.keys() >= set(self._deck):
            raise ModelError(
                f"source: _deck of {len(self._deck)}, expected at most {DECK} types of its"
            )

    @property
    def next_type(self) -> int:
        """Index of the type of the next person to enter."""
        if not self._deck:
            self._deck = [self._kinds[0]]
            if self._population is not None:
                drawn = self._population.draw(DECK, self._rng)
                self._deck = [self._kinds[k] for k in drawn.tolist()]
        return self._deck[-1]

    @property
    def entrance(self) -> Entrance:
        """Where the next person comes in."""
        return self._entrances[self.next_type]

    @property
    def newcomers(self) -> Newcomers:
        """The next person."""
        return self._newcomers[self.next_type]

    def let_in(self) -> None:
        """The next person has entered."""
        self._deck.pop()
        self.entered += 1

    @property
    def waiting(self) -> int:
        """Number of arrivals that wait for a free place."""
        return self.arrived - self.entered

    @property
    def finished(self) -> bool:
        """Whether everybody has come and entered."""
        return self.waiting == 0 and self._next == np.inf

    def count(self, frame: int) -> None:
        """Count the arrivals until ``frame``."""
        now = frame * FRAME_SECONDS + 1e-9
        while self._next <= now:
            self.arrived += 1
            self._draw_next()

    def _draw_next(self) -> None:
        source = self.source
        if self._times is None:
            assert self._arriving is not None
            self._next = self._arriving.after(self._next, self._rng.standard_exponential())
        else:
            self._next = self._times[self.arrived] if self.arrived < len(self._times) else np.inf
        full = source.number is not None and self.arrived >= source.number
        if full or self._next >= source.until:
            self._next = np.inf


class Sources(Sequence[Inflow], Saved):
    """A model's sources: an ``Inflow`` for each, in the order in which they were added.

    Args:
        scene: the floor and what people can do on it.
        rng: the model's generator.

    Attributes:
        arrivals: measured people who come at recorded times.
    """

    def __init__(self, scene: Scene, rng: np.random.Generator) -> None:
        self._scene = scene
        self._rng = rng
        self._inflows: list[Inflow] = []
        self.arrivals = Arrivals()

    @overload
    def __getitem__(self, index: int) -> Inflow: ...

    @overload
    def __getitem__(self, index: slice) -> list[Inflow]: ...

    def __getitem__(self, index: int | slice) -> Inflow | list[Inflow]:
        return self._inflows[index]

    def __len__(self) -> int:
        return len(self._inflows)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {
            "inflows": Several(Each(Object(Source), Members(Inflow.saved))),
            "arrivals": Members(Arrivals.saved),
        }

    def state(self) -> dict[str, Any]:
        """The sources, and who has come by each."""
        return {
            "inflows": [(each.source, each.state()) for each in self._inflows],
            "arrivals": self.arrivals.state(),
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        self.arrivals.restore(state["arrivals"])
        del self._inflows[len(state["inflows"]) :]
        for number, (source, inflow) in enumerate(state["inflows"]):
            if number == len(self._inflows):
                self.add(source, 0)
            self._inflows[number].restore(inflow)

    @property
    def expecting(self) -> bool:
        """Whether more people are to come."""
        finished = all(inflow.finished for inflow in self._inflows)
        return self.arrivals.expecting or not finished

    @property
    def endless(self) -> bool:
        """Whether people are to come who go round for ever, or people come for ever."""
        return any(each.source.endless and not each.finished for each in self._inflows)

    def add(self, source: Source, frame: int) -> Inflow:
        """Let people in from ``frame`` on; ``PedestrianModel.add_source`` says what is refused."""
        scene, area = self._scene, read_entrance(source.area)
        if source.type_index is not None and source.population is not None:
            raise ModelError("source: type_index and population, expected one of them")
        population = None if source.population is None else Population.of(source.population)
        if source.type_index is None and population is None:
            population = scene.shares
        kinds = check_types(source.type_index, 1, scene.types)
        if population is not None:
            kinds = indices_of(population, scene.types)
        newcomers = {kind: source.newcomers(kind) for kind in kinds.tolist()}
        entrances: dict[int, Entrance] = {}
        for kind in newcomers:
            of = scene.types[kind]
            entrances[kind] = Entrance(
                scene.plan,
                area,
                clearance=of.half_width + 0.01,
                passing=passing_of(of.half_width),
            )
            destination, _ = scene.journeys.start(source.exits, source.route, source.loop, kind)
            somewhere = entrances[kind].room.representative_point()
            scene.environment.check_way_out(np.array([[somewhere.x, somewhere.y]]), destination)
        inflow = Inflow(source, newcomers, entrances, population, frame, self._rng)
        self._inflows.append(inflow)
        return inflow
