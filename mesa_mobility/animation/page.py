"""A page that plays a run in three dimensions, in one file that needs no network."""

from __future__ import annotations

import base64
import html
import os
import tempfile
from collections.abc import Callable, Iterable
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING

from mesa_mobility.animation.gltf import write_glb
from mesa_mobility.animation.people import Walker
from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing

if TYPE_CHECKING:
    from mesa_mobility.floorplan import FloorPlan


def write_page(
    people: Iterable[Walker],
    plan: FloorPlan,
    path: str | os.PathLike[str],
    *,
    title: str,
    progress: Callable[[int], None] | None = None,
) -> None:
    """Write a page with a run, its player and all that it needs.

    Args:
        people: those shown.
        plan: floor and walls.
        path: the page (.html).
        title: shown on it.
        progress: called with the number of people done.

    Raises:
        ResultsError: the file cannot be written, or pygltflib is not installed.
    """
    folder = files("mesa_mobility.animation") / "viewer"

    def part(name: str) -> str:
        return (folder / name).read_text(encoding="utf-8")

    with tempfile.TemporaryDirectory() as temporary:
        model = Path(temporary) / "crowd.glb"
        write_glb(people, plan, model, progress=progress)
        content = base64.b64encode(model.read_bytes()).decode()
    page = Template(part("page.html")).substitute(
        title=html.escape(title),
        # Would end the script early.
        three=part("three.bundle.js").replace("</script", "<\\/script"),
        file=content,
        viewer=part("viewer.js"),
    )
    with replacing(path, ResultsError) as target:
        target.write_text(page, encoding="utf-8")
