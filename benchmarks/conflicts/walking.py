"""Runs a crowd, and notes each second what its people have been told to do."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely
from mesa_mobility.behaviors import Queueing
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from benchmarks.conflicts.standing import (
    EVERY,
    OFF_FLOOR,
    Known,
    count_crossings,
    count_overlaps,
    find_standing,
)
from benchmarks.conflicts.ways import Ways
from mesa_mobility import PedestrianModel, Trajectories, Visit
from mesa_mobility.crowd import Pedestrian

FRAMES = 30
"""Frames a second."""

AT_PLACE = 1.5
"""Metres from a place to visit within which people may wait."""

SERVED_WITHIN = 30.0
"""Seconds, beside the service, in which a line that moves on moves on."""

MOVEMENT = 2.0
"""Seconds, more than a movement takes: whoever is in an opening that closes ends theirs."""

NAMED = 10
"""People whose rows are given, at most."""


@dataclass(frozen=True)
class Closure:
    """An exit or a gate that is closed from one second to another."""

    name: str
    closes: float
    opens: float


@dataclass
class Walk:
    """A run, with what is known of its people.

    Attributes:
        model: has run, or is to run.
        limit: simulated seconds at most.
        closures: openings that close for some time.
        queueing: lines, whose people may stand while these move on.
        longest_service: seconds.
    """

    model: PedestrianModel
    limit: float
    closures: Sequence[Closure] = ()
    queueing: Queueing | None = None
    longest_service: float = 0.0
    stalled_frames: int = 0
    _goals: dict[Any, int] = field(default_factory=dict)
    _shapes: list[BaseGeometry] = field(default_factory=list)
    _notes: list[tuple[list[int], list[int], list[bool]]] = field(default_factory=list)
    _speeds: dict[int, float] = field(default_factory=dict)
    _fronts: dict[int, tuple[int, float]] = field(default_factory=dict)

    def run(self) -> dict[str, Any]:
        """Run until everybody is out or time is up; the figures."""
        model, begun = self.model, time.process_time()
        plan, walls = model.floor_plan, np.array(model.floor_plan.walls)
        ways = Ways(plan.free, walls)
        floor = plan.free.buffer(OFF_FLOOR)
        acts = sorted(
            [(each.closes, plan.close_gate, each.name) for each in self.closures]
            + [(each.opens, plan.open_gate, each.name) for each in self.closures],
            key=lambda act: act[0],
        )
        while (model.inside or model.sources.expecting) and model.elapsed < self.limit - 1e-9:
            while acts and model.elapsed >= acts[0][0] - 1e-9:
                _, act, name = acts.pop(0)
                act(name)
            if model.frame % FRAMES == 0:
                self._note()
            model.step()
            self.stalled_frames += model.stalled * model.frames_per_step
        self._note()
        return self._figures(ways, walls, floor, time.process_time() - begun)

    def _note(self) -> None:
        now = self.model.elapsed
        closed = any(each.closes <= now <= each.opens for each in self.closures)
        in_line = self._in_lines(now)
        rows, goals, told = [], [], []
        for person in self.model.space.active_agents:
            self._speeds.setdefault(person.row, person.preferred_speed)
            rows.append(person.row)
            goals.append(self._goal_of(person))
            told.append(
                closed or now < person.start_time or person.row in in_line or _visits(person)
            )
        self._notes.append((rows, goals, told))

    def _goal_of(self, person: Pedestrian) -> int:
        stop = person.next_stop
        key = stop if stop is not None else frozenset(person.exits)
        if key not in self._goals:
            plan = self.model.floor_plan
            if isinstance(stop, Visit):
                shape = stop.area if stop.area is not None else shapely.Point(stop.place)
            elif stop is not None:
                shape = plan.gate(stop).line
            else:
                shape = shapely.union_all([e.line for e in plan.exits if e.name in person.exits])
            self._goals[key] = len(self._shapes)
            self._shapes.append(shape)
        return self._goals[key]

    def _in_lines(self, now: float) -> set[int]:
        """Rows of those in a line whose front has changed of late."""
        rows = set[int]()
        for number, counter in enumerate(self.queueing.counters if self.queueing else ()):
            line = self.queueing.line(counter)  # type: ignore[union-attr]
            front = line[0] if line else -1
            if self._fronts.get(number, (-2, 0.0))[0] != front:
                self._fronts[number] = front, now
            if now - self._fronts[number][1] <= self.longest_service + SERVED_WITHIN:
                rows.update(line)
        return rows

    def known(self) -> Known:
        """What has been noted."""
        shape = len(self._notes), self.model.population.count
        goal, excused = np.full(shape, -1), np.zeros(shape, dtype=np.bool_)
        for second, (rows, goals, told) in enumerate(self._notes):
            goal[second, rows], excused[second, rows] = goals, told
        speeds = np.array([self._speeds.get(row, 1.0) for row in range(shape[1])])
        return Known(self._shapes, goal.astype(np.int64), excused, speeds)

    def _figures(
        self, ways: Ways, walls: NDArray[np.float64], floor: BaseGeometry, ran: float
    ) -> dict[str, Any]:
        model, begun = self.model, time.process_time()
        tracks, known = Trajectories.of(model), self.known()
        places = seconds_of(tracks, *known.goal.shape)
        places[known.goal < 0] = np.nan
        found = find_standing(places, known, ways)
        hits = _hits(tracks, walls, floor)
        out = model.statistics.last_left if model.inside == 0 else None
        return {
            "people": model.population.count,
            "left_inside": model.inside,
            "lost": len(found.lost),
            "stood": len(found.stood),
            **hits,
            "closed_crossed": self._through_closed(tracks),
            "out_s": out,
            "simulated_s": round(model.elapsed, 3),
            "stalled_frames": self.stalled_frames,
            "lost_rows": found.lost[:NAMED],
            "stood_from": dict(list(found.stood.items())[:NAMED]),
            "run_cpu_s": round(ran, 2),
            "count_cpu_s": round(time.process_time() - begun, 2),
        }

    def _through_closed(self, tracks: Trajectories) -> int:
        """Pieces of tracks through openings that have been closed for longer than a movement."""
        count = 0
        for each in self.closures:
            first, last = (each.closes + MOVEMENT) * FRAMES, each.opens * FRAMES
            then = (tracks.frame >= first) & (tracks.frame <= last)
            tree = shapely.STRtree([self.model.floor_plan.gate(each.name).line])
            for person in np.unique(tracks.person[then]):
                mine = then & (tracks.person == person)
                track = np.column_stack([tracks.x[mine], tracks.y[mine]])
                count += count_crossings(track, tree)
        return count


def _visits(person: Pedestrian) -> bool:
    """Whether somebody waits at a place that they visit."""
    stop = person.next_stop
    if not isinstance(stop, Visit) or not person.waiting:
        return False
    place = stop.area if stop.area is not None else shapely.Point(stop.place)
    return bool(shapely.Point(person.position).distance(place) <= AT_PLACE)


def seconds_of(tracks: Trajectories, seconds: int, people: int) -> NDArray[np.float64]:
    """(seconds, people, 2) places at whole seconds, metres; NaN of those who are not inside.

    The last of these seconds stands for the end of the run.
    """
    places = np.full((seconds, people, 2), np.nan)
    second = np.ceil(tracks.frame / FRAMES).astype(np.int64)
    whole = (tracks.frame % FRAMES == 0) | (tracks.frame == tracks.last_frame)
    whole &= second < seconds
    places[second[whole], tracks.person[whole]] = np.column_stack(
        [tracks.x[whole], tracks.y[whole]]
    )
    return places


def _hits(tracks: Trajectories, walls: NDArray[np.float64], floor: BaseGeometry) -> dict[str, int]:
    """Overlaps and places off the floor in every tenth frame; pieces of ten steps through walls."""
    offsets, radii = tracks.frame_offsets, tracks.radii
    xy = np.column_stack([tracks.x, tracks.y])
    leaving = np.zeros(len(xy), dtype=np.bool_)
    crossings, tree = 0, shapely.STRtree(shapely.linestrings(walls.reshape(-1, 2, 2)))
    order = tracks.by_person
    for mine in np.split(order, np.flatnonzero(np.diff(tracks.person[order])) + 1):
        crossings += count_crossings(xy[mine], tree)
        leaving[mine[-1]] = tracks.person[mine[-1]] not in tracks.remaining
    overlaps = off = 0
    shapely.prepare(floor)
    for frame in range(0, tracks.frames, EVERY):
        rows = np.arange(offsets[frame], offsets[frame + 1])
        overlaps += count_overlaps(xy[rows], radii[tracks.person[rows]])
        rows = rows[~leaving[rows]]
        off += int((~shapely.intersects_xy(floor, *xy[rows].T)).sum())
    return {"overlaps": overlaps, "wall_crossings": crossings, "off_floor": off}
