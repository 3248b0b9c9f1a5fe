"""The state of a run that a page shows, and how often each part of it is sent."""

from __future__ import annotations

import time
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from typing import Any

import solara

from mesa_mobility import PedestrianModel, PedestrianType
from mesa_mobility.crowd import Explanation
from mesa_mobility.dashboard.session import serialization
from mesa_mobility.dashboard.session.behaviours import ChoiceState, TermState
from mesa_mobility.dashboard.session.bodies import Bodies
from mesa_mobility.dashboard.session.colouring import COLOURINGS, colourings_of
from mesa_mobility.dashboard.session.decision import described
from mesa_mobility.dashboard.session.feed import Feed
from mesa_mobility.dashboard.session.observer import Observer
from mesa_mobility.dashboard.session.plan_changes import PlanChanges
from mesa_mobility.dashboard.session.run_config import Recipe

FRAME_INTERVAL = 1.0 / 30.0
"""Least time between two frames for the canvas, seconds; it draws what lies between by itself."""

DECISION_INTERVAL = 0.2
SERIES_INTERVAL = 1.0
"""Least times between decisions, and between drawings of the charts, seconds."""

UNDER_WAY = 2
"""Frames sent that the page has not yet answered, at most: one that is slow gets fewer."""

RESEND = 0.5
"""Seconds after which the next frame is sent all the same."""

PATIENCE = 5.0
"""Seconds without an answer from the page after which a run waits for it: nobody is looking."""


@dataclass(frozen=True)
class Status:
    """The status of a run on the page.

    Attributes:
        state: "no model", "building", "ready", "playing", "finished", "stalled" or "failed".
        elapsed: simulated seconds.
        inside: people inside.
        pace: simulated seconds in a second, while playing.
        reason: why nobody gets out, or "".
        blocked: rows of people who have stood for a minute without a reason, and of the chain of
            people who are in the way of each.
    """

    state: str = "no model"
    elapsed: float = 0.0
    inside: int = 0
    pace: float = 0.0
    reason: str = ""
    blocked: tuple[tuple[int, tuple[int, ...]], ...] = ()


