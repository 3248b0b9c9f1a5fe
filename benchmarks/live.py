"""A served model on loopback: latency, rate, and whether each frame is right.

    python benchmarks/live.py --seconds 60
    python benchmarks/live.py --seconds 600 --form binary --dying 20

500 people walk round a square between four places, for ever. A client in a process of its own
receives each frame, in either form, and compares it to the last bit with those of the same model
run without a server. Latency is the time from when a frame is published to when its numbers are
there; lateness is how much later than in real time a frame comes. With --dying, a second client is
killed so many seconds after it has connected, again and again; another takes its place at once, and
its frames are compared too.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import multiprocessing
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import Annotated

import numpy as np
from shapely import box
from websockets.sync.client import connect

from mesa_mobility import FloorPlan, Gate, PedestrianModel, Range
from mesa_mobility.live.frames import COLUMNS, Frame, read_frame

SIDE, FRAMES_A_SECOND = 40.0, 30


class Square(PedestrianModel):
    """People go round a square by four gates, two groups in opposite directions.

    Args:
        pedestrians: people.
        rng: seed.
    """

    def __init__(
        self, pedestrians: Annotated[int, Range(2, 1000)] = 500, rng: int | None = None
    ) -> None:
        half, inner = SIDE / 2, 8.0
        plan = FloorPlan(
            box(0.0, 0.0, SIDE, SIDE),
            gates=[
                Gate("south", (half, 0.0), (half, half - inner)),
                Gate("east", (half + inner, half), (SIDE, half)),
                Gate("north", (half, half + inner), (half, SIDE)),
                Gate("west", (0.0, half), (half - inner, half)),
            ],
            obstacles=[box(half - inner, half - inner, half + inner, half + inner)],
        )
        super().__init__(plan, rng=rng)
        places = plan.random_points(pedestrians, self.rng, spacing=0.6, clearance=0.3)
        names = ["south", "east", "north", "west"]
        middle = pedestrians // 2
        self.add_pedestrians(places[:middle], route=names, loop=True)
        self.add_pedestrians(places[middle:], route=names[::-1], loop=True)


def truth(pedestrians: int, seconds: float) -> list[str]:
    """Digest of what each frame must hold, from a run without a server."""
    model = Square(pedestrians, rng=1)
    model.frames_per_step = 1
    held = [_held(model)]
    for _ in range(round(seconds * FRAMES_A_SECOND)):
        model.step()
        held.append(_held(model))
    return held


def _held(model: PedestrianModel) -> str:
    rows = model.rows
    columns = [getattr(model.crowd, name)[rows].tobytes() for name in COLUMNS]
    return _digest(rows.astype(np.int32).tobytes(), *columns)


def of_frame(frame: Frame) -> str:
    """The same of a frame that has come."""
    columns = [np.asarray(getattr(frame, name)).tobytes() for name in COLUMNS]
    return _digest(frame.person.tobytes(), *columns)


def _digest(*parts: bytes) -> str:
    return hashlib.sha256(b"".join(parts)).hexdigest()


def listen(address: str, path: str) -> None:
    """Receive frames until killed; a line for each, its frame and digest."""
    with connect(address) as socket, open(path, "a", encoding="ascii") as file:
        json.loads(socket.recv())
        while True:
            frame = read_frame(socket.recv())
            file.write(f"{frame.frame} {of_frame(frame)}\n")
            file.flush()


class DyingClients:
    """Clients that are killed and replaced, in a thread that watches them."""

    def __init__(self, address: str, life: float, folder: str) -> None:
        self._address, self._life, self._folder = address, life, Path(folder)
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._replace, daemon=True)
        self._thread.start()

    def _replace(self) -> None:
        new = multiprocessing.get_context("spawn").Process
        number = 0
        while not self._over.is_set():
            path = self._folder / f"{number}.txt"
            client = new(target=listen, args=(self._address, str(path)), daemon=True)
            client.start()
            self._over.wait(self._life)
            client.kill()
            client.join()
            number += 1

    def figures(self, expected: list[str]) -> str:
        """End the last one; how many there were, and how many of their frames were wrong."""
        self._over.set()
        self._thread.join()
        counts, wrong = [], 0
        for path in self._folder.glob("*.txt"):
            # A killed client may leave half a line.
            lines = [line.split() for line in path.read_text().split("\n")[:-1]]
            counts.append(len(lines))
            wrong += sum(digest != expected[int(frame)] for frame, digest in lines)
        served = sum(count > 0 for count in counts)
        return f"{served} clients killed, {sum(counts)} frames of theirs, {wrong} wrong"


def measure(pedestrians: int, seconds: float, form: str, dying: float | None) -> None:
    """Serve the model, receive its frames for so long, and print the figures."""
    expected = truth(pedestrians, seconds + 2.0)
    model = f"{Path(__file__)}:Square"
    words = [sys.executable, "-m", "mesa_mobility", "serve", model, "--seed", "1", "--port", "0"]
    words += ["--set", f"pedestrians={pedestrians}"]
    server = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    assert server.stdout is not None
    address = f"{server.stdout.readline().strip()}&form={form}"
    latency, late, wrong, size = [], [], 0, 0
    first = last = None
    others = None
    try:
        with tempfile.TemporaryDirectory() as folder, connect(address) as socket:
            json.loads(socket.recv())
            if dying is not None:
                others = DyingClients(address, dying, folder)
            while last is None or last.frame < seconds * FRAMES_A_SECOND:
                message = socket.recv()
                frame = read_frame(message)
                now = time.time()
                size = max(size, len(message))
                wrong += of_frame(frame) != expected[frame.frame]
                # The first frames come before time begins.
                if frame.frame >= 1:
                    first, last = first or frame, frame
                    latency.append(now - frame.sent)
                    late.append(now - frame.frame / FRAMES_A_SECOND)
            if others is not None:
                print(others.figures(expected))
    finally:
        server.terminate()
        server.wait()
    took = last.sent - first.sent
    lost = last.number - first.number + 1 - len(latency)
    simulated = (last.frame - first.frame) / FRAMES_A_SECOND
    spread = np.array(late) - min(late)
    print(
        f"{form}: {pedestrians} people, {took:.1f} s, frames of {size / 1000:.0f} kB: "
        f"{(len(latency) - 1) / took:.2f} frames/s, {simulated / took:.3f} x real time, "
        f"{lost} lost, {wrong} wrong; latency {_quantiles(latency)}; lateness {_quantiles(spread)}",
        flush=True,
    )


def _quantiles(seconds: object) -> str:
    values = np.quantile(np.asarray(seconds), [0.5, 0.95, 0.99, 1.0]) * 1000
    return "median {:.1f}, p95 {:.1f}, p99 {:.1f}, most {:.1f} ms".format(*values)


def main() -> None:
    """Measure both forms."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--people", type=int, default=500)
    parser.add_argument("--seconds", type=float, default=60.0, help="of each form")
    parser.add_argument("--form", choices=("binary", "json"), help="one alone")
    parser.add_argument("--dying", type=float, help="seconds after which a second client is killed")
    chosen = parser.parse_args()
    for form in ("binary", "json") if chosen.form is None else (chosen.form,):
        measure(chosen.people, chosen.seconds, form, chosen.dying)


if __name__ == "__main__":
    main()
