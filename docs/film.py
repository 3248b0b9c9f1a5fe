"""Film a run in three dimensions: the pictures in docs/index.md and docs/how-to/results/bodies.md.

    mesa-mobility run doorway --seed 1 --record decisions --out out/doorway
    mesa-mobility replay out/doorway --no-open
    python docs/film.py out/doorway/replay.html docs/images

A headless Chromium draws the page of `mesa-mobility replay`, picture by picture, while the camera
swings around one point. Needs `pip install 'mesa-mobility[test]'`, and Chromium: `--browser`, by
default that on the path.
"""

from __future__ import annotations

import argparse
import base64
import io
import math
import shutil
from collections.abc import Iterator
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

ARGUMENTS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")

ONLY_THE_VIEW = "#view { position: fixed !important; inset: 0; z-index: 9; }"

SHARP = "play(false); Object.assign(state.stage, {detail: 0, sharp: 2}); state.stage.resize(true)"

# The picture is read in the task that draws it, while the drawing buffer still holds it.
DRAW = """([frame, target, eye]) => {
  const { stage } = state;
  stage.orbit.target.set(...target);
  stage.perspective.position.set(...eye);
  stage.orbit.update();
  show(frame);
  return stage.canvas.toDataURL("image/png").split(",")[1];
}"""


def eye(target: tuple[float, float, float], distance: float, share: float) -> tuple[float, ...]:
    """Where the camera stands at a share of the film: it swings, and ends where it began."""
    azimuth = math.radians(-125.0 + 25.0 * math.sin(2.0 * math.pi * share))
    elevation = math.radians(30.0)
    x, y, z = target
    flat = distance * math.cos(elevation)
    return (
        x + flat * math.cos(azimuth),
        y + flat * math.sin(azimuth),
        z + distance * math.sin(elevation),
    )


def pictures(page: Page, given: argparse.Namespace) -> Iterator[Image.Image]:
    """The pictures of the film, in the order of time."""
    page.goto(given.page.resolve().as_uri())
    page.wait_for_selector("body[data-ready=yes]", timeout=300_000)
    page.add_style_tag(content=ONLY_THE_VIEW)
    page.select_option("#colour", "clothes")
    page.evaluate(SHARP)
    count = round((given.to - given.begin) * given.rate / given.speed_up)
    target = (given.at[0], given.at[1], 0.8)
    for k in range(count):
        frame = 30.0 * (given.begin + k * given.speed_up / given.rate)
        where = eye(target, given.distance, k / count)
        drawn = base64.b64decode(page.evaluate(DRAW, [frame, list(target), list(where)]))
        picture = Image.open(io.BytesIO(drawn)).convert("RGB")
        yield picture.resize(tuple(given.size), Image.Resampling.LANCZOS)


def still(page: Page, given: argparse.Namespace) -> None:
    """Write a picture of the page with its controls, 10 s into the run, with person 3 selected."""
    page.goto(given.page.resolve().as_uri())
    page.wait_for_selector("body[data-ready=yes]", timeout=300_000)
    page.select_option("#person", "3")
    target = (given.at[0] + 0.5, given.at[1], 0.8)
    page.evaluate(SHARP)
    page.evaluate(DRAW, [300.0, list(target), list(eye(target, 1.2 * given.distance, 0.25))])
    page.screenshot(path=given.folder / "replay.png")


def main() -> None:
    """Read the command line and film."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("page", type=Path, help="what `mesa-mobility replay` wrote")
    parser.add_argument("folder", type=Path, help="for walking.webp and replay.png")
    parser.add_argument("--from", dest="begin", type=float, default=2.0, help="seconds")
    parser.add_argument("--to", type=float, default=14.0, help="seconds")
    parser.add_argument("--at", type=float, nargs=2, default=(9.8, 5.0), help="metres")
    parser.add_argument("--distance", type=float, default=8.0, help="of the camera, metres")
    parser.add_argument("--rate", type=float, default=12.0, help="pictures a second")
    parser.add_argument("--speed-up", type=float, default=1.0, help="times as fast as in reality")
    parser.add_argument("--size", type=int, nargs=2, default=(720, 405), help="pixels")
    parser.add_argument("--quality", type=int, default=60)
    parser.add_argument("--browser", default=shutil.which("chromium"))
    given = parser.parse_args()
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=given.browser, args=list(ARGUMENTS))
        width, height = given.size
        page = browser.new_page(viewport={"width": width, "height": height})
        first, *others = pictures(page, given)
        still(browser.new_page(viewport={"width": 1366, "height": 768}), given)
        browser.close()
    first.save(
        given.folder / "walking.webp",
        save_all=True,
        append_images=others,
        duration=round(1000 / given.rate),
        loop=0,
        quality=given.quality,
        method=6,
    )


if __name__ == "__main__":
    main()
