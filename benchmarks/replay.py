"""The page of a run in a real browser without a graphics card: frames a second, opening, seeking,
clicks.

    mesa-mobility run auditorium --seed 1 --record decisions --out out/auditorium
    mesa-mobility replay out/auditorium --no-open
    python benchmarks/replay.py out/auditorium/replay.html

The browser draws as Chromium does by itself on a machine without a graphics card: it puts windows
together in memory, and only what is three-dimensional goes through SwiftShader. The screen shows
60 frames a second. Processor time is that of all of the browser's processes: on a busy machine
frames a second say little, and the processor time of a frame says more. Needs
`pip install 'mesa-mobility[test]'`, and Chromium: `--browser`, by default that on the path.
"""

from __future__ import annotations

import argparse
import os
import shutil
import time
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

ARGUMENTS = (
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
)
"""With `--use-angle=swiftshader` Chromium would take SwiftShader for a graphics card and put whole
windows together with it, which takes some 60 ms more a frame."""

VIEWS = (
    ("plan", ""),
    ("plan", "density"),
    ("orbit", ""),
    ("orbit", "density"),
    ("follow", ""),
    ("eyes", ""),
)
"""Views of the page, and maps on the floor."""

TICKS = os.sysconf("SC_CLK_TCK")

COUNT = """async (seconds) => {
  const frame = () => new Promise(requestAnimationFrame);
  const count = () => state.stage.drawn + state.plan.drawn;
  const begin = performance.now(), drawn = count();
  while (performance.now() - begin < 1000 * seconds) await frame();
  return [(performance.now() - begin) / 1000, count() - drawn];
}"""

CLICK = """() => new Promise((done) => {
  const people = peopleOn(storeyShown()), [x, y] = people[people.length >> 1].track.at(state.frame);
  const [clientX, clientY] = state.plan.onPage(x, y), canvas = state.plan.$refs.canvas;
  const event = { clientX, clientY, isPrimary: true, button: 0, pointerType: "touch" };
  element("person").value = -1;
  const begin = performance.now();
  canvas.dispatchEvent(new PointerEvent("pointerdown", event));
  canvas.dispatchEvent(new PointerEvent("pointerup", event));
  const look = () => {
    const took = (performance.now() - begin) / 1000;
    if (element("why").textContent) done(took);
    else if (took > 5) done(Infinity);
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
})"""

SEEK = """async (share) => {
  const begin = performance.now();
  show(state.first + share * (state.last - state.first));
  state.stage.renderer.getContext().finish();
  return (performance.now() - begin) / 1000;
}"""


def processor_time(parent: int) -> float:
    """Seconds used so far by the processes that descend from one."""
    parents, used = {}, {}
    for each in Path("/proc").iterdir():
        if each.name.isdigit():
            try:
                fields = (each / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            parents[int(each.name)] = int(fields[1])
            used[int(each.name)] = (int(fields[11]) + int(fields[12])) / TICKS

    def below(process: int) -> bool:
        while process > 1:
            if process == parent:
                return True
            process = parents.get(process, 0)
        return False

    return sum(value for process, value in used.items() if below(process))


def measure(page: Page, path: Path, seconds: float) -> None:
    """Print the figures of one page."""
    started = time.perf_counter()
    page.goto(path.resolve().as_uri())
    page.wait_for_selector("body[data-ready=yes]", timeout=300_000)
    opened = time.perf_counter() - started
    page.click("#play")
    took = sorted(page.evaluate(SEEK, (7 * k % 20 + 0.5) / 20) for k in range(20))
    print(f"{path}: {path.stat().st_size / 1e6:.1f} MB, opened in {opened:.1f} s")
    print(f"any instant: median {took[10]:.3f} s, longest {took[-1]:.3f} s")
    people = page.evaluate(
        "Math.max(...[1, 5, 10].map((s) => (state.frame = s * 30, present().length)))"
    )
    for view, layer in VIEWS:
        page.evaluate("show(30)")
        page.select_option("#layer", layer)
        page.select_option("#camera", view)
        page.click("#play")
        page.evaluate(COUNT, 1.0)
        before = processor_time(os.getpid())
        real, drawn = page.evaluate(COUNT, seconds)
        used = processor_time(os.getpid()) - before
        share, figures = page.evaluate("[DETAIL[state.stage.detail].share, state.stage.figures]")
        page.click("#play")
        if view == "plan" and not layer:
            print(f"a click is answered in {page.evaluate(CLICK):.3f} s")
        print(
            f"{view}{layer and ' with '}{layer}, {people} people: {drawn / real:.1f} frames/s, "
            f"{1000 * used / drawn:.0f} ms of processor time each; {100 * share:.0f} % of the "
            f"pixels' width; near, far, pawns: {figures}; load {os.getloadavg()[0]:.1f}",
            flush=True,
        )


def main() -> None:
    """Read the command line and measure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pages", type=Path, nargs="+", help="what `mesa-mobility replay` wrote")
    parser.add_argument("--browser", default=shutil.which("chromium"))
    parser.add_argument("--seconds", type=float, default=8.0)
    parser.add_argument("--picture", type=Path, help="write a picture of the last page")
    chosen = parser.parse_args()
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=chosen.browser, args=list(ARGUMENTS))
        page = browser.new_page(viewport={"width": 1366, "height": 768})
        page.on("pageerror", lambda error: print("error:", error))
        for each in chosen.pages:
            measure(page, each, chosen.seconds)
        if chosen.picture:
            page.screenshot(path=chosen.picture)
        browser.close()


if __name__ == "__main__":
    main()
