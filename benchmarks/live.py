"""A served model on loopback: latency, rate, and whether each frame is right.

    python benchmarks/live.py --seconds 60

500 people walk round a square between four places, for ever. A client in a process of its own
receives each frame, in either form, and compares it to the last bit with those of the same model
run without a server. Latency is the time from when a frame is published to when its numbers are
there; lateness is how much later than in real time a frame comes.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
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


def truth(pedestrians: int, seconds: float) -> list[tuple[bytes, ...]]:
    """What each frame must hold, from a run without a server."""
    model = Square(pedestrians, rng=1)
    model.frames_per_step = 1
    held = [_held(model)]
    for _ in range(round(seconds * FRAMES_A_SECOND)):
        model.step()
        held.append(_held(model))
    return held


def _held(model: PedestrianModel) -> tuple[bytes, ...]:
    rows = model.rows
    columns = [getattr(model.crowd, name)[rows].tobytes() for name in COLUMNS]
    return (rows.astype(np.int32).tobytes(), *columns)


def of_frame(frame: Frame) -> tuple[bytes, ...]:
    """The same of a frame that has come."""
    columns = [np.asarray(getattr(frame, name)).tobytes() for name in COLUMNS]
    return (frame.person.tobytes(), *columns)


def measure(pedestrians: int, seconds: float, form: str) -> None:
    """Serve the model, receive its frames for so long, and print the figures."""
    expected = truth(pedestrians, seconds + 2.0)
    model = f"{Path(__file__)}:Square"
    words = [sys.executable, "-m", "mesa_mobility", "serve", model, "--seed", "1", "--port", "0"]
    words += ["--set", f"pedestrians={pedestrians}"]
    server = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    assert server.stdout is not None
    latency, late, frames, wrong, size = [], [], [], 0, 0
    try:
        with connect(f"{server.stdout.readline().strip()}&form={form}") as socket:
            json.loads(socket.recv())
            while not frames or frames[-1].frame < seconds * FRAMES_A_SECOND:
                message = socket.recv()
                frame = read_frame(message)
                now = time.time()
                size = max(size, len(message))
                wrong += of_frame(frame) != expected[frame.frame]
                # The first frames come before time begins.
                if frame.frame >= 1:
                    frames.append(frame)
                    latency.append(now - frame.sent)
                    late.append(now - frame.frame / FRAMES_A_SECOND)
    finally:
        server.terminate()
        server.wait()
    took = frames[-1].sent - frames[0].sent
    lost = frames[-1].number - frames[0].number + 1 - len(frames)
    simulated = (frames[-1].frame - frames[0].frame) / FRAMES_A_SECOND
    spread = np.array(late) - min(late)
    print(
        f"{form}: {pedestrians} people, {took:.1f} s, frames of {size / 1000:.0f} kB: "
        f"{(len(frames) - 1) / took:.2f} frames/s, {simulated / took:.3f} x real time, "
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
    chosen = parser.parse_args()
    for form in ("binary", "json") if chosen.form is None else (chosen.form,):
        measure(chosen.people, chosen.seconds, form)


if __name__ == "__main__":
    main()
