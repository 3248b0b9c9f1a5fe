"""Parts of a run: whom to show or write, and when."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.columns import COLUMNS
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.bodies import PoseBank
    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan


@dataclass(frozen=True)
class Selection:
    """Whom to show of a run, and when.

    Attributes:
        people: numbers of people; everybody if None.
        start: seconds from which on.
        end: seconds until when; the end of the run if None.
    """

    people: tuple[int, ...] | None = None
    start: float = 0.0
    end: float | None = None

    def frames_of(self, trajectories: Tracks) -> tuple[int, int]:
        """First and last frame shown.

        Raises:
            ResultsError: times outside the run, or in the wrong order.
        """
        end = trajectories.duration if self.end is None else self.end
        if not 0.0 <= self.start < end <= trajectories.duration + 1e-9:
            raise ResultsError(
                f"from {self.start:g} to {end:g} s: expected rising times within the run's "
                f"{trajectories.duration:g} s"
            )
        return round(self.start * trajectories.frame_rate), round(end * trajectories.frame_rate)

    def people_of(self, trajectories: Tracks) -> list[int]:
        """Numbers of those shown who are there at that time.

        Raises:
            ResultsError: a number that the run does not have, or nobody is there.
        """
        if self.people is not None:
            known = np.unique(trajectories.person)
            absent = np.setdiff1d(self.people, known)
            if len(absent):
                raise ResultsError(f"person {absent[0]}: not among the run's {len(known)} people")
        first, last = self.frames_of(trajectories)
        there = (trajectories.frame >= first) & (trajectories.frame <= last)
        present = np.flatnonzero(np.bincount(trajectories.person[there]))
        shown = present if self.people is None else np.intersect1d(present, self.people)
        if not len(shown):
            raise ResultsError(f"nobody is there from frame {first} to {last}")
        return [int(each) for each in shown]


@dataclass(frozen=True)
class Excerpt:
    """A run, and the part of it that is written to a file.

    Attributes:
        trajectories: the whole run, with the decisions if they were recorded.
        plan: its floor plan, or its building for formats with ``storeys``.
        selection: whom to write, and when.
        summary: its figures.
        bank: poses of the run's map where they do not ship.
        progress: called as ``progress(done, of)``.
    """

    trajectories: Tracks
    plan: FloorPlan | Building
    selection: Selection = field(default_factory=Selection)
    summary: Mapping[str, Any] = field(default_factory=dict)
    bank: PoseBank | None = None
    progress: Callable[[int, int], None] = lambda done, of: None

    @cached_property
    def people(self) -> list[int]:
        """Numbers of the people who are written; see ``Selection.people_of`` for errors."""
        return self.selection.people_of(self.trajectories)

    @property
    def building(self) -> Building | None:
        """The building of a run in several storeys."""
        from mesa_mobility.floorplan import FloorPlan

        return None if isinstance(self.plan, FloorPlan) else self.plan

    @property
    def floor_plan(self) -> FloorPlan:
        """The floor plan of a run on one level.

        Raises:
            ResultsError: it is a run in a building.
        """
        from mesa_mobility.floorplan import FloorPlan

        if not isinstance(self.plan, FloorPlan):
            raise ResultsError(f"a run in a building of {len(self.plan.levels)} levels")
        return self.plan

    @property
    def title(self) -> str:
        """One line that says what the run was."""
        return title_of(self.summary, self.trajectories)

    def person_done(self, done: int) -> None:
        """Report progress: so many people are done."""
        self.progress(done, len(self.people))

    def tracks(self) -> Tracks:
        """The trajectories of this part alone, in the frames of the whole run."""
        whole = self.trajectories
        if self.selection == Selection():
            return whole
        first, last = self.selection.frames_of(whole)
        there = (whole.frame >= first) & (whole.frame <= last)
        rows = there & np.isin(whole.person, self.people)
        now = np.unique(whole.person[rows & (whole.frame == last)])
        return replace(
            whole,
            **{name: getattr(whole, name)[rows] for name in COLUMNS},
            fields={name: values[rows] for name, values in whole.fields.items()},
            last_frame=last,
            inside_at_end=now[whole.exit_frames[now] != last],
            decisions=None,
        )


def title_of(summary: Mapping[str, Any], trajectories: Tracks) -> str:
    """One line that says what a run was."""
    egress = summary.get("egress_s")
    left = summary.get("left_inside", 0)
    ending = (
        f"all out after {egress:.0f} s"
        if egress is not None
        else f"{left} still inside after {trajectories.duration:.0f} s"
    )
    run = ", ".join(f"{key} {summary[key]}" for key in ("preset", "seed") if key in summary)
    name = str(summary.get("model", "run")).replace("_", " ")
    return f"{name}: {trajectories.people} people, {ending}" + (f" ({run})" if run else "")
