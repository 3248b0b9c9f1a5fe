"""One reader's run: a model, and the one thread that touches it.

The page never calls the model: it hands the thread commands, and shows what the thread has
published.  So the page answers at once however long a step takes, and nothing needs a lock.
"""

from __future__ import annotations

import logging
import queue
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import solara

from mesa_mobility import MobilityError, PedestrianModel, PedestrianType
from mesa_mobility.crowd import Explanation, Watch
from mesa_mobility.dashboard import wire
from mesa_mobility.dashboard.behaviours import Behaviours, ChoiceState, TermState
from mesa_mobility.dashboard.colouring import COLOURINGS
from mesa_mobility.dashboard.decision import described
from mesa_mobility.dashboard.feed import Feed
from mesa_mobility.dashboard.observer import Observer
from mesa_mobility.dashboard.plan_changes import PlanChanges

FULL_SPEED = 0.0
"""Speed that stands for "as fast as it goes"."""

FRAME_INTERVAL = 1.0 / 30.0
"""Least time between two frames for the canvas, seconds; it draws what lies between by itself."""

DECISION_INTERVAL = 0.2
SERIES_INTERVAL = 1.0
"""Least times between decisions, and between drawings of the charts, seconds."""

AS_TAKEN, IF_NOW = "as taken", "if it decided now"
"""What is told of the selected person: its last decision, or the one it would take now."""

UNDER_WAY = 2
"""Frames sent that the page has not yet answered, at most: one that is slow gets fewer."""

RESEND = 0.5
"""Seconds after which the next frame is sent all the same."""

PATIENCE = 5.0
"""Seconds without an answer from the page after which a run waits for it: nobody is looking."""

Command = Callable[[], None]

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Recipe:
    """How to make a model.

    Attributes:
        kind: its class.
        keywords: what its constructor gets.
    """

    kind: type[PedestrianModel]
    keywords: Mapping[str, Any] = field(default_factory=dict)

    def make(self) -> PedestrianModel:
        """The model."""
        return self.kind(**self.keywords)


@dataclass(frozen=True)
class Status:
    """What the page says of a run.

    Attributes:
        state: "building", "ready", "playing", "finished", "stalled" or "failed".
        elapsed: simulated seconds.
        inside: people inside.
        pace: simulated seconds in a second, while playing.
    """

    state: str = "building"
    elapsed: float = 0.0
    inside: int = 0
    pace: float = 0.0


