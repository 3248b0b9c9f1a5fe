"""One reader's run: a model, and the one thread that touches it.

The page never calls the model: it hands the thread commands, and shows what the thread has
published.  So the page answers at once however long a step takes, and nothing needs a lock.
"""

from __future__ import annotations

import logging
import queue
import threading
from collections.abc import Callable

from mesa_mobility import MobilityError, PedestrianModel
from mesa_mobility.crowd import Watch
from mesa_mobility.dashboard.behaviours import Behaviours
from mesa_mobility.dashboard.clock import Clock
from mesa_mobility.dashboard.colouring import COLOURINGS
from mesa_mobility.dashboard.observer import Observer
from mesa_mobility.dashboard.plan_changes import PlanChanges
from mesa_mobility.dashboard.recipe import Recipe
from mesa_mobility.dashboard.shown import Shown, Status

AS_TAKEN, IF_NOW = "as taken", "if it decided now"
"""What is told of the selected person: its last decision, or the one it would take now."""

Command = Callable[[], None]

log = logging.getLogger(__name__)


class Session(Shown):
    """A model, the thread that advances it, and what the page shows of it."""

    def __init__(self) -> None:
        super().__init__()
        self._commands: queue.SimpleQueue[Command | None] = queue.SimpleQueue()
        self._model: PedestrianModel | None = None
        self._terms = Behaviours()
        self._clock = Clock()
        self._failed = self._until_decision = self._closed = False
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
                made = recipe.make()
                observer, plan = Observer(made), PlanChanges(made)
            # A plug-in may fail in any way; the run that there is must not.
            except Exception as error:
                said = _said(error)
            with self.together:
                if not said:
                    self._take(recipe, made, observer, plan)
                if answer is not None:
                    answer(said)
                elif said:
                    self.problem.set(said)
            self._publish()

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
            self._publish()

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
            self._clock.set_speed(speed)

        self.post(command)

    def colour_by(self, name: str) -> None:
        """Colour people by one of ``COLOURINGS``."""

        def command(_: PedestrianModel) -> None:
            self.colouring = COLOURINGS[name]

        self.post(command)

    def select(self, row: int) -> None:
        """Tell the decisions of the person in ``row``; nobody's if it is negative."""

        def command(model: PedestrianModel) -> None:
            model.watch = Watch(row) if row >= 0 else None
            self.mark(row)

        self.post(command)

    def tell(self, what: str) -> None:
        """Tell decisions "as taken", or each moment the one "if it decided now"."""

        def command(_: PedestrianModel) -> None:
            self.hypothetical = what == IF_NOW
            self.forget_decision()

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

    # -- the thread -----------------------------------------------------------------------------

    def _work(self) -> None:
        while not self._closed:
            command = self._next()
            if command is None:
                return
            try:
                command()
            except Exception:
                # Nobody is there any more for whom to publish.
                if self._closed:
                    return
                raise

    def _next(self) -> Command | None:
        """The next command, or the next step when it is due; None to end."""
        while True:
            wait, held = None, self.nobody_looks()
            if self._clock.playing:
                wait = 0.2 if held else self._clock.wait()
            try:
                return self._commands.get(timeout=wait)
            except queue.Empty:
                if not held:
                    return self._advance

    def _advance(self) -> None:
        self._step()
        self._publish(always=not self._clock.playing)

    def _publish(self, always: bool = True) -> None:
        """Show what is due, or everything."""
        model = self._model
        if model is None or self._closed:
            return
        state = "ready"
        if self._failed:
            state = "failed"
        elif self._clock.playing:
            state = "playing"
        elif not model.running:
            state = "stalled" if model.stalled else "finished"
        self._clock.measure(model.elapsed)
        status = Status(state, model.elapsed, model.inside, self._clock.pace)
        self.show(model, self._observer, status, always=always)

    def _take(
        self, recipe: Recipe, model: PedestrianModel, observer: Observer, plan: PlanChanges
    ) -> None:
        before = self.recipe.peek()
        same = before is not None and (before.kind, before.keywords.get("preset")) == (
            recipe.kind, recipe.keywords.get("preset"),
        )  # fmt: skip
        self._model, self._observer, self._plan = model, observer, plan
        self._terms.adopt(model, keep=same)
        self._failed = False
        self._set_playing(False)
        self.show_new(recipe, model, plan, self._terms)

    def _set_playing(self, playing: bool) -> None:
        model = self._model
        possible = model is not None and model.running and not self._failed
        self._until_decision = False
        self._clock.set_playing(playing and possible, 0.0 if model is None else model.elapsed)

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
        self._clock.stepped(model.elapsed - before)
        if not model.running:
            self._set_playing(False)
        elif self._until_decision and model.watch is not None:
            inside = model.crowd.active[model.watch.pedestrian]
            if model.watch.decision is not watched or not inside:
                self._set_playing(False)


def _said(error: Exception) -> str:
    """An error as one line for the page; the log has where it comes from."""
    if isinstance(error, MobilityError):
        return str(error)
    log.exception("in a model or a behaviour")
    return f"{type(error).__name__}: {' '.join(str(error).split())}"
