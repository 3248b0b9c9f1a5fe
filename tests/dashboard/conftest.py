"""A real browser on the page that `mesa-mobility dashboard` serves."""

from __future__ import annotations

import os
import re
import socket
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest

from tests.dashboard.selectors import CANVAS, DECISION, SHOWN
from tests.fixtures.waiting import until

# Without these Chromium looks for hosts of its makers, which only costs time.
ARGUMENTS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
PATIENCE_MS = 180_000
"""For the first page: kernels may have to be compiled before it."""

IMPATIENCE_MS = 15_000
"""For the first page of a server that has failed to show one before."""

WAIT_MS = 60_000
"""For what a page is to show once it is open."""

SILENT: set[str] = set()
"""Servers that have not shown a page yet, by address."""


@pytest.fixture(scope="session")
def browser(playwright: Any, browser_program: str) -> Iterator[Any]:
    """Chromium, driven by Playwright; tests are skipped where Solara is missing."""
    pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz,test]'")
    chromium = playwright.chromium.launch(executable_path=browser_program, args=list(ARGUMENTS))
    yield chromium
    chromium.close()


class Server:
    """A running `mesa-mobility dashboard`, and what it says."""

    def __init__(self, arguments: list[str], **keywords: Any) -> None:
        self.process = subprocess.Popen(
            arguments, stderr=subprocess.STDOUT, stdout=subprocess.PIPE, text=True, **keywords
        )
        self.lines: list[str] = []
        self.address = ""
        self._up = threading.Event()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        try:
            assert self._up.wait(60), "".join(self.lines)
            assert self.address, "".join(self.lines)
            self._wait_for_answer()
        except BaseException:
            self.stop()
            raise

    def _wait_for_answer(self) -> None:
        # Solara says where it listens before it does.
        end = time.monotonic() + 30.0
        while True:
            try:
                place = urlsplit(self.address)
                urllib.request.urlopen(f"{place.scheme}://{place.netloc}/readyz", timeout=5).close()
                return
            except urllib.error.HTTPError:
                return
            except OSError:
                waiting = self.process.poll() is None and time.monotonic() < end
                assert waiting, "".join(self.lines)
                time.sleep(0.1)

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.lines.append(line)
            found = re.search(r"http://[^ ]+", line)
            if found and not self.address:
                self.address = found[0].strip()
                self._up.set()
        self._up.set()

    def known(self, address: str) -> str:
        """An address of a page with the token, for a browser that has no cookie yet."""
        return f"{address}&{urlsplit(self.address).query}"

    def threads(self) -> int:
        """Threads of the process."""
        return len(os.listdir(f"/proc/{self.process.pid}/task"))

    def stop(self) -> None:
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()


@pytest.fixture(scope="module")
def start_dashboard() -> Iterator[Callable[..., Server]]:
    """Starts `mesa-mobility dashboard ARGUMENTS...` on a free port."""
    running: list[Server] = []

    def make(*arguments: object, **keywords: Any) -> Server:
        running.append(dashboard_server(*arguments, **keywords))
        return running[-1]

    yield make
    for each in running:
        each.stop()


def dashboard_server(
    *arguments: object, python: tuple[str, ...] = ("-m", "mesa_mobility"), **keywords: Any
) -> Server:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, *python, "dashboard", *map(str, arguments)]
    return Server([*command, "--port", str(port)], **keywords)


@pytest.fixture(scope="session")
def server(browser: Any) -> Iterator[Server]:
    """The dashboard on a free port, for all tests."""
    running = dashboard_server("doorway")
    yield running
    running.stop()