class Shown:
    """The state of a page.

    What changes many times a second is a ``Feed``; the rest is reactive: components that read it
    are drawn anew when it changes.

    Attributes:
        recipe: ``Recipe`` of the model that runs, or None.
        status: ``Status``, each second and when it changes.
        frame: the crowd as the canvas draws it.
        floor: the floor plan as the canvas draws it.
        solid: the building as the three-dimensional view draws it; {} for a floor plan.
        behaviours: ``TermState`` of each cost term.
        choice: ``ChoiceState`` of the exits chosen.
        series: a number that grows, and the ``Observer`` of the run; each second.
        decision: the decision of the selected person as its view draws it, or {}; ``left``
            alone has the row of somebody who was selected and has left.
        types: the pedestrian types of the model that runs.
        selected: row of the person whose decisions are shown, or -1.
        problem: what the last command or step ran into, or "".
        notices: the warnings that the model has given.
        colouring: by what people are coloured.
        colourings: names of all by which they can be.
        run_number: number of the run that is shown, 1 for the page's first.
        hypothetical: whether the shown decision is the one that the person would take now.
        poses: figures and poses for the three-dimensional view, "" while it is not shown.
        together: within it the page is not drawn; at its end once.
    """

    def __init__(self) -> None:
        self.recipe: solara.Reactive[Recipe | None] = solara.reactive(None)
        self.status = solara.reactive(Status())
        self.frame = Feed("frame")
        self.floor: solara.Reactive[dict[str, Any]] = solara.reactive({})
        self.solid: solara.Reactive[dict[str, Any]] = solara.reactive({})
        self.behaviours: solara.Reactive[tuple[TermState, ...]] = solara.reactive(())
        self.choice = solara.reactive(ChoiceState("", ()))
        self.series: solara.Reactive[tuple[int, Observer | None]] = solara.reactive((0, None))
        self.decision = Feed("decision")
        self.types: solara.Reactive[tuple[PedestrianType, ...]] = solara.reactive(())
        self.selected = solara.reactive(-1)
        self.problem = solara.reactive("")
        self.notices: solara.Reactive[tuple[str, ...]] = solara.reactive(())
        self.colouring = COLOURINGS["speed"]
        self.colourings = solara.reactive(tuple(COLOURINGS))
        self._colour = "speed"
        self.hypothetical = False
        self.poses = solara.reactive("")
        self._posing = False
        self._bodies: Bodies | None = None
        self.together: AbstractContextManager[Any] = nullcontext()
        self.run_number = 0
        self._sent = self._seen = self._series_number = 0
        self._frames: dict[int, int] = {}
        self._got = -1
        self._explained: Explanation | None = None
        self._frame_at = self._series_at = self._decision_at = 0.0

    def seen(self, number: int) -> None:
        """The page has got frame ``number``."""
        self._seen = number

    def nobody_looks(self) -> bool:
        """Whether the page has not answered for long."""
        return self._sent > self._seen and time.perf_counter() - self._frame_at > PATIENCE

    def show_new(self, recipe: Recipe, model: PedestrianModel, plan: PlanChanges) -> None:
        """Show a model that has just been made; its behaviours are shown apart."""
        self.run_number += 1
        self._frames.clear()
        self._got = -1
        self.recipe.set(recipe)
        self.problem.set("")
        self.mark(-1)
        self.types.set(model.pedestrian_types)
        self.show_floor(plan)
        self.colourings.set(tuple(colourings_of(model)))
        self.use_bodies(self._posing, model)
        self.use_colour(self._colour, model)

    def show_floor(self, plan: PlanChanges) -> None:
        """Show a floor plan as it is now."""
        with self.together:
            self.floor.set(plan.drawn())
            self.solid.set(plan.solid())

    def use_bodies(self, on: bool, model: PedestrianModel | None) -> None:
        """Send the poses of this model's people from now on, or not."""
        self._posing = on
        self._bodies = Bodies(model) if on and model is not None else None
        self.poses.set("" if self._bodies is None else self._bodies.bundle())

    def use_colour(self, name: str, model: PedestrianModel | None) -> None:
        """Colour people by this name from now on; by their speed where the model has none such."""
        self._colour = name
        known = COLOURINGS if model is None else colourings_of(model)
        self.colouring = known.get(name, COLOURINGS["speed"])

    def mark(self, row: int) -> None:
        """Select the person in ``row``, nobody if ``row`` is negative; no decision is shown yet."""
        self.forget_decision()
        self.decision.set({})
        self.selected.set(row)

    def forget_decision(self) -> None:
        """Show the selected person's decision again."""
        self._explained = None

    def show(
        self, model: PedestrianModel, observer: Observer, status: Status, *, always: bool
    ) -> None:
        """Send what is due; everything if ``always``."""
        now = time.perf_counter()
        heard = self._sent - self._seen < UNDER_WAY or now - self._frame_at > RESEND
        if always or (heard and now - self._frame_at >= FRAME_INTERVAL):
            self._sent, self._frame_at = self._sent + 1, now
            self._frames[self._sent] = model.frame
            self.frame.set(
                serialization.frame(
                    model,
                    self.colouring,
                    observer,
                    run=self.run_number,
                    number=self._sent,
                    since=self._known_until(),
                    bodies=self._bodies,
                )
            )
        if always or now - self._series_at >= SERIES_INTERVAL:
            self._series_at = now
            self._series_number += 1
            with self.together:
                self.status.set(status)
                self.series.set((self._series_number, observer))
        if always or now - self._decision_at >= DECISION_INTERVAL:
            self._decision_at = now
            self._tell_decision(model)

    def _known_until(self) -> int:
        """The model's last frame that the page has got, or -1."""
        seen = self._seen
        for number in [each for each in self._frames if each <= seen]:
            self._got = self._frames.pop(number)
        return self._got

    def _tell_decision(self, model: PedestrianModel) -> None:
        if model.watch is None:
            return
        row, explained = model.watch.pedestrian, model.watch.decision
        if not model.crowd.active[row]:
            model.watch = None
            self.mark(-1)
            self.decision.set({"left": row})
            return
        if explained is None or self.hypothetical:
            if self._explained is not None and self._explained.frame == model.frame:
                return
            explained = model.explain(row)
        if explained is not None and explained is not self._explained:
            self._explained = explained
            self.decision.set(described(explained, model))
