"""The dashboard in a real browser: frames a second, time to start, memory, and screenshots.

    python benchmarks/dashboard.py frames            # drawn while three models play at full speed
    python benchmarks/dashboard.py start             # from the command to the first crowd drawn
    python benchmarks/dashboard.py memory --minutes 10
    python benchmarks/dashboard.py figures FOLDER    # all of these, as a block for a page
    python benchmarks/dashboard.py screenshots FOLDER

Needs `pip install 'mesa-mobility[test]'`, and Chromium: `--browser`, by default that on the path.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import socket
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pages.blocks import give, machine, table
from playwright.sync_api import Browser, Page, sync_playwright

Rows = list[tuple[str, str]]

CANVAS = "document.querySelector('.mm-crowd-canvas')"
ARGUMENTS = (
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
)  # fmt: skip
SCENES = {
    "doorway": {"pedestrians": 60},
    "auditorium": {"pedestrians": 750},
    "open_space": {"pedestrians": 5000, "size": 150},
}


@contextmanager
def served(model: str) -> Iterator[tuple[str, int, float]]:
    """A running `mesa-mobility dashboard`: its address, process number, and when it was started."""
    started = time.perf_counter()
    process = subprocess.Popen(
        [sys.executable, "-m", "mesa_mobility", "dashboard", model, "--port", str(free_port())],
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stderr is not None
    line = process.stderr.readline()
    found = re.search(r"http://\S+", line)
    if not found:
        raise SystemExit(f"the dashboard did not start: {line}{process.stderr.read()}")
    # Nobody else reads it: a full pipe would stop the server.
    threading.Thread(target=process.stderr.read, daemon=True).start()
    try:
        yield found[0], process.pid, started
    finally:
        process.terminate()
        process.wait()


def free_port() -> int:
    """A port that nobody listens on."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port: int = free.getsockname()[1]
        return port


def open_page(browser: Browser, address: str) -> Page:
    """A tab on the dashboard, the crowd drawn."""
    page = browser.new_page(viewport={"width": 1440, "height": 1000})
    page.set_default_timeout(300_000)
    page.goto(address)
    page.wait_for_function(f"() => {CANVAS}?.shown?.().drawn > 0")
    return page


def set_parameters(page: Page, parameters: dict[str, int]) -> None:
    """Type them, and wait for that crowd."""
    for name, value in parameters.items():
        if name != "pedestrians":
            type_in(page, name, value)
    type_in(page, "pedestrians", parameters["pedestrians"])
    page.wait_for_function(f"(n) => {CANVAS}.shown().inside === n", arg=parameters["pedestrians"])


def type_in(page: Page, name: str, value: int) -> None:
    """Type into the field of a parameter."""
    field = page.get_by_label(name, exact=True)
    field.fill(str(value))
    field.press("Enter")


def choose(page: Page, name: str, option: str) -> None:
    """Pick from a list."""
    page.get_by_label(name, exact=True).select_option(option)


COUNT = f"""async (seconds) => {{
  const canvas = {CANVAS}, now = () => ({{time: performance.now() / 1000, ...canvas.shown()}});
  const frame = () => new Promise(requestAnimationFrame);
  while (!(canvas.shown().elapsed > 0)) await frame();
  const first = now();
  let last = first;
  while (last.time < first.time + seconds && last.inside > 0) {{
    await frame();
    const next = now();
    if (next.inside === 0) break;
    last = next;
  }}
  return ["time", "drawn", "number", "elapsed"].map((name) => last[name] - first[name]);
}}"""
"""Counts in the page from the first movement until everybody has left, or so many seconds."""


def frames(browser: Browser, seconds: float) -> Rows:
    """How many frames are drawn in a second while models play at full speed."""
    rows = []
    for model, parameters in SCENES.items():
        with served(model) as (address, _, _):
            page = open_page(browser, address)
            set_parameters(page, parameters)
            choose(page, "speed", "full")
            # At full speed some models are over in a moment: they play again and again.
            took = drawn = pictures = simulated = 0.0
            runs = 0
            while took < seconds:
                page.get_by_role("button", name="Play", exact=True).click()
                counted = page.evaluate(COUNT, seconds)
                took, drawn = took + counted[0], drawn + counted[1]
                pictures, simulated = pictures + counted[2], simulated + counted[3]
                runs += 1
                page.get_by_role("button", name="Reset", exact=True).click()
                page.wait_for_function(f"() => {CANVAS}.shown().elapsed === 0")
            print(
                f"{model} {parameters['pedestrians']}: {drawn / took:.1f} frames/s drawn, "
                f"{pictures / took:.1f} pictures/s received, {simulated / took:.1f} x real time "
                f"({took:.1f} s of play in {runs} runs)",
                flush=True,
            )
            page.close()
        people = f"{model}, {parameters['pedestrians']:,} people"
        rows.append((f"frames per second at full speed: {people}", f"{drawn / took:.0f}"))
    return rows


def start(browser: Browser, repeats: int) -> Rows:
    """The seconds from the command to the first crowd drawn."""
    took = []
    for k in range(repeats + 1):
        with served("doorway") as (address, _, started):
            page = open_page(browser, address)
            if k:  # the first may have to compile
                took.append(time.perf_counter() - started)
            page.close()
    print(f"page ready after {statistics.median(took):.1f} s (each: {[round(t, 1) for t in took]})")
    figure = f"{statistics.median(took):.1f} s ({min(took):.1f} to {max(took):.1f})"
    return [("from the command to the first crowd drawn, kernels compiled", figure)]


