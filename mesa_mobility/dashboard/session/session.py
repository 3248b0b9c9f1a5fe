"""One reader's run: a model, and the one thread that touches it.

The page never calls the model: it hands the thread commands, and shows what the thread has
published.  So the page answers at once however long a step takes, and nothing needs a lock.
"""

from __future__ import annotations

from collections.abc import Callable

from mesa_mobility.crowd import Watch
from mesa_mobility.dashboard.session import kept
from mesa_mobility.dashboard.session.engine import Answer, Engine, said
from mesa_mobility.dashboard.session.run import Run
from mesa_mobility.dashboard.session.run_config import Recipe
from mesa_mobility.errors import ModelError

AS_TAKEN, IF_NOW = "as taken", "if they decided now"
"""Which decision of the selected person is shown: their last, or one that they would take now."""


NOBODY = -1
"""Row of no person."""


class Session(Engine):
    """The commands of a page to its model; each returns at once."""

    def enter(self, key: str) -> None:
        """Take over the run of a key, if there is one; before anything is built.

        Args:
            key: from the page's address, or "".
        """

        def command() -> None:
            self._key, self._left = kept.enter(key, self)
            self.key.set(self._key)

        self._commands.put(command)

    def build(self, recipe: Recipe, answer: Answer | None = None) -> None:
        """Make a new model; if that fails, the current run continues.

        A run that has been taken over goes on if it was made so.

        Args:
            recipe: how to make it.
            answer: called with what is wrong with the recipe, or "".
        """

        def command() -> None:
            run, self._left = self._left, None
            if run is not None and run.recipe == recipe:
                self._go_on_with(run, answer)
            else:
                self._make(recipe, answer)

        self._want(command)

    def give_up(self) -> None:
        """Cancel the making of a model; the current run continues."""
        self._given_up.set()

    def reset(self) -> None:
        """Start the same model anew, doors and obstacles as at first; behaviours stay."""
        recipe = self.recipe.peek()
        if recipe is not None:
            self.build(recipe)

    def post(self, command: Callable[[Run], None], shown: int | None = None) -> None:
        """Execute a command on the run in the thread, between two steps.

        Args:
            command: called with the run.
            shown: number of the run that the page showed when the command was given. Nothing is
                done if the run is another by now, with other people and doors.
        """

        def guarded() -> None:
            if self._current is None or shown not in (None, self.run_number):
                return
            self.problem.set("")
            try:
                command(self._current)
            except Exception as error:
                self.problem.set(said(error))
            self._publish()

        self._commands.put(guarded)

    def play(self, playing: bool) -> None:
        """Let time go by, or not."""
        self.post(lambda run: run.set_playing(playing))

    def step(self) -> None:
        """One step, and stop."""

        def command(run: Run) -> None:
            run.set_playing(False)
            run.step()

        self.post(command)

    def play_to_decision(self) -> None:
        """Go on until the selected person decides, and stop there."""

        def command(run: Run) -> None:
            run.set_playing(True)
            run.until_decision = True

        self.post(command)

    def set_speed(self, speed: float) -> None:
        """Simulated seconds in a second, or ``FULL_SPEED``."""
        self.speed.set(speed)
        self._commands.put(lambda: self._clock.set_speed(speed))

    def colour_by(self, name: str) -> None:
        """Colour people by one of ``colourings``."""

        def command() -> None:
            self.use_colour(name, None if self._current is None else self._current.model)
            self._publish()

        self._commands.put(command)

    def show_bodies(self, on: bool) -> None:
        """Send what the three-dimensional view needs, or not."""

        def command() -> None:
            self.use_bodies(on, None if self._current is None else self._current.model)
            self._publish()

        self._commands.put(command)

    def select(self, row: int, shown: int | None = None) -> None:
        """Show the decisions of the person in ``row``; of nobody if ``row`` is negative.

        The page says so if the model never had such a person. For ``shown`` see `post`.
        """

        def command(run: Run) -> None:
            most = run.model.population.count - 1
            if row > most:
                raise ModelError(f"person: got {row}, expected at most {most}")
            self._watch(run, row)

        self.post(command, shown)

    def select_beside(self, by: int, shown: int | None = None) -> None:
        """Select the person inside with the next higher number, or the next lower one.

        The first follows the last. If nobody is selected, higher numbers begin with the first, and
        lower ones with the last.

        Args:
            by: 1 for higher, -1 for lower numbers.
            shown: see `post`.
        """

        def command(run: Run) -> None:
            rows, now = run.model.rows, self.selected.peek()
            if len(rows) == 0:
                return
            beyond = rows[rows > now] if by > 0 else rows[rows < now]
            among = beyond if len(beyond) else rows
            self._watch(run, int(among.min() if by > 0 else among.max()))

        self.post(command, shown)

    def _watch(self, run: Run, row: int) -> None:
        run.model.watch = Watch(row) if row >= 0 else None
        if row != run.hand.row:
            run.hand.release()
        self.mark(row)

    def steer(
        self, row: int, direction: tuple[float, float] | None, shown: int | None = None
    ) -> None:
        """Let somebody walk in a direction at their preferred speed, and others make way.

        Args:
            row: the person.
            direction: (0, 0) to stand; None to go on as before.
            shown: see `post`.
        """

        def command(run: Run) -> None:
            if direction is None:
                run.hand.release()
            else:
                run.hand.steer(row, direction)

        self.post(command, shown)

    def tell(self, what: str) -> None:
        """Show decisions "as taken", or continually the one "if they decided now"."""

        def command(_: Run) -> None:
            self.hypothetical = what == IF_NOW
            self.forget_decision()

        self.post(command)

    def set_behaviour(self, name: str, on: bool, weight: float) -> None:
        """Switch a behaviour on or off, with a weight; from the next decision on."""

        def command(run: Run) -> None:
            self._terms.set(run.model, name, on, weight)
            self._show_terms(run.model)

        self.post(command)

    def choose_targets_by(self, name: str) -> None:
        """Have another behaviour choose where people go; from each one's next decision on."""

        def command(run: Run) -> None:
            self._terms.choose(run.model, name)
            self._show_terms(run.model)

        self.post(command)

    def toggle_opening(self, name: str, shown: int | None = None) -> None:
        """Close a door or exit that is open, open one that is closed; for ``shown`` see `post`."""

        def command(run: Run) -> None:
            run.plan.toggle_opening(name)
            self.show_floor(run.plan)

        self.post(command, shown)

    def toggle_obstacle(self, number: int, shown: int | None = None) -> None:
        """Take an obstacle away, or bring it back; for ``shown`` see `post`."""

        def command(run: Run) -> None:
            run.plan.toggle_obstacle(number)
            self.show_floor(run.plan)

        self.post(command, shown)
