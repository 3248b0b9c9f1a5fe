"""A served model in this process, and clients of it."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

pytest.importorskip("websockets", reason="no websockets: pip install 'mesa-mobility[live]'")

from websockets.sync.client import ClientConnection, connect

from mesa_mobility import PedestrianModel
from mesa_mobility.live.access import listen
from mesa_mobility.live.frames import Frame, read_frame
from mesa_mobility.live.run import Run
from mesa_mobility.live.server import Access, LiveServer
from tests.fixtures.maps import strider
from tests.fixtures.scenes import corridor, model_of, put

TOKEN = "a token of the tests"


class Served:
    """A model that is served on loopback, in a thread of its own."""

    def __init__(self, model: PedestrianModel, rate: int = 30, **access: Any) -> None:
        self.model = model
        self.run = Run(model, rate)
        self.lines: list[str] = []
        listening = listen("127.0.0.1", 0)
        self.port = listening.getsockname()[1]
        given = Access("127.0.0.1", TOKEN, **access)
        self.server = LiveServer(self.run, rate, given, self.lines.append)
        self.ended: BaseException | None = None
        up = threading.Event()

        def work() -> None:
            try:
                asyncio.run(self.server.serve(listening, up.set))
            except BaseException as error:
                self.ended = error

        self.thread = threading.Thread(target=work, daemon=True)
        self.thread.start()
        assert up.wait(30)

    def address(self, **query: str) -> str:
        pairs = {"token": TOKEN.replace(" ", "%20"), **query}
        return f"ws://127.0.0.1:{self.port}/?" + "&".join(f"{k}={v}" for k, v in pairs.items())

    def client(self, form: str = "binary", **keywords: Any) -> Client:
        return Client(connect(self.address(form=form), **keywords))

    def stop(self) -> None:
        if self.thread.is_alive():
            self.server.stop()
        self.thread.join(20)
        assert not self.thread.is_alive()


class Client:
    """One connection, with its frames and answers told apart.

    Args:
        opening: what ``connect`` gives, which is entered as the library wants it.
    """

    def __init__(self, opening: Any) -> None:
        self._opening = opening
        self.socket: ClientConnection = opening.__enter__()
        self.others: list[dict[str, Any]] = []
        self.last: Frame | None = None

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *error: object) -> None:
        self._opening.__exit__(*error)

    def receive(self) -> Frame | dict[str, Any]:
        # The first step may have to be compiled.
        message = self.socket.recv(timeout=240)
        if isinstance(message, str) and (values := json.loads(message))["type"] != "frame":
            return values
        self.last = read_frame(message)
        return self.last

    def frame(self) -> Frame:
        """The next frame; what comes before it is kept in ``others``."""
        while not isinstance(found := self.receive(), Frame):
            self.others.append(found)
        return found

    def until(self, condition: Callable[[Frame], bool]) -> Frame:
        """The last frame or a later one, of which something holds."""
        frame = self.last or self.frame()
        while not condition(frame):
            frame = self.frame()
        return frame

    def send(self, text: str | bytes) -> dict[str, Any]:
        """Send a text, and return the answer."""
        self.socket.send(text)
        while isinstance(found := self.receive(), Frame) or found["type"] not in ("done", "error"):
            if not isinstance(found, Frame):
                self.others.append(found)
        return found

    def tell(self, do: str, **fields: Any) -> dict[str, Any]:
        """Give a command, and return the answer."""
        return self.send(json.dumps({"do": do, **fields}))


@pytest.fixture
def serve_model() -> Iterator[Callable[..., Served]]:
    """Serves a model until the test ends."""
    running: list[Served] = []

    def make(model: PedestrianModel, **keywords: Any) -> Served:
        running.append(Served(model, **keywords))
        return running[-1]

    yield make
    for each in running:
        each.stop()


@pytest.fixture
def served(serve_model: Callable[..., Served]) -> Served:
    """Three people who walk through a corridor."""
    return serve_model(walkers())


def walkers(*, record: bool = False) -> PedestrianModel:
    """Three people who walk 80 m through a corridor, at 1.25 m/s."""
    model = model_of(corridor(80.0), strider(), record=record)
    for x, y in ((1.0, 1.0), (2.0, 2.0), (3.0, 3.0)):
        put(model, x, y, preferred_speeds=1.25)
    return model