def memory(browser: Browser, minutes: float) -> Rows:
    """The memory of server and browser tab while the auditorium plays at full speed."""
    with served("auditorium") as (address, process, _):
        page = open_page(browser, address)
        heap = page.context.new_cdp_session(page)
        choose(page, "speed", "full")
        end = time.monotonic() + 60.0 * minutes
        samples = []
        while time.monotonic() < end:
            # Evacuated in under a minute: then it starts anew.
            if not page.get_by_role("button", name="Pause", exact=True).count():
                page.get_by_role("button", name="Reset", exact=True).click()
                page.wait_for_function(f"() => {CANVAS}.shown().elapsed === 0")
                page.get_by_role("button", name="Play", exact=True).click()
            time.sleep(5.0)
            heap.send("HeapProfiler.collectGarbage")
            used = heap.send("Runtime.getHeapUsage")["usedSize"] / 2**20
            samples.append((resident(process), used))
            if len(samples) % 12 == 0:
                print(f"server {samples[-1][0]:.0f} MB, page {used:.0f} MB", flush=True)
        rows = []
        for name, column in zip(("server", "browser tab"), zip(*samples, strict=True), strict=True):
            # Kernels, maps and buffers come in the first minute.
            steady = column[12:] or column
            print(
                f"{name}: {steady[0]:.0f} MB after the first minute, {steady[-1]:.0f} MB at the "
                f"end, from {min(steady):.0f} to {max(steady):.0f} MB between"
            )
            what = f"memory over {minutes:g} minutes of the auditorium at full speed: {name}"
            rows.append((what, f"{min(steady):.0f} to {max(steady):.0f} MB"))
        return rows


def resident(process: int) -> float:
    """Resident memory of a process, MB."""
    pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def screenshots(browser: Browser, folder: Path) -> None:
    """Write pictures of the four views."""
    with served("auditorium") as (address, _, _):
        page = open_page(browser, address)
        choose(page, "speed", "5 x")
        page.get_by_role("button", name="Play", exact=True).click()
        page.wait_for_function(f"() => {CANVAS}.shown().elapsed > 25")
        page.get_by_role("button", name="Pause", exact=True).click()
        page.get_by_role("button", name="Play", exact=True).wait_for()
        page.wait_for_timeout(1500)
        # Somebody in the crowd in front of the left hall door.
        nearest = page.evaluate(
            f"() => {{const p = {CANVAS}.shown().people; let best = [1e9, 0];"
            "for (let k = 0; k < p.length; k += 6) {"
            "const d = Math.hypot(p[k + 1] - 9.6, p[k + 2] - 22.3);"
            "if (d < best[0]) best = [d, p[k]];}"
            "return best[1];}"
        )
        person = page.get_by_label("person", exact=True)
        person.fill(str(nearest))
        person.press("Enter")
        page.get_by_role("button", name="To the next decision").click()
        page.get_by_text("Decision as taken").wait_for()
        page.wait_for_timeout(1500)
        page.screenshot(path=folder / "dashboard.png")
        page.locator(".mm-crowd").screenshot(path=folder / "dashboard_crowd.png")
        page.locator(".mm-decision").screenshot(path=folder / "dashboard_decision.png")
        page.get_by_role("button", name="Play", exact=True).click()
        choose(page, "speed", "full")
        page.wait_for_function(f"() => {CANVAS}.shown().elapsed > 200")
        page.get_by_role("button", name="Pause", exact=True).click()
        page.wait_for_timeout(1500)
        page.locator(".mm-charts").screenshot(path=folder / "dashboard_charts.png")
        # What is outside the window is not in a picture.
        page.set_viewport_size({"width": 1440, "height": 1400})
        page.get_by_role("tab", name="Mobility map").click()
        page.get_by_label("cluster, 0 to").fill("3")
        page.get_by_label("cluster, 0 to").press("Enter")
        page.wait_for_timeout(3000)
        page.locator(".mm-map").screenshot(path=folder / "dashboard_map.png")


def main() -> None:
    """Run the measurements that the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("what", choices=("frames", "start", "memory", "figures", "screenshots"))
    parser.add_argument("folder", nargs="?", type=Path, help="for figures and screenshots")
    parser.add_argument("--browser", default=shutil.which("chromium"))
    parser.add_argument("--repeats", type=int, default=3, help="of starting")
    parser.add_argument("--seconds", type=float, default=10.0, help="of play to count frames in")
    parser.add_argument("--minutes", type=float, default=10.0, help="of play for memory")
    chosen: Any = parser.parse_args()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chosen.browser, args=list(ARGUMENTS))
        if chosen.what == "frames":
            frames(browser, chosen.seconds)
        elif chosen.what == "start":
            start(browser, chosen.repeats)
        elif chosen.what == "memory":
            memory(browser, chosen.minutes)
        elif chosen.folder is None:
            parser.error(f"{chosen.what}: expected a folder")
        elif chosen.what == "figures":
            rows = [*frames(browser, chosen.seconds), *start(browser, chosen.repeats)]
            rows += memory(browser, chosen.minutes)
            text = f"{machine()}\n\n{table(('what', 'measured'), rows)}"
            give(chosen.folder, "dashboard-speed", text)
        else:
            screenshots(browser, chosen.folder)
        browser.close()


if __name__ == "__main__":
    main()
