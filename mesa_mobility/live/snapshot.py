"""What is sent of a model at one moment, and what each client has not been told yet."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd import PedestrianModel
from mesa_mobility.live.frames import Frame
from mesa_mobility.live.levels import where

PROTOCOL = 1


@dataclass(frozen=True, eq=False)
class People:
    """What stays the same of everybody who has ever been in the model, by number.

    Attributes:
        type_index: (n,) index of the pedestrian type.
        core_radius: (n,) metres.
    """

    type_index: NDArray[np.int16]
    core_radius: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.type_index)

    def of(self, person: NDArray[np.int64], types: tuple[str, ...]) -> dict[str, Any]:
        """Number, type and core radius of some people, ready for JSON."""
        return {
            "person": person.tolist(),
            "type": [types[k] for k in self.type_index[person].tolist()],
            "core_radius": self.core_radius[person].tolist(),
        }


@dataclass(frozen=True, eq=False)
class Snapshot:
    """A model between two steps; it does not change any more, so any thread may read it.

    Attributes:
        frame: where everybody is.
        people: everybody who has ever been there.
        types: names of the pedestrian types.
        plan: the floor plan, or the building, as GeoJSON.
        plan_version: changes with the plan.
        model: name of the model's class.
        rate: frames published in a simulated second.
    """

    frame: Frame
    people: People
    types: tuple[str, ...]
    plan: str
    plan_version: int
    model: str
    rate: float

    @cached_property
    def binary(self) -> bytes:
        """The frame in binary form."""
        return self.frame.to_bytes()

    @cached_property
    def text(self) -> str:
        """The frame in JSON form."""
        return self.frame.to_json()

    @cached_property
    def scene(self) -> str:
        """The full state except the frame, for a client that knows nothing yet."""
        here = self.frame.person.astype(np.int64)
        values = {
            "type": "scene",
            "protocol": PROTOCOL,
            "model": self.model,
            "rate": self.rate,
            "people": self.people.of(here, self.types),
        }
        return f'{_json(values)[:-1]},"plan":{self.plan}}}'


class Told:
    """What one client knows."""

    def __init__(self) -> None:
        self._people = self._plan = -1

    def missing(self, now: Snapshot) -> list[str]:
        """Messages that the client needs before the frame of a snapshot, which it knows then."""
        before, plan = self._people, self._plan
        self._people, self._plan = len(now.people), now.plan_version
        if before < 0:
            return [now.scene]
        messages = []
        if plan != now.plan_version:
            messages.append(f'{{"type":"plan","plan":{now.plan}}}')
        if before < len(now.people):
            new = np.arange(before, len(now.people), dtype=np.int64)
            messages.append(_json({"type": "people", "people": now.people.of(new, now.types)}))
        return messages


class Camera:
    """Takes snapshots of a model.

    Args:
        model: the model.
        rate: frames that are published in a simulated second.
    """

    def __init__(self, model: PedestrianModel, rate: float) -> None:
        self._model = model
        self._rate = rate
        self._types = tuple(each.name for each in model.pedestrian_types)
        self._number = 0
        self._people = People(np.empty(0, dtype=np.int16), np.empty(0))
        self._plan, self._plan_version = "", -1

    def take(self, *, paused: bool) -> Snapshot:
        """The model as it is now."""
        model, crowd, rows = self._model, self._model.crowd, self._model.rows
        count = model.population.count
        if count != len(self._people):
            self._people = People(crowd.type_index[:count].copy(), crowd.core[:count].copy())
        if self._plan_version != model.floor_plan.version:
            self._plan_version = model.floor_plan.version
            self._plan = _json((model.building or model.floor_plan).to_geojson())
        here = where(model, rows)
        self._number += 1
        frame = Frame(
            self._number,
            model.frame,
            time.time(),
            paused,
            rows.astype(np.int32),
            here.x,
            here.y,
            crowd.heading[rows],
            crowd.vx[rows],
            crowd.vy[rows],
            here.z,
            here.level,
        )
        return Snapshot(
            frame,
            self._people,
            self._types,
            self._plan,
            self._plan_version,
            type(model).__name__,
            self._rate,
        )


def _json(values: dict[str, Any]) -> str:
    return json.dumps(values, separators=(",", ":"), allow_nan=False)
