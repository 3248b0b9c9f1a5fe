"""A running model, with its clock and its observers."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from mesa_mobility import PedestrianModel
from mesa_mobility.dashboard.session.behaviours import Behaviours
from mesa_mobility.dashboard.session.observer import Observer
from mesa_mobility.dashboard.session.plan_changes import PlanChanges
from mesa_mobility.dashboard.session.run_config import Recipe
from mesa_mobility.dashboard.session.view_state import Status
from mesa_mobility.live.clock import Clock
from mesa_mobility.live.order_tactics import follow_orders
from mesa_mobility.live.orders import Orders

ALL_CLOSED = "every exit is closed"
NO_WAY = "for a minute nobody has left or come nearer to an exit"


@dataclass
class Run:
    """A model under way.

    Attributes:
        recipe: how the model was made.
        model: the model.
        observer: collects the figures of the charts.
        plan: changes of the floor plan by clicks.
        terms: the behaviours in use.
        clock: when the next step is due.
        failed: whether a step has raised an error; no further step follows.
        hand: the steering of somebody with keys.
        until_decision: whether the run pauses when the watched person has decided.
        notices: the warnings that the model has given.
    """

    recipe: Recipe
    model: PedestrianModel
    observer: Observer
    plan: PlanChanges
    terms: Behaviours
    clock: Clock
    failed: bool = False
    until_decision: bool = False
    notices: list[str] = field(default_factory=list)
    hand: ByHand = field(init=False)

    def __post_init__(self) -> None:
        self.hand = ByHand(self.model)

    def set_playing(self, playing: bool) -> None:
        """Play or pause; a run that is over stays so."""
        self.until_decision = False
        self.clock.set_playing(playing and self._goes_on(), self.model.elapsed)

    def _goes_on(self) -> bool:
        """Whether another step is possible, now that somebody asks for it.

        A run that has stalled gets another minute: a door, an obstacle, a weight, a behaviour or a
        hand on the keys may have changed what kept people, and nobody has to say which.
        """
        if self.model.stalled:
            self.model.go_on()
        return self.model.running and not self.failed

    def step(self) -> None:
        """Advance the model by one step, unless it is over.

        Raises:
            Exception: whatever the model has raised; it has failed then.
        """
        model = self.model
        if not self._goes_on():
            self.set_playing(False)
            return
        watched = None if model.watch is None else model.watch.decision
        before = model.elapsed
        try:
            model.step()
            self.observer.after_step()
        except Exception:
            self.failed = True
            self.set_playing(False)
            raise
        self.clock.stepped(model.elapsed - before)
        if not model.running:
            self.set_playing(False)
        elif self.until_decision and model.watch is not None:
            inside = model.crowd.active[model.watch.pedestrian]
            if model.watch.decision is not watched or not inside:
                self.set_playing(False)

    def status(self) -> Status:
        """The status that the page shows."""
        model, clock = self.model, self.clock
        state = "ready"
        if self.failed:
            state = "failed"
        elif clock.playing:
            state = "playing"
        elif not model.running:
            state = "stalled" if model.stalled else "finished"
        reason, plan = "", model.floor_plan
        if model.inside and plan.exits and not plan.open_exits():
            reason = ALL_CLOSED
        elif state == "stalled":
            reason = NO_WAY
        clock.measure(model.elapsed)
        blocked = tuple((each.person, each.ring) for each in model.blocked)
        return Status(state, model.elapsed, model.inside, clock.pace, reason, blocked)


class ByHand:
    """Steering of a model's people, one at a time.

    A model gets the tactics for steering when somebody is first steered. Until then it is as it was
    made.

    Args:
        model: the model.

    Attributes:
        row: of the person who is steered, or -1.
    """

    def __init__(self, model: PedestrianModel) -> None:
        self.row = -1
        self._model = model
        self._orders: Orders | None = None

    def steer(self, row: int, direction: tuple[float, float]) -> None:
        """Let somebody walk in a direction at their preferred speed, or stand for (0, 0).

        Whoever was steered before goes on as before. Nobody is steered who is not inside.
        """
        if row != self.row:
            self.release()
        model, length = self._model, math.hypot(*direction)
        if not (0 <= row < model.population.count and model.crowd.active[row]):
            return
        if not math.isfinite(length):
            return
        if self._orders is None:
            self._orders = follow_orders(model)
        speed = float(model.crowd.agenda["speed"][row]) / length if length else 0.0
        self._orders.steer(np.array([row]), (speed * direction[0], speed * direction[1]))
        self.row = row

    def release(self) -> None:
        """Let the person who is steered go on as before."""
        row, self.row = self.row, -1
        if self._orders is not None and row >= 0 and self._model.crowd.active[row]:
            self._orders.release(np.array([row]))
