"""Sites: where something happened in a run, on which level, stairs or lift of its building."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building


@dataclass(frozen=True)
class Site:
    """A place in a run.

    Attributes:
        x, y, z: true coordinates, metres; z is 0 on a floor plan.
        on: the part of the building, such as ``level 1``, ``stairs north`` or ``lift east``; empty
            on a floor plan.
    """

    x: float
    y: float
    z: float
    on: str = ""

    def __str__(self) -> str:
        if not self.on:
            return f"at ({self.x:.2f}, {self.y:.2f})"
        return f"on {self.on} at ({self.x:.2f}, {self.y:.2f}, {self.z:.2f})"


def sites_of(
    trajectories: Tracks, seen: Sequence[tuple[int, int]], building: Building | None
) -> list[Site]:
    """Where people were.

    Args:
        trajectories: the run.
        seen: frame and person of each.
        building: that of the run, if it has one.

    Raises:
        FloorPlanError: a place that is on no level, landing or flight of the building.
    """
    offsets, person = trajectories.frame_offsets, trajectories.person
    rows = [
        offsets[frame] + np.searchsorted(person[offsets[frame] : offsets[frame + 1]], who)
        for frame, who in seen
    ]
    xyz = trajectories.x, trajectories.y, trajectories.z
    places = np.column_stack([each[rows] for each in xyz])
    parts = [""] * len(rows) if building is None else _parts(places, building)
    return [Site(x, y, z, part) for (x, y, z), part in zip(places.tolist(), parts, strict=True)]


def _parts(places: NDArray[np.float64], building: Building) -> list[str]:
    """The level, stairs or lift of (n, 3) true places."""
    levels = building.true_places(building.plane_places(places))[1]
    found = [f"level {number}" for number in levels.tolist()]
    for all_of_them, numbers in (
        (building.stairs, building.stairs_at(places)),
        (building.lifts, building.lifts_at(places)),
    ):
        for k in np.flatnonzero(numbers >= 0).tolist():
            each = all_of_them[numbers[k]]
            found[k] = f"{each.kind} {each.name}"
    return found


def first_of(summary: Mapping[str, Any], name: str) -> str:
    """Where the first of some overlaps or steps through walls was, in words after a comma.

    Args:
        summary: of a run.
        name: under which it has them; nothing is said if it has none.
    """
    for each in summary.get(name) or ():
        return f", the first in frame {each['frame']} {Site(**each['at'])}"
    return ""