class Session:
    """A model, the thread that advances it, and what the page shows of it.

    What changes many times a second is a ``Feed``; the rest is reactive: components that read it
    are drawn anew when it changes.

    Attributes:
        recipe: ``Recipe`` of the model that runs, or None.
        status: ``Status``, each second and when it changes.
        frame: the crowd as the canvas draws it.
        floor: the floor plan as the canvas draws it.
        behaviours: ``TermState`` of each cost term.
        choice: ``ChoiceState`` of who goes where.
        series: a number that grows, and the ``Observer`` of the run; each second.
        decision: the decision of the selected person as its view draws it, or {}.
        types: the pedestrian types of the model that runs.
        selected: row of the person whose decisions are told, or -1.
        problem: what the last command or step ran into, or "".
    """

    def __init__(self) -> None:
        self.recipe: solara.Reactive[Recipe | None] = solara.reactive(None)
        self.status = solara.reactive(Status())
        self.frame = Feed("frame")
        self.floor: solara.Reactive[dict[str, Any]] = solara.reactive({})
        self.behaviours: solara.Reactive[tuple[TermState, ...]] = solara.reactive(())
        self.choice = solara.reactive(ChoiceState("", ()))
        self.series: solara.Reactive[tuple[int, Observer | None]] = solara.reactive((0, None))
        self.decision = Feed("decision")
        self.types: solara.Reactive[tuple[PedestrianType, ...]] = solara.reactive(())
        self.selected = solara.reactive(-1)
        self.problem = solara.reactive("")
        self._commands: queue.SimpleQueue[Command | None] = queue.SimpleQueue()
        self._model: PedestrianModel | None = None
        self._terms = Behaviours()
        self._playing = self._failed = self._until_decision = self._hypothetical = False
        self._speed = 1.0
        self._colouring = COLOURINGS["speed"]
        self._run = self._sent = self._seen = self._series_number = 0
        self._shown: Explanation | None = None
        self._frame_at = self._series_at = self._decision_at = 0.0
        self._due = self._pace = self._pace_at = self._pace_from = 0.0
        self._closed = False
        # Made where the page is drawn: Solara has such a thread publish to that page.
        self._thread = threading.Thread(target=self._work, name="mesa-mobility page", daemon=True)

    # -- what the page asks for; all of it returns at once --------------------------------------

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def close(self) -> None:
        """End the thread, after the step that it is in."""
        self._closed = True
        self._commands.put(None)

    def build(self, recipe: Recipe, answer: Callable[[str], None] | None = None) -> None:
        """Start a model anew; if it cannot be made, the run that there is goes on.

        Args:
            recipe: how to make the model.
            answer: called with what is wrong with the recipe, or "".
        """

        def command() -> None:
            said = ""
            try:
                self._take(recipe)
            # A plug-in may fail in any way; the run that there is must not.
            except Exception as error:
                said = _said(error)
            if answer is not None:
                answer(said)
            elif said:
                self.problem.set(said)

        self.status.set(Status("building", self.status.peek().elapsed, self.status.peek().inside))
        self._commands.put(command)

    def reset(self) -> None:
        """Start the same model anew, doors and obstacles as at first; behaviours stay."""
        recipe = self.recipe.peek()
        if recipe is not None:
            self.build(recipe)

    def post(self, command: Callable[[PedestrianModel], None]) -> None:
        """Have the thread do something with the model, between two steps."""

        def guarded() -> None:
            if self._model is None:
                return
            self.problem.set("")
            try:
                command(self._model)
            except Exception as error:
                self.problem.set(_said(error))

        self._commands.put(guarded)

    def play(self, playing: bool) -> None:
        """Let time go by, or not."""

        def command(_: PedestrianModel) -> None:
            self._set_playing(playing)

        self.post(command)

    def step(self) -> None:
        """One step, and stop."""

        def command(_: PedestrianModel) -> None:
            self._set_playing(False)
            self._step()

        self.post(command)

    def play_to_decision(self) -> None:
        """Go on until the selected person decides, and stop there."""

        def command(_: PedestrianModel) -> None:
            self._set_playing(True)
            self._until_decision = True

        self.post(command)

    def set_speed(self, speed: float) -> None:
        """Simulated seconds in a second, or ``FULL_SPEED``."""

        def command(_: PedestrianModel) -> None:
            self._speed = speed
            self._due = time.perf_counter()

        self.post(command)

    def colour_by(self, name: str) -> None:
        """Colour people by one of ``COLOURINGS``."""

        def command(_: PedestrianModel) -> None:
            self._colouring = COLOURINGS[name]

        self.post(command)

    def select(self, row: int) -> None:
        """Tell the decisions of the person in ``row``; nobody's if it is negative."""

        def command(model: PedestrianModel) -> None:
            model.watch = Watch(row) if row >= 0 else None
            self._shown = None
            self.decision.set({})
            self.selected.set(row)

        self.post(command)

    def tell(self, what: str) -> None:
        """Tell decisions "as taken", or each moment the one "if it decided now"."""

        def command(_: PedestrianModel) -> None:
            self._hypothetical = what == IF_NOW
            self._shown = None

        self.post(command)

    def set_behaviour(self, name: str, on: bool, weight: float) -> None:
        """Switch a behaviour on or off, with a weight; from the next decision on."""

        def command(model: PedestrianModel) -> None:
            self._terms.set(model, name, on, weight)
            self.behaviours.set(self._terms.states(model))

        self.post(command)

    def choose_targets_by(self, name: str) -> None:
        """Have another behaviour choose where people go; from each one's next decision on."""

        def command(model: PedestrianModel) -> None:
            self._terms.choose(model, name)
            self.choice.set(self._terms.choice(model))

        self.post(command)

    def toggle_opening(self, name: str) -> None:
        """Close a door or exit that is open, open one that is closed."""

        def command(_: PedestrianModel) -> None:
            self._plan.toggle_opening(name)
            self.floor.set(self._plan.drawn())

        self.post(command)

    def toggle_obstacle(self, number: int) -> None:
        """Take an obstacle away, or bring it back."""

        def command(_: PedestrianModel) -> None:
            self._plan.toggle_obstacle(number)
            self.floor.set(self._plan.drawn())

        self.post(command)

    def seen(self, number: int) -> None:
        """The page has got frame ``number``."""
        self._seen = number

    # -- the thread -----------------------------------------------------------------------------

    def _work(self) -> None:
        while not self._closed:
            command = self._next()
            if command is None:
                return
            try:
                command()
                self._show(always=command != self._step or not self._playing)
            except Exception:
                # Nobody is there any more for whom to publish.
                if self._closed:
                    return
                raise

    def _next(self) -> Command | None:
        """The next command, or the next step when it is due; None to end."""
        while True:
            now, wait = time.perf_counter(), None
            nobody_looks = self._sent > self._seen and now - self._frame_at > PATIENCE
            if self._playing:
                wait = 0.2 if nobody_looks else max(self._due - now, 0.0)
            try:
                return self._commands.get(timeout=wait)
            except queue.Empty:
                if not nobody_looks:
                    return self._step

    def _take(self, recipe: Recipe) -> None:
        model = recipe.make()
        before = self.recipe.peek()
        same = before is not None and (before.kind, before.keywords.get("preset")) == (
            recipe.kind, recipe.keywords.get("preset"),
        )  # fmt: skip
        self._model = model
        self._observer = Observer(model)
        self._plan = PlanChanges(model)
        self._terms.adopt(model, keep=same)
        self._run += 1
        self._shown = None
        self._failed = False
        self._set_playing(False)
        self.recipe.set(recipe)
        self.problem.set("")
        self.decision.set({})
        self.selected.set(-1)
        self.types.set(model.pedestrian_types)
        self.floor.set(self._plan.drawn())
        self.behaviours.set(self._terms.states(model))
        self.choice.set(self._terms.choice(model))

    def _set_playing(self, playing: bool) -> None:
        model = self._model
        self._playing = playing and model is not None and model.running and not self._failed
        self._until_decision = False
        self._due = self._pace_at = time.perf_counter()
        self._pace = 0.0
        self._pace_from = 0.0 if model is None else model.elapsed

    def _step(self) -> None:
        model = self._model
        if model is None or not model.running or self._failed:
            self._set_playing(False)
            return
        watched = None if model.watch is None else model.watch.decision
        before = model.elapsed
        try:
            model.step()
            self._observer.after_step()
        # A term of somebody's own may fail in any way, and is being written here.
        except Exception as error:
            self._failed = True
            self._set_playing(False)
            self.problem.set(_said(error))
            return
        if self._speed != FULL_SPEED:
            # What a slow step has lost is not made up for beyond a moment.
            late = time.perf_counter() - 0.2
            self._due = max(self._due + (model.elapsed - before) / self._speed, late)
        if not model.running:
            self._set_playing(False)
        elif self._until_decision and model.watch is not None:
            inside = model.crowd.active[model.watch.pedestrian]
            if model.watch.decision is not watched or not inside:
                self._set_playing(False)

    def _show(self, always: bool) -> None:
        """Publish what is due; everything if ``always``."""
        model, now = self._model, time.perf_counter()
        if self._closed or model is None:
            return
        heard = self._sent - self._seen < UNDER_WAY or now - self._frame_at > RESEND
        if always or (heard and now - self._frame_at >= FRAME_INTERVAL):
            self._sent, self._frame_at = self._sent + 1, now
            self.frame.set(
                wire.frame(model, self._colouring, self._observer, run=self._run, number=self._sent)
            )
        if always or now - self._series_at >= SERIES_INTERVAL:
            self._series_at = now
            self._series_number += 1
            self.status.set(self._status(model, now))
            self.series.set((self._series_number, self._observer))
        if always or now - self._decision_at >= DECISION_INTERVAL:
            self._decision_at = now
            self._tell_decision(model)

    def _status(self, model: PedestrianModel, now: float) -> Status:
        state = "ready"
        if self._failed:
            state = "failed"
        elif self._playing:
            state = "playing"
        elif not model.running:
            state = "stalled" if model.stalled else "finished"
        if self._playing and now - self._pace_at >= SERIES_INTERVAL / 2:
            self._pace = (model.elapsed - self._pace_from) / (now - self._pace_at)
            self._pace_at, self._pace_from = now, model.elapsed
        return Status(state, model.elapsed, model.inside, self._pace)

    def _tell_decision(self, model: PedestrianModel) -> None:
        if model.watch is None:
            return
        row, told = model.watch.pedestrian, model.watch.decision
        inside = bool(model.crowd.active[row])
        if inside and (told is None or self._hypothetical):
            if self._shown is not None and self._shown.frame == model.frame:
                return
            told = model.explain(row)
        if told is not None and told is not self._shown:
            self._shown = told
            self.decision.set(described(told, model))


def _said(error: Exception) -> str:
    """An error as one line for the page; the log has where it comes from."""
    if isinstance(error, MobilityError):
        return str(error)
    log.exception("in a model or a behaviour")
    return f"{type(error).__name__}: {' '.join(str(error).split())}"
