"""A model under command, and the thread that alone uses it."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Hashable
from concurrent.futures import Future
from contextlib import suppress
from typing import Any, TypeAlias

import numpy as np

from mesa_mobility.crowd import PedestrianModel
from mesa_mobility.errors import LiveError
from mesa_mobility.live.clock import Clock
from mesa_mobility.live.order_tactics import follow_orders
from mesa_mobility.live.snapshot import Camera, Snapshot

FRAMES_A_SECOND = 30


class Run:
    """A model under command.

    Args:
        model: the model; it gets the tactics by which people follow orders.
        rate: steps, and frames published, in a simulated second.

    Attributes:
        model: the model.
        orders: what its people are told.
        clock: when the next step is due.

    Raises:
        LiveError: a rate that does not divide 30.
    """

    def __init__(self, model: PedestrianModel, rate: int = FRAMES_A_SECOND) -> None:
        if rate < 1 or FRAMES_A_SECOND % rate:
            raise LiveError(f"rate: got {rate}, expected 1, 2, 3, 5, 6, 10, 15 or 30 frames/s")
        self.model = model
        self.orders = follow_orders(model)
        self.clock = Clock()
        self._steered_by: dict[int, Hashable] = {}
        model.frames_per_step = FRAMES_A_SECOND // rate

    def set_playing(self, playing: bool) -> None:
        """Let time go by, or not."""
        if playing != self.clock.playing:
            self.clock.set_playing(playing, self.model.elapsed)

    def step(self) -> None:
        """Advance the model by one step; time goes on where nobody is inside."""
        before = self.model.elapsed
        self.model.step()
        self.clock.stepped(self.model.elapsed - before)

    def hold(self, client: Hashable, people: list[int]) -> None:
        """Note who steers people."""
        self._steered_by.update(dict.fromkeys(people, client))

    def drop(self, client: Hashable) -> None:
        """Let those whom a client steers go on as before: it is gone."""
        own = [row for row, whose in self._steered_by.items() if whose == client]
        steered = self.orders.steered()
        self.orders.release(steered[np.isin(steered, own)])
        for row in own:
            del self._steered_by[row]


Command: TypeAlias = Callable[[Run], dict[str, Any]]


class Engine:
    """The thread that steps a model in real time and executes commands between steps.

    Args:
        run: the model; from ``start`` on no other thread may use it.
        rate: frames published in a simulated second.
        publish: called in the thread with each snapshot.
        failed: called in the thread with what a step has raised; it ends then.
    """

    def __init__(
        self,
        run: Run,
        rate: int,
        publish: Callable[[Snapshot], None],
        failed: Callable[[Exception], None],
    ) -> None:
        self._run = run
        self._camera = Camera(run.model, rate)
        self._published, self._failed = publish, failed
        self._jobs: queue.SimpleQueue[tuple[Command, Future[dict[str, Any]]] | None] = (
            queue.SimpleQueue()
        )
        self._closed = self._ended = False
        self._thread = threading.Thread(target=self._work, name="mesa-mobility live", daemon=True)

    def start(self) -> None:
        """Start the thread; time stands still until a command lets it go by."""
        self._thread.start()

    def close(self) -> None:
        """End the thread after the current step."""
        self._closed = True
        self._jobs.put(None)

    def join(self, seconds: float | None = None) -> None:
        """Wait until the thread has ended, for so long at most."""
        self._thread.join(seconds)

    def post(self, command: Command) -> Future[dict[str, Any]]:
        """Execute a command between two steps; its answer or what it has raised follows.

        After the thread has ended the answer is cancelled.
        """
        answer: Future[dict[str, Any]] = Future()
        self._jobs.put((command, answer))
        if self._ended:
            self._cancel_jobs()
        return answer

    def _cancel_jobs(self) -> None:
        with suppress(queue.Empty):
            while True:
                job = self._jobs.get_nowait()
                if job is not None:
                    job[1].cancel()

    def _work(self) -> None:
        clock = self._run.clock
        try:
            self._publish()
            while not self._closed:
                # No number of commands keeps time from going by.
                for _ in range(self._jobs.qsize()):
                    self._execute(self._jobs.get())
                if clock.playing and clock.wait() <= 0.0:
                    self._run.step()
                    self._publish()
                    continue
                try:
                    self._execute(self._jobs.get(timeout=clock.wait() if clock.playing else None))
                except queue.Empty:
                    continue
        # A plug-in may fail in any way.
        except Exception as error:
            self._failed(error)
        finally:
            self._ended = True
            self._cancel_jobs()

    def _execute(self, job: tuple[Command, Future[dict[str, Any]]] | None) -> None:
        if job is None:
            return
        command, answer = job
        if not answer.set_running_or_notify_cancel():
            return
        try:
            answer.set_result(command(self._run))
        except Exception as error:
            answer.set_exception(error)
        self._publish()

    def _publish(self) -> None:
        self._published(self._camera.take(paused=not self._run.clock.playing))
