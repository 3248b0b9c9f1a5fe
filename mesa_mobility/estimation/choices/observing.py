"""From tracks to choices: what measured people could have done, and what they did."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.errors import ResultsError
from mesa_mobility.estimation.choices.availability import FREE
from mesa_mobility.estimation.choices.free_speeds import FreeSpeeds, nodes
from mesa_mobility.estimation.choices.observations import Batch, Coverage, Observations
from mesa_mobility.estimation.choices.places import Places, places_of
from mesa_mobility.estimation.choices.poses import Poses
from mesa_mobility.estimation.choices.sampling import Sampling, Situation, situations
from mesa_mobility.estimation.choices.stage import Stage
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.results.tracks import Tracks

NEAR = 0.12
"""An option is near enough that ends within so many metres of where the person was, metres."""

MOST_NEAR = 60
"""Most options near an end that are looked at: the nearest."""

LEAVING = 0.4
"""Seconds up to the end of a choice over which the direction of walking is taken."""

TACTICS = ("corner_spreading", "course_choice", "anticipation")
"""Tactics of a preset that need nothing of what people have decided before."""


def observe(
    plan: FloorPlan,
    tracks: Tracks,
    *,
    name: str = "tracks",
    fold: str | None = None,
    between: tuple[float, float] | None = None,
    tactics: Sequence[str] = TACTICS,
    sampling: Sampling | None = None,
    **model: Any,
) -> Observations:
    """The choices of measured people, as the engine would have put them.

    At each instant people stand where they were, with the mean velocity of the last frames, and
    walk on as fast for their neighbours. Everybody's exit is the one to which their track leads. A
    choice is between the options of some poses that walk as fast; it is observed by where
    the person was when the option would have ended. Nothing of later frames is used but that end,
    the exit, and free speeds at other times.

    Args:
        plan: where they walked, with exits.
        tracks: two people or more, in metres.
        name: of the run, for errors and tables, such as the file.
        fold: the group of runs that are left out together; by default the run itself.
        between: first and last frame of the tracks to look at; by default all.
        tactics: those of the preset that shape what people want.
        sampling: which choices and options.
        model: arguments of ``PedestrianModel``, such as ``preset`` and ``mobility_map``.

    Raises:
        ResultsError: tracks that cannot be used, or no choice in them; the error names the person
            and the frame.
        ModelError: arguments that the model does not take, or durations that its options lack.
    """
    of = places_of(tracks, plan, name)
    stage = Stage(plan, tuple(tactics), **model)
    chosen = (sampling or Sampling()).with_frames(stage.model.rules.durations)
    rng = np.random.default_rng(chosen.seed)
    looks = _Looks(of, stage, chosen, rng)
    moments = situations(of, chosen, between, rng)
    if not moments:
        raise ResultsError(
            f"{name}: no choice: nobody is seen for {chosen.history:g} s before and "
            f"{max(chosen.frames) / FRAMES_A_SECOND:g} s after an instant"
        )
    batches = [batch for each in moments if (batch := looks.look(each)) is not None]
    if not batches:
        raise ResultsError(f"{name}: no choice with options that hit nothing")
    return Observations.of(
        stage.model, batches, of, name=name, fold=fold or name, coverage=looks.coverage
    )


@dataclass(eq=False)
class _Looks:
    """Makes the batches of one run.

    Attributes:
        of: the tracks.
        stage: the engine.
        chosen: which options are looked at.
        rng: of all that is drawn.
    """

    of: Places
    stage: Stage
    chosen: Sampling
    rng: np.random.Generator
    coverage: Coverage = field(init=False)

    def __post_init__(self) -> None:
        self.coverage = Coverage()
        known = self.stage.scene.repertoire.capabilities[0]
        self._poses = Poses.of(self.stage.table, known.n_clusters)
        self._frames = self.stage.table.options.frames
        self._free = FreeSpeeds(self.of, self.chosen.history)
        self._exits = self.stage.destinations(self.of.exits)
        speed = self.stage.scene.types[0].preferred_speed
        assert speed is not None
        self._nodes = nodes(speed, self.chosen.speeds)

    def look(self, at: Situation) -> Batch | None:
        """The choices of one moment; None without any."""
        seconds = at.duration / FRAMES_A_SECOND
        places = self.of.at(at.frame)
        there = np.flatnonzero(~np.isnan(places[:, 0]))
        velocities = self.of.velocities(at.frame, self.chosen.history)[there]
        own = self._free.own(at.frame, self.chosen.history, seconds)
        speeds = np.where(np.isnan(own), self._nodes[len(self._nodes) // 2], own)[there]
        self.stage.put(places[there], velocities, self._exits[there], speeds, at.duration)
        rows = np.searchsorted(there, at.people)
        ends = self.of.at(at.frame + seconds * self.of.rate)[at.people]
        moving = np.hypot(*velocities[rows].T)
        drawn = [
            self._draw(row, speed, at.duration, end)
            for row, speed, end in zip(rows.tolist(), moving.tolist(), ends, strict=True)
        ]
        some = [k for k, each in enumerate(drawn) if len(each.options) > each.near]
        if not some:
            return None
        return self._batch(at, rows, [drawn[k] for k in some], some, own[at.people])

    def _draw(self, row: int, speed: float, duration: int, end: NDArray[np.float64]) -> _Drawn:
        """Options of somebody: those near the end, and some of all that are available."""
        table, crowd = self.stage.table, self.stage.scene.crowd
        clusters = self._poses.draw(speed, self.chosen.poses, self.rng)
        pool = np.concatenate([np.arange(table.offsets[c], table.offsets[c + 1]) for c in clusters])
        pool = pool[self._frames[pool] == duration]
        c, s = np.cos(crowd.heading[row]), np.sin(crowd.heading[row])
        dx, dy = end[0] - crowd.x[row], end[1] - crowd.y[row]
        option = table.options[pool]
        apart = np.column_stack([option.x - (c * dx + s * dy), option.y - (c * dy - s * dx)])
        off = np.hypot(*apart.T)
        by_distance = np.argsort(off, kind="stable")[:MOST_NEAR]
        near = by_distance[off[by_distance] <= NEAR]
        hit = self.stage.hits(row, pool[near])
        farthest = float(option.speed.max()) * duration / FRAMES_A_SECOND
        self.coverage.count(hit, float(np.hypot(dx, dy)), farthest)
        near = near[hit == FREE]
        others = self.rng.permutation(np.setdiff1d(np.arange(len(pool)), near))
        # Half as many again, since some hit something; all of them where that is not enough.
        count, tried = self.chosen.alternatives, 3 * self.chosen.alternatives // 2
        free = others[:tried][self.stage.hits(row, pool[others[:tried]]) == FREE]
        if len(free) < count:
            rest = others[tried:]
            free = np.concatenate([free, rest[self.stage.hits(row, pool[rest]) == FREE]])
            tried = len(others)
        share = len(free) / max(min(tried, len(others)), 1)
        free = free[:count]
        available = max(share * len(others), len(free), 1e-9)
        return _Drawn(
            options=pool[np.concatenate([near, free])].astype(np.int64),
            off=apart[np.concatenate([near, free])],
            near=len(near),
            stands_for=available / max(len(free), 1),
        )

    def _batch(
        self,
        at: Situation,
        rows: NDArray[np.int64],
        drawn: list[_Drawn],
        some: list[int],
        own: NDArray[np.float64],
    ) -> Batch:
        """The choices as cost terms get them: once for each value of an unknown free speed."""
        known = ~np.isnan(own[some])
        counts = np.where(known, 1, len(self._nodes))
        choice = np.repeat(np.arange(len(some)), counts)
        speeds = np.concatenate(
            [[own[k]] if fine else self._nodes for k, fine in zip(some, known, strict=True)]
        )
        owners = rows[some][choice]
        options = np.concatenate([drawn[k].options for k in choice])
        offsets = np.cumsum([0] + [len(drawn[k].options) for k in choice])
        wants = self._wants(owners, speeds)
        candidates = self.stage.candidates(owners, options, offsets)
        people, end = at.people[some], at.frame + at.duration / FRAMES_A_SECOND * self.of.rate
        return Batch.of(
            candidates,
            wants,
            choice=choice,
            near=np.array([each.near for each in drawn]),
            off=np.concatenate([drawn[k].off for k in choice]),
            stands_for=np.array([each.stands_for for each in drawn]),
            people=people,
            frame=at.frame,
            duration=at.duration,
            ends=self.of.at(end)[people],
            leaving=self.of.velocities(end, LEAVING)[people],
        )

    def _wants(
        self, owners: NDArray[np.int64], speeds: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(segments, 2) targets in metres, and (segments,) speeds, m/s, that people of these
        preferred speeds want after tactics."""
        crowd = self.stage.scene.crowd
        targets, wanted = np.empty((len(owners), 2)), np.empty(len(owners))
        # Occurrences of one person in turn, since a person wants one thing at a time.
        order = np.zeros(len(owners), dtype=np.int64)
        for k in range(1, len(owners)):
            order[k] = order[k - 1] + 1 if owners[k] == owners[k - 1] else 0
        for turn in range(int(order.max()) + 1):
            own = np.flatnonzero(order == turn)
            self.stage.aim(owners[own], speeds[own])
            targets[own] = np.column_stack(
                [crowd.target_x[owners[own]], crowd.target_y[owners[own]]]
            )
            wanted[own] = np.where(
                np.isfinite(crowd.route[owners[own]]), crowd.preferred[owners[own]], 0.0
            )
        return targets, wanted


class _Drawn(NamedTuple):
    """Options of a choice: first those near the end, then those drawn.

    Attributes:
        options: (n,) rows of the table.
        off: (n, 2) metres from the observed end, along and across the heading.
        near: number of those near.
        stands_for: available options for which each drawn one stands.
    """

    options: NDArray[np.int64]
    off: NDArray[np.float64]
    near: int
    stands_for: float