class Dashboard:
    """One browser tab on the dashboard."""

    def __init__(self, page: Any, address: str, server: Server | None = None) -> None:
        self.page = page
        self.server = server
        self.trouble: list[str] = []
        page.on("console", self._console)
        page.on("pageerror", lambda error: self.trouble.append(f"page: {error}"))
        page.on("requestfailed", lambda request: self.trouble.append(f"failed: {request.url}"))
        page.on("response", self._response)
        here = f"http://{urlsplit(address).netloc}/"
        page.on("request", lambda request: self._request(request, here))
        page.set_default_timeout(IMPATIENCE_MS if here in SILENT else PATIENCE_MS)
        SILENT.add(here)
        page.goto(address)
        self.wait(f"() => {CANVAS}?.shown?.().drawn > 0")
        SILENT.discard(here)
        page.set_default_timeout(WAIT_MS)

    def _console(self, message: Any) -> None:
        # The tests take screenshots and read pixels, which the page does not.
        of_tests = message.text.startswith(("[.WebGL-", "Canvas2D: Multiple readback"))
        if message.type in ("error", "warning") and not of_tests:
            self.trouble.append(f"console: {message.text}")

    def _response(self, response: Any) -> None:
        if response.status >= 400:
            self.trouble.append(f"{response.status}: {response.url}")

    def _request(self, request: Any, here: str) -> None:
        if not request.url.startswith((here, "data:", "blob:")):
            self.trouble.append(f"leaves this machine: {request.url}")

    def wait(self, condition: str, argument: Any = None) -> None:
        self.page.wait_for_function(condition, arg=argument)

    def expect(self, what: Any) -> Any:
        """Playwright's claims of the page or of a part of it, which it waits for."""
        from playwright.sync_api import expect

        expect.set_options(timeout=WAIT_MS)
        return expect(what)

    def comes_to(self, script: str, expected: Any) -> None:
        """Wait until a script gives what is expected; otherwise tell what it gave last."""
        end = time.monotonic() + WAIT_MS / 1000
        while (found := self.page.evaluate(script)) != expected and time.monotonic() < end:
            self.page.wait_for_timeout(50)
        assert found == expected

    def turn_to(self, name: str) -> None:
        """Click a tab, and wait until its panel is the only one."""
        self.page.get_by_role("tab", name=name).click()
        self.page.get_by_role("tabpanel", name=name).wait_for()
        self.expect(self.page.get_by_role("tabpanel")).to_have_count(1)

    def shown(self) -> dict[str, Any]:
        """The state drawn on the crowd's canvas."""
        return self.page.evaluate(f"() => {SHOWN}")

    def people(self) -> np.ndarray:
        """(n, 6) row, x, y, heading, value and rise of everybody on the canvas."""
        return np.array(self.shown()["people"]).reshape(-1, 6)

    def decision(self) -> dict[str, Any]:
        """The state drawn in the decision view."""
        return self.page.evaluate(f"() => {DECISION}.shown()")

    def pixels(self) -> str:
        """The crowd's canvas as a picture."""
        return self.page.evaluate(f"() => {CANVAS}.toDataURL()")

    def button(self, name: str) -> Any:
        return self.page.get_by_role("button", name=name, exact=True)

    def at_rest(self, elapsed: float) -> None:
        """Wait until the canvas shows the crowd at a time, and nothing between two times."""
        self.wait(f"(t) => Math.abs({SHOWN}.elapsed - t) < 1e-6", elapsed)

    def step(self, times: int = 1) -> None:
        for _ in range(times):
            self.wait(f"() => !{SHOWN}.moving")
            before = self.shown()["elapsed"]
            self.button("Step").click()
            self.at_rest(before + 0.1)

    def play(self) -> None:
        self.button("Play").click()
        self.button("Pause").wait_for()

    def pause(self) -> None:
        self.button("Pause").click()
        self.button("Play").wait_for()
        self.wait(f"() => !{SHOWN}.moving")

    def set(self, name: str, text: str) -> None:
        """Type into the field of a parameter."""
        field = self.page.get_by_label(name, exact=True)
        field.fill(text)
        field.press("Enter")

    def below(self, name: str) -> Any:
        """What stands below the field of a parameter."""
        field = self.page.locator(".mm-entry", has=self.page.get_by_label(name, exact=True))
        return field.locator(".mm-below")

    def choose(self, name: str, option: str) -> None:
        """Pick from a list."""
        self.page.get_by_label(name, exact=True).select_option(option)

    def click_at(self, x: float, y: float) -> None:
        """Click a place on the floor, metres, once it stays where it is on the page."""
        before, at = None, self._on_page(x, y)
        while at != before:
            self.page.wait_for_timeout(80)
            before, at = at, self._on_page(x, y)
        self.page.mouse.click(*at)

    def _on_page(self, x: float, y: float) -> list[float]:
        found: list[float] = self.page.evaluate(f"([x, y]) => {CANVAS}.onPage(x, y)", [x, y])
        return found

    def click_person(self, row: int) -> None:
        person = next(each for each in self.people() if each[0] == row)
        self.click_at(person[1], person[2])
        self.wait(
            f"(row) => {SHOWN}.selected === row && {DECISION}.shown()?.pedestrian === row", row
        )


@pytest.fixture
def open_tab(browser: Any, server: Server) -> Iterator[Callable[..., Dashboard]]:
    """Opens tabs on the dashboard, or on another address; nothing may go wrong in any of them."""
    tabs: list[Dashboard] = []
    said = len(server.lines)

    def make(
        address: str | None = None, width: int = 1440, height: int = 1000, **context: Any
    ) -> Dashboard:
        page = browser.new_page(
            viewport={"width": width, "height": height}, accept_downloads=True, **context
        )
        tabs.append(Dashboard(page, address or server.address, server))
        return tabs[-1]

    yield make
    for each in tabs:
        each.page.close()
    assert [line for tab in tabs for line in tab.trouble] == []
    assert "".join(server.lines[said:]) == ""


@pytest.fixture
def tab(open_tab: Callable[..., Dashboard]) -> Dashboard:
    """One tab."""
    return open_tab()


@pytest.fixture
def start_server(browser: Any, tmp_path: Path) -> Iterator[Callable[..., Server]]:
    """Starts `solara run FILE` in a folder of its own."""
    running: list[Server] = []

    def make(text: str, **beside: str) -> Server:
        (tmp_path / "page.py").write_text(text)
        for name, own in beside.items():
            (tmp_path / f"{name}.py").write_text(own)
        solara = str(Path(sys.executable).parent / "solara")
        # A home of its own: Solara's first page on a machine is another than those after it.
        environment = {**os.environ, "SOLARA_HOME": str(tmp_path / "home")}
        running.append(
            Server(
                [solara, "run", "page.py", "--no-open", "--port", "0", "--no-check-version"],
                cwd=tmp_path,
                env=environment,
            )
        )
        return running[-1]

    yield make
    for each in running:
        each.stop()


@pytest.fixture
def session() -> Iterator[Any]:
    """The thread behind a page, with a doorway of 12 people that stands still."""
    from mesa_mobility.models import Doorway

    from mesa_mobility.dashboard.session.run_config import Recipe
    from mesa_mobility.dashboard.session.session import Session

    session = Session()
    session.start()
    session.build(Recipe(Doorway, {"pedestrians": 12, "rng": 3}))
    until(lambda: session.status.value.state == "ready")
    yield session
    session.close()
