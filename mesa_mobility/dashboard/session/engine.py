"""The thread that alone uses a page's model."""

from __future__ import annotations

import logging
import queue
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import replace

import solara
from solara.server import kernel_context

from mesa_mobility import MobilityError, PedestrianModel
from mesa_mobility.dashboard.session import kept
from mesa_mobility.dashboard.session.behaviours import Behaviours
from mesa_mobility.dashboard.session.notices import hear
from mesa_mobility.dashboard.session.observer import Observer
from mesa_mobility.dashboard.session.plan_changes import PlanChanges
from mesa_mobility.dashboard.session.run import Run
from mesa_mobility.dashboard.session.run_config import Making, Recipe
from mesa_mobility.dashboard.session.view_state import Shown, Status
from mesa_mobility.live.clock import Clock

Command = Callable[[], None]
Answer = Callable[[str], None]

log = logging.getLogger(__name__)

QUIET = 0.25
"""Seconds that a wish for a model waits for the next one, if another came as shortly before it."""


class Engine(Shown):
    """A thread that makes models, runs one, and publishes what the page shows.

    Args:
        behaviours: name -> (on, weight) of those that differ from a model's initial ones.
        choice: name of the target choice, or "" for the model's own.

    Attributes:
        key: the run's key in the page's address.
        set_behaviours: name -> (on, weight) of behaviours that have been changed.
        set_choice: name of the target choice if it has been changed, or "".
        speed: simulated seconds in a second.
        making: seconds for which a model has been in the making, or -1.
    """

    def __init__(
        self, behaviours: Mapping[str, tuple[bool, float]] | None = None, choice: str = ""
    ) -> None:
        super().__init__()
        self.key = solara.reactive("")
        self.set_behaviours: solara.Reactive[dict[str, tuple[bool, float]]] = solara.reactive({})
        self.set_choice = solara.reactive("")
        self.speed = solara.reactive(1.0)
        self.making = solara.reactive(-1.0)
        self._commands: queue.SimpleQueue[Command | None] = queue.SimpleQueue()
        self._current: Run | None = None
        self._left: Run | None = None
        self._key = ""
        self._terms, self._clock = Behaviours(), Clock()
        self._terms.wanted.update(behaviours or {})
        self._terms.wanted_choice = choice
        self._closed = False
        self._wanted = self._begun = 0
        self._wanted_at = -QUIET
        self._given_up = threading.Event()
        known = kernel_context.has_current_context()
        self._page = kernel_context.get_current_context() if known else None
        # Created while the page is rendered, so that Solara lets the thread publish to that page.
        self._thread = threading.Thread(target=self._work, name="mesa-mobility page", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def close(self) -> None:
        """End the thread after the current step; the run is kept for a while."""
        self._closed = True
        self._given_up.set()
        self._commands.put(None)

    def join(self) -> None:
        """Wait until the thread has ended."""
        self._thread.join()

    def watched(self) -> bool:
        """Whether a browser shows the page."""
        connected = kernel_context.PageStatus.CONNECTED
        return self._page is not None and connected in list(self._page.page_status.values())

    def _work(self) -> None:
        hear(self._notice)
        try:
            while not self._closed:
                command = self._next()
                if command is None:
                    return
                try:
                    command()
                except Exception:
                    # There is no page to publish to.
                    if self._closed:
                        return
                    raise
        finally:
            if self._current is not None:
                self._current.hand.release()
            if self._key:
                kept.leave(self._key, self._current or self._left)

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
        if self._current is not None:
            try:
                self._current.step()
            # A user's term may fail in any way, especially while it is being written.
            except Exception as error:
                self.problem.set(said(error))
        self._publish(always=not self._clock.playing)

    def _publish(self, always: bool = True) -> None:
        """Publish what is due, or everything."""
        run = self._current
        if self._closed:
            return
        status = Status() if run is None else run.status()
        if self._begun != self._wanted:
            status = replace(status, state="building")
        if run is None:
            self.status.set(status)
        else:
            self.show(run.model, run.observer, status, always=always)

    def _want(self, command: Command) -> None:
        """Make a model; give up one that is still being made."""
        before, self._wanted_at = self._wanted_at, time.monotonic()
        hasty = self._wanted_at - before < QUIET
        self._wanted += 1
        number = self._wanted
        shown = self.status.peek()
        self.status.set(Status("building", shown.elapsed, shown.inside))
        self._given_up.set()

        def unless_superseded() -> None:
            self._given_up.clear()
            # Of wishes in quick succession the last one alone is made.
            if hasty:
                self._given_up.wait(QUIET)
            if number == self._wanted:
                self._begun = number
                command()

        self._commands.put(unless_superseded)

    def _make(self, recipe: Recipe, answer: Answer | None) -> None:
        problem, run = "", None
        try:
            making = Making(recipe)
            model = self._wait_for(making)
            if model is not None:
                seen, plan = Observer(model), PlanChanges(model)
                run = Run(recipe, model, seen, plan, self._terms, self._clock)
                run.notices = making.notices
        # A plug-in may fail in any way, which must not affect the current run.
        except Exception as error:
            problem = said(error)
        with self.together:
            self.making.set(-1.0)
            if run is not None:
                self._take(run)
            if answer is not None and (run is not None or problem):
                answer(problem)
            elif problem:
                self.problem.set(problem)
        self._publish()

    def _wait_for(self, making: Making) -> PedestrianModel | None:
        """The model, or None if it is given up."""
        started = updated = time.monotonic()
        while not making.done.wait(0.05):
            if self._given_up.is_set() or self._closed:
                making.give_up()
                return None
            if time.monotonic() - updated >= 1.0:
                updated = time.monotonic()
                self.making.set(updated - started)
        return making.model()

    def _take(self, run: Run) -> None:
        """Show a run in place of the current one."""
        before = self._current
        kind, preset = run.recipe.kind, run.recipe.keywords.get("preset")
        known = None if before is None else before.recipe
        same = known is None or (known.kind, known.keywords.get("preset")) == (kind, preset)
        self._current = run
        self._terms.adopt(run.model, keep=same)
        run.set_playing(False)
        self._show_run(run)

    def _go_on_with(self, run: Run, answer: Answer | None) -> None:
        """Show a run that another page has left, as it was left."""
        wanted, choice = self._terms.wanted, self._terms.wanted_choice
        self._current, self._terms, self._clock = run, run.terms, run.clock
        self._terms.wanted.update(wanted)
        self._terms.wanted_choice = choice or self._terms.wanted_choice
        with self.together:
            self._terms.apply(run.model)
            self._show_run(run)
            self.speed.set(run.clock.speed)
            if run.model.watch is not None:
                self.mark(run.model.watch.pedestrian)
            if answer is not None:
                answer("")
        self._publish()

    def _notice(self, warning: str) -> None:
        """Show a warning of the current model."""
        if self._current is not None and warning not in self._current.notices:
            self._current.notices.append(warning)
            self.notices.set(tuple(self._current.notices))

    def _show_run(self, run: Run) -> None:
        self.show_new(run.recipe, run.model, run.plan)
        self.notices.set(tuple(run.notices))
        self._show_terms(run.model)

    def _show_terms(self, model: PedestrianModel) -> None:
        self.behaviours.set(self._terms.states(model))
        self.choice.set(self._terms.choice(model))
        self.set_behaviours.set(dict(self._terms.wanted))
        self.set_choice.set(self._terms.wanted_choice)


def said(error: Exception) -> str:
    """An error as one line for the page; the log has its traceback."""
    if isinstance(error, MobilityError):
        return str(error)
    if isinstance(error, MemoryError):
        return "the model needs more memory than there is"
    log.exception("in a model or a behaviour")
    return f"{type(error).__name__}: {' '.join(str(error).split())}"
