"""Films of a run in three dimensions, drawn by a browser on this machine.

The browser opens the page that plays the run, from a server on 127.0.0.1 that knows this page
alone, and sends each picture back.
"""

from __future__ import annotations

import json
import os
import queue
import secrets
import subprocess
import tempfile
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.reports.pdf import browser_program

LARGEST = 4096
"""Pixels of a side."""

_LONGEST_PATH = 1000
_PATIENCE_S = 120.0
"""For the next picture; the first has a page to open."""


def camera_path(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The path of a camera that the page has saved.

    Raises:
        ResultsError: the file cannot be read, or is no such path.
    """
    try:
        if Path(path).stat().st_size > 1_000_000:
            raise ResultsError(f"{path}: larger than 1 MB, expected a camera path")
        found = json.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise ResultsError(f"{path}: cannot be read as a camera path: {error}") from error
    views = found.get("views") if isinstance(found, dict) else None
    if not isinstance(views, list) or not 1 <= len(views) <= _LONGEST_PATH:
        raise ResultsError(f"{path}: expected 1 to {_LONGEST_PATH} views")
    for number, view in enumerate(views):
        keys = (("time", 1), ("eye", 3), ("target", 3))
        if not isinstance(view, dict) or not all(
            _numbers(view.get(key), count) for key, count in keys
        ):
            raise ResultsError(
                f"{path}: view {number}: expected time in seconds, and eye and target in metres"
            )
    return {"views": views}


def _numbers(value: object, count: int) -> bool:
    values = [value] if count == 1 else value
    if not isinstance(values, list) or len(values) != count:
        return False
    return all(
        isinstance(each, int | float) and not isinstance(each, bool) and np.isfinite(each)
        for each in values
    )


def pictures(
    page: str,
    frames: Sequence[int],
    size: tuple[int, int],
    camera: dict[str, Any] | None = None,
    *,
    colour: str = "clothes",
    glass: bool = False,
) -> Iterator[NDArray[np.uint8]]:
    """Pictures of a run, one after the other: (high, wide, 4) red, green, blue and opacity.

    Args:
        page: what ``page_text`` makes.
        frames: frames of the run.
        size: width and height, pixels.
        camera: what ``camera_path`` reads; by default the whole floor from aside.
        colour: what colours of people stand for: "clothes", "speed" or "type".
        glass: whether walls are seen through.

    Raises:
        ResultsError: there is no browser, or it draws nothing.
    """
    asked = {
        "frames": list(frames),
        "width": size[0],
        "height": size[1],
        "path": camera,
        "glass": glass,
        "colour": colour,
    }
    program = browser_program("draw a film in three dimensions")
    with _Studio(page, asked) as studio, _browser(program, studio.address, size) as process:
        for _ in frames:
            yield np.frombuffer(studio.next(process), np.uint8).reshape(size[1], size[0], 4)


class _Studio(ThreadingHTTPServer):
    """Serves one page, and takes the pictures that it sends."""

    daemon_threads = True

    def __init__(self, page: str, asked: dict[str, Any]) -> None:
        super().__init__(("127.0.0.1", 0), _Handler)
        self.token = secrets.token_urlsafe(16)
        self.length = 4 * asked["width"] * asked["height"]
        self.page = page.replace("const ASKED = null", f"const ASKED = {json.dumps(asked)}", 1)
        self.taken: queue.Queue[bytes] = queue.Queue(maxsize=4)
        self.address = f"http://127.0.0.1:{self.server_address[1]}/{self.token}/"
        self._thread = threading.Thread(target=self.serve_forever, daemon=True)

    def __enter__(self) -> _Studio:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.shutdown()
        self.server_close()

    def next(self, process: subprocess.Popen[bytes]) -> bytes:
        """The next picture."""
        for _ in range(round(_PATIENCE_S)):
            try:
                return self.taken.get(timeout=1.0)
            except queue.Empty:
                if process.poll() is not None:
                    raise ResultsError(f"the browser has ended, status {process.poll()}") from None
        raise ResultsError(f"the browser has drawn nothing for {_PATIENCE_S:g} s")


class _Handler(BaseHTTPRequestHandler):
    server: _Studio

    def do_GET(self) -> None:
        """The page."""
        found = self.path == f"/{self.server.token}/"
        self._answer(200 if found else 404, self.server.page.encode("utf-8") if found else b"")

    def do_POST(self) -> None:
        """A picture."""
        length = int(self.headers.get("Content-Length") or 0)
        if not self.path.startswith(f"/{self.server.token}/picture/"):
            self._answer(404, b"")
        elif length != self.server.length:
            self._answer(413, b"")
        else:
            self.server.taken.put(self.rfile.read(length))
            self._answer(200, b"")

    def _answer(self, status: int, content: bytes) -> None:
        self.send_response(status)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_: object) -> None:
        """Nothing."""


@contextmanager
def _browser(
    program: str, address: str, size: tuple[int, int]
) -> Iterator[subprocess.Popen[bytes]]:
    """A browser without a window on a page."""
    with tempfile.TemporaryDirectory(
        prefix="mesa-mobility-film-", ignore_cleanup_errors=True
    ) as profile:
        command = [
            program,
            "--headless",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            "--disable-background-networking",
            "--disable-component-update",
            "--no-first-run",
            "--mute-audio",
            f"--user-data-dir={profile}",
            f"--window-size={size[0]},{size[1]}",
            address,
        ]
        # A browser of the superuser does not start with its sandbox.
        if getattr(os, "geteuid", lambda: 1)() == 0:
            command.insert(1, "--no-sandbox")
        try:
            process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
        except OSError as error:
            raise ResultsError(f"{program}: cannot be started: {error}") from error
        try:
            yield process
        finally:
            process.terminate()
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
