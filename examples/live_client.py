"""A program of its own that watches a running model and commands it.

    mesa-mobility serve doorway          prints an address
    python examples/live_client.py ADDRESS

Needs `pip install 'mesa-mobility[live]'`. In place of this program, a game engine or a training
simulator may connect; docs/how-to/results/live.md says what goes over the socket.
"""

import json
import re
import struct
import subprocess
import sys
from contextlib import contextmanager

from websockets.sync.client import connect

HEADER = struct.Struct("<4sHHIIQd")


def positions(message: bytes) -> dict[int, tuple[float, float]]:
    """Where everybody is, by number, in the binary form of a frame."""
    magic, _, _, _, people, _, _ = HEADER.unpack_from(message)
    assert magic == b"MMLF"
    x = struct.unpack_from(f"<{people}d", message, HEADER.size)
    y = struct.unpack_from(f"<{people}d", message, HEADER.size + 8 * people)
    numbers = struct.unpack_from(f"<{people}i", message, HEADER.size + 40 * people)
    return dict(zip(numbers, zip(x, y, strict=True), strict=True))


def tell(socket, do: str, **fields) -> dict:
    """Give a command, and wait for its answer; frames that come meanwhile are left out."""
    socket.send(json.dumps({"do": do, "id": do, **fields}))
    for message in socket:
        if isinstance(message, str) and json.loads(message).get("id") == do:
            return json.loads(message)
    raise ConnectionError("the server has ended")


def watch(address: str) -> None:
    """Bring in somebody and steer it, and say where it gets in 3 s."""
    with connect(address) as socket:
        scene = json.loads(socket.recv())
        print(f"{scene['model']}: {len(scene['people']['person'])} people")
        # The clock stands still meanwhile, so nobody sets off for an exit before it is steered.
        tell(socket, "pause")
        [person] = tell(socket, "add", positions=[[12.0, 1.0]], heading=1.57)["people"]
        tell(socket, "steer", person=person, velocity=[0.0, 1.2])
        tell(socket, "resume")
        frames = (positions(message) for message in socket if isinstance(message, bytes))
        start = next(frames)[person]
        for _ in range(90):
            now = next(frames)[person]
        print(f"from ({start[0]:.1f}, {start[1]:.1f}) to ({now[0]:.1f}, {now[1]:.1f})")
        print(tell(socket, "close", opening="no such door")["error"])


@contextmanager
def served(model: str):
    """The address of a model that this program serves itself."""
    words = [sys.executable, "-m", "mesa_mobility", "serve", model, "--port", "0", "--seed", "1"]
    server = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    try:
        yield re.match(r"ws://\S+", server.stdout.readline())[0]
    finally:
        server.terminate()
        server.communicate()


def main(*arguments: str) -> None:
    if arguments:
        watch(arguments[0])
        return
    with served("doorway") as address:
        watch(address)


if __name__ == "__main__":
    main(*sys.argv[1:])
