"""Stairs of a building: who takes them, how long that takes, and how many pass their ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.results.measures.crossings import Crossings, flow
from mesa_mobility.results.measures.storeys import Where, curve, people_at_a_time, where
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.buildings import Building

FloatArray = NDArray[np.float64]

HEAD, FOOT = 1, -1

COLUMNS = ("people", "down", "up", "mean_s", "head_per_s", "foot_per_s", "most", "most_per_m2")


@dataclass(frozen=True, eq=False)
class Climbs:
    """People's ways on one stair, from an end of it to an end of it, in order of time.

    Attributes:
        person: (k,) int32.
        start: (k,) float64, seconds: the first frame on the stair.
        end: (k,) float64, seconds: the first frame beyond it; infinite for people who are on it
            when the run ends.
        came_by: (k,) int8: +1 by its head, -1 by its foot, 0 for people who started on it.
        left_by: (k,) int8: the same; 0 for people who are on it when the run ends.
    """

    person: NDArray[np.int32]
    start: FloatArray
    end: FloatArray
    came_by: NDArray[np.int8]
    left_by: NDArray[np.int8]

    @property
    def down(self) -> NDArray[np.bool_]:
        """(k,) whether it was the whole way down."""
        return (self.came_by == HEAD) & (self.left_by == FOOT)

    @property
    def up(self) -> NDArray[np.bool_]:
        """(k,) whether it was the whole way up."""
        return (self.came_by == FOOT) & (self.left_by == HEAD)

    def over_head(self) -> Crossings:
        """Passages over the upper edge; direction +1 is down, onto the stair."""
        return self._over(HEAD)

    def over_foot(self) -> Crossings:
        """Passages over the lower edge; direction +1 is down, off the stair."""
        return self._over(FOOT)

    def _over(self, edge: int) -> Crossings:
        came, left = self.came_by == edge, self.left_by == edge
        time = np.concatenate([self.start[came], self.end[left]])
        person = np.concatenate([self.person[came], self.person[left]])
        # Down is onto the stair at its head, and off it at its foot.
        direction = np.repeat(np.array([edge, -edge], dtype=np.int8), [came.sum(), left.sum()])
        order = np.argsort(time, kind="stable")
        return Crossings(time[order], person[order], direction[order])


def climbs(trajectories: Tracks, building: Building) -> dict[str, Climbs]:
    """The ways of people on each stair of a building, by its name.

    The flights and landings of a stair count as one. A person who turns back on it and takes it
    later has two ways. `flow`, `passed_by` and `flow_over_time` take ``over_head()`` and
    ``over_foot()``.

    Args:
        trajectories: a run in the building.
        building: the building.

    Raises:
        ResultsError: the tracks have no elevations.
    """
    return _climbs(trajectories, building, where(trajectories, building))


def _climbs(trajectories: Tracks, building: Building, found: Where) -> dict[str, Climbs]:
    order = trajectories.by_person
    stairs, level = found.stairs[order], found.level[order]
    person, frame = trajectories.person[order], trajectories.frame[order]
    changes = (np.diff(stairs) != 0) | (np.diff(person) != 0)
    first = np.flatnonzero(np.append(True, changes)[: len(order)])
    beyond = np.append(first[1:], len(order))
    ways = {}
    for number, each in enumerate(building.stairs):
        own = stairs[first] == number
        start, after = first[own], beyond[own]
        before = np.maximum(start - 1, 0)
        came = (start > 0) & (person[before] == person[start])
        then = np.minimum(after, len(order) - 1)
        left = (after < len(order)) & (person[then] == person[start])
        seconds = np.where(left, frame[after - 1] + 1, np.inf) / trajectories.frame_rate
        ends = {each.upper: HEAD, each.lower: FOOT}
        way = Climbs(
            person[start],
            frame[start] / trajectories.frame_rate,
            seconds,
            _ends(level[before], came, ends),
            _ends(level[then], left, ends),
        )
        in_time = np.lexsort((way.person, way.start))
        ways[each.name] = Climbs(*(getattr(way, name)[in_time] for name in way.__annotations__))
    return ways


def _ends(
    level: NDArray[np.int16], known: NDArray[np.bool_], ends: dict[int, int]
) -> NDArray[np.int8]:
    """(k,) the end of a stair at which people are next to it, by the level there."""
    found = np.zeros(len(level), dtype=np.int8)
    for number, end in ends.items():
        found[known & (level == number)] = end
    return found


def occupancy_by_stairs(
    trajectories: Tracks, building: Building, every: float = 1.0
) -> dict[str, list[list[float]]]:
    """How many people are on each stair, as [[t, people], ...] by its name.

    Args:
        trajectories: a run in the building.
        building: the building.
        every: seconds between the entries; the first is at 0, the last not after the end.

    Raises:
        ResultsError: `every` is shorter than a frame, or the tracks have no elevations.
    """
    stairs = where(trajectories, building).stairs
    return {
        each.name: curve(trajectories, stairs == number, every)
        for number, each in enumerate(building.stairs)
    }


def by_stairs(trajectories: Tracks, building: Building) -> pd.DataFrame:
    """How many people took each stair, how long they were on it, and the flow over its ends.

    Args:
        trajectories: a run in the building.
        building: the building.

    Returns:
        A row for each stair, by name: ``people`` who were ever on it; ``down`` and ``up``, how
        often it was walked whole; ``mean_s``, mean time of these ways, nan if there is none;
        ``head_per_s`` and ``foot_per_s``, the mean flow over its upper and its lower edge, both
        ways, as `flow` has it, nan for fewer than two passages; ``most``, the greatest number of
        people on it at a time, and ``most_per_m2``, that number over the area of its flights and
        landings in plan.

    Raises:
        ResultsError: the tracks have no elevations.
    """
    import pandas as pd

    found = where(trajectories, building)
    ways = _climbs(trajectories, building, found)
    table = []
    for number, each in enumerate(building.stairs):
        own = ways[each.name]
        whole = own.down | own.up
        flows = [flow(over.time) for over in (own.over_head(), own.over_foot())]
        head, foot = (np.nan if one is None else one for one in flows)
        most = people_at_a_time(trajectories, found.stairs == number).max()
        table.append(
            {
                "stairs": each.name,
                "people": len(np.unique(own.person)),
                "down": int(own.down.sum()),
                "up": int(own.up.sum()),
                "mean_s": (own.end - own.start)[whole].mean() if whole.any() else np.nan,
                "head_per_s": head,
                "foot_per_s": foot,
                "most": int(most),
                "most_per_m2": most / sum(shape.area for shape in building.shapes_of(each)),
            }
        )
    return pd.DataFrame(table, columns=["stairs", *COLUMNS]).set_index("stairs")
