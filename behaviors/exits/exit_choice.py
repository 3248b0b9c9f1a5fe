"""Base class of behaviours that choose among exits."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Deciding, Range, TargetChoice, Targets
from mesa_mobility.errors import ModelError
from mesa_mobility.schema import Array, Kind

UNDECIDED = -1


@dataclass(frozen=True)
class Choosing:
    """The k people who choose among e exits in this frame.

    Attributes:
        pedestrians: (k,) their rows in the crowd.
        positions: (k, 2) where they are, metres.
        preferred_speeds: (k,) how fast each would walk if nothing slowed it down, m/s.
        distances: (k, e) metres to each exit; inf where it is closed, out of reach or not theirs.
        current: (k,) number of the exit that each heads for, -1 for none.
        under_way: (k,) seconds since each chose an exit for the first time.
        heading: (m,) the same of everybody inside, in the order of ``deciding.inside``.
        deciding: everybody who decides, and everybody inside.
    """

    pedestrians: NDArray[np.int64]
    positions: NDArray[np.float64]
    preferred_speeds: NDArray[np.float64]
    distances: NDArray[np.float64]
    current: NDArray[np.int64]
    under_way: NDArray[np.float64]
    heading: NDArray[np.int64]
    deciding: Deciding


class ExitChoice(TargetChoice):
    """People choose one of the exits by which they may leave, and reconsider from time to time.

    People without an exit, or whose exit has closed, choose at their next decision. The others
    reconsider at random, every ``interval`` seconds on average, so that not everybody runs to and
    fro at once. Those on their way to a gate keep to it. An object of this class serves one model.

    Args:
        interval: mean seconds between two choices.

    Raises:
        ModelError: an interval that is not positive.
    """

    def __init__(
        self, interval: Annotated[float, Range(0.0, unit="s", above=True, endless=True)] = 2.0
    ) -> None:
        self.interval = interval
        self._chosen = np.empty(0, dtype=np.int64)
        self._thought = np.empty(0)
        self._set_out = np.empty(0)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are that are not a subclass's own."""
        return {
            **self.setting_kinds(),
            "_chosen": Array("i8", ("known",), UNDECIDED, below="exit_numbers"),
            "_thought": Array("f8", ("known",), 0.0, 1e9),
            "_set_out": Array("f8", ("known",), 0.0, 1e9, missing=True),
        }

    @abstractmethod
    def choose(self, choosing: Choosing) -> NDArray[np.int64]:
        """(k,) number of each one's exit, in the order of the floor plan."""

    def heading(self, pedestrians: NDArray[np.int64]) -> NDArray[np.int64]:
        """(n,) number of the exit chosen by people in these rows, -1 for none."""
        self._make_room(pedestrians)
        return self._chosen[pedestrians]

    def forget(self, pedestrian: int) -> None:
        """Let the person in a row of the crowd choose again at their next decision."""
        self._make_room(np.array([pedestrian]))
        self._chosen[pedestrian] = UNDECIDED

    def targets(self, deciding: Deciding) -> Targets:
        """Targets on the routes to the chosen exits."""
        rows, site = deciding.pedestrians, deciding.site
        self._make_room(rows)
        names = [exit_.name for exit_ in site.plan.exits]
        numbers = self._numbers(deciding, names)
        may = self._may(deciding, names)
        # Closed, or no longer theirs.
        now = self._chosen[rows]
        gone = self._closed(rows, deciding, names)
        gone |= (now != UNDECIDED) & ~may[np.arange(len(rows)), now]
        for_gate = ~may.any(axis=1)
        waited = deciding.elapsed - self._thought[rows]
        again = deciding.rng.random(len(rows)) < 1.0 - np.exp(-waited / self.interval)
        who = np.flatnonzero((again | (self._chosen[rows] == UNDECIDED) | gone) & ~for_gate)
        self._thought[rows] = deciding.elapsed
        new = who[np.isnan(self._set_out[rows[who]])]
        self._set_out[rows[new]] = deciding.elapsed
        if len(who):
            self._chosen[rows[who]] = self._choice(deciding, who, numbers[who], may[who])
        chosen = self._chosen[rows]
        known = (chosen != UNDECIDED) & ~for_gate
        to = np.where(known, numbers[np.arange(len(rows)), chosen], deciding.destinations)
        return site.targets(deciding.positions, to)

    def _choice(
        self,
        deciding: Deciding,
        who: NDArray[np.int64],
        numbers: NDArray[np.int64],
        may: NDArray[np.bool_],
    ) -> NDArray[np.int64]:
        rows, positions, inside = (
            deciding.pedestrians[who],
            deciding.positions[who],
            deciding.inside,
        )
        distances = np.column_stack(
            [
                deciding.site.targets(positions, np.ascontiguousarray(to)).distances
                for to in numbers.T[:-1]
            ]
        )
        distances[~may] = np.inf
        heading = self.heading(inside.pedestrians)
        choosing = Choosing(
            pedestrians=rows,
            positions=positions,
            preferred_speeds=inside.preferred_speeds[inside.places(rows)],
            distances=distances,
            current=self._chosen[rows],
            under_way=deciding.elapsed - self._set_out[rows],
            heading=heading,
            deciding=deciding,
        )
        # People who can reach none stay undecided, and choose again.
        chosen = np.asarray(self.choose(choosing))
        exits = distances.shape[1]
        if chosen.shape != (len(who),) or not np.isin(chosen, np.arange(-1, exits)).all():
            raise ModelError(
                f"behaviour {self.name!r}: chose exits of shape {chosen.shape}, expected "
                f"({len(who)},) numbers of exits, 0 to {exits - 1}, or -1 for none"
            )
        return np.where(np.isfinite(distances).any(axis=1), chosen, UNDECIDED)

    def _numbers(self, deciding: Deciding, names: list[str]) -> NDArray[np.int64]:
        """(n, e + 1) destination number of each exit for each deciding pedestrian; the last column,
        for no exit, is -1."""
        types, inverse = np.unique(deciding.types, return_inverse=True)
        site = deciding.site
        table = [[*(site.destination((name,), kind) for name in names), -1] for kind in types]
        return np.array(table, dtype=np.int64).reshape(len(types), len(names) + 1)[inverse]

    def _may(self, deciding: Deciding, names: list[str]) -> NDArray[np.bool_]:
        """(n, e) whether each may leave by each exit; none for those on their way to a gate."""
        destinations, inverse = np.unique(deciding.destinations, return_inverse=True)
        allowed = [deciding.site.exits(int(number)) for number in destinations]
        table = np.array([[name in each for name in names] for each in allowed], dtype=np.bool_)
        return table.reshape(len(destinations), len(names))[inverse.reshape(-1)]

    def _closed(
        self, rows: NDArray[np.int64], deciding: Deciding, names: list[str]
    ) -> NDArray[np.bool_]:
        """(n,) whether each one's exit is closed."""
        open_ = np.array([*(deciding.site.plan.is_open(name) for name in names), True])
        return ~open_[self._chosen[rows]]

    def _make_room(self, rows: NDArray[np.int64]) -> None:
        more = int(rows.max(initial=-1)) + 1 - len(self._chosen)
        if more > 0:
            self._chosen = np.append(self._chosen, np.full(more, UNDECIDED))
            self._thought = np.append(self._thought, np.zeros(more))
            self._set_out = np.append(self._set_out, np.full(more, np.nan))
