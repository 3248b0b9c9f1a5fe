"""Draw tracks with and without what makes people walk steadily: docs/images/tracks.png.

python docs/tracks_picture.py docs/images/tracks.png

`WITHOUT` lacks the terms `velocity_change` and `speed_ahead`, the tactic `anticipation` and the
limit of accelerations.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from io import BytesIO

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Source, Visit
from mesa_mobility.crowd import PRESETS, Preset
from mesa_mobility.plugins.registry import load_model
from mesa_mobility.results import Trajectories
from mesa_mobility.validation.bottleneck import plan as bottleneck_plan
from mesa_mobility.validation.corridor import RECORDED
from mesa_mobility.validation.scenes.corridors import ENTRY, LENGTH, SETTLE_S, WIDTH
from mesa_mobility.verification.runs import CLEARANCE, SPACING, crowd_model

FloatArray = NDArray[np.float64]

SEED = 1
BAR = 2.0
"""Length of the bar below each panel, metres."""
RED, BLUE = "#b2182b", "#2166ac"
WITHOUT = replace(
    PRESETS["default"],
    name="without",
    terms={
        name: weight
        for name, weight in PRESETS["default"].terms.items()
        if name not in ("velocity_change", "speed_ahead")
    },
    settings={
        name: numbers
        for name, numbers in PRESETS["default"].settings.items()
        if name not in ("velocity_change", "speed_ahead", "anticipation")
    },
    most_acceleration=None,
    tactics=tuple(name for name in PRESETS["default"].tactics if name != "anticipation"),
)
"""The preset without what has people keep their velocity, follow those ahead and look ahead."""

ROWS = {"without": WITHOUT, "default preset": PRESETS["default"]}


def corridor(preset: Preset) -> PedestrianModel:
    """One way along a corridor that is fed at one end, 1.1 persons/m2 (experiment ``motion``)."""
    density, speed = 1.1, 1.208
    plan = FloorPlan(
        box(0.0, 0.0, LENGTH, WIDTH), exits=[Exit("end", (LENGTH, 0.0), (LENGTH, WIDTH))]
    )
    model = crowd_model(plan, SEED, preset=preset)
    people = round(density * LENGTH * WIDTH)
    places = plan.random_points(people, model.rng, spacing=SPACING, clearance=CLEARANCE)
    model.add_pedestrians(places, preferred_speeds=RECORDED.draw(people, model.rng))
    model.add_source(Source(area=ENTRY, rate=density * speed * WIDTH, preferred_speeds=RECORDED))
    return model


def head_on(preset: Preset) -> PedestrianModel:
    """Two people walk towards each other."""
    ends = [Exit("east", (12.0, 0.0), (12.0, 6.0)), Exit("west", (0.0, 0.0), (0.0, 6.0))]
    model = crowd_model(FloorPlan(box(0.0, 0.0, 12.0, 6.0), exits=ends), SEED, preset=preset)
    model.add_pedestrians([(1.0, 3.0)], preferred_speeds=1.34, exits=["east"])
    model.add_pedestrians([(11.0, 3.0)], preferred_speeds=1.34, exits=["west"])
    return model


def doorway(preset: Preset) -> PedestrianModel:
    """The shipped model."""
    return load_model("doorway")(preset=preset, record=True, rng=SEED)


def queue(preset: Preset) -> PedestrianModel:
    """Forty people before a door of 1 m."""
    plan = bottleneck_plan(1.0)
    model = crowd_model(plan, SEED, preset=preset)
    start = box(-3.0, -6.5, 3.0, -1.0)
    places = plan.random_points(40, model.rng, within=start, spacing=SPACING, clearance=CLEARANCE)
    model.add_pedestrians(places)
    return model


def crossing_flows(preset: Preset) -> PedestrianModel:
    """Two streams 4 m wide cross a square at right angles."""
    plan = FloorPlan(
        box(-7.0, 0.0, 10.0, 10.0).union(box(0.0, -7.0, 10.0, 10.0)),
        exits=[
            Exit("east", (10.0, 0.0), (10.0, 10.0)),
            Exit("north", (0.0, 10.0), (10.0, 10.0)),
        ],
    )
    model = crowd_model(plan, SEED, preset=preset)
    for start, leaves in (
        (box(-7.0, 3.0, 0.0, 7.0), "east"),
        (box(3.0, -7.0, 7.0, 0.0), "north"),
    ):
        places = plan.random_points(
            25, model.rng, within=start, spacing=SPACING, clearance=CLEARANCE
        )
        model.add_pedestrians(places, exits=[leaves])
    return model


def circle(preset: Preset) -> PedestrianModel:
    """Thirty people on a circle of 6 m radius, each with the place opposite as its target."""
    plan = FloorPlan(box(-8.0, -8.0, 8.0, 8.0), exits=[Exit("out", (-8.0, -8.0), (-6.5, -8.0))])
    model = crowd_model(plan, SEED, preset=preset)
    angles = np.linspace(0.0, 2.0 * np.pi, 30, endpoint=False)
    for place in 6.0 * np.column_stack([np.cos(angles), np.sin(angles)]):
        model.add_pedestrians([place], route=[Visit(tuple(-place), stay=300.0)])
    return model


@dataclass(frozen=True)
class Scene:
    """A column of the picture.

    Attributes:
        title: above the column.
        make: the model of a preset.
        seconds: from when until when tracks are drawn.
        view: least x and y, greatest x and y, metres.
        colour_by: of the first place of each track, (n, 2) metres, a number from 0 to 1 per person.
        colours: name of the colour map.
    """

    title: str
    make: Callable[[Preset], PedestrianModel]
    seconds: tuple[float, float]
    view: tuple[float, float, float, float]
    colour_by: Callable[[FloatArray], FloatArray]
    colours: str = "turbo"


SCENES = (
    Scene("unidirectional flow, 1.1 m⁻²", corridor, (SETTLE_S, SETTLE_S + 10.0),
          (12.0, 0.0, 20.0, WIDTH), lambda p: p[:, 1] / WIDTH),
    Scene("two people head-on", head_on, (0.0, 12.0), (1.0, 1.5, 11.0, 4.5),
          lambda p: (p[:, 0] > 6.0) * 1.0, "two"),
    Scene("doorway, first 15 s", doorway, (0.0, 15.0), (0.0, 0.0, 18.2, 10.0),
          lambda p: p[:, 1] / 10.0),
    Scene("queue before a door of 1.0 m", queue, (0.0, 60.0), (-4.0, -6.6, 4.0, 2.0),
          lambda p: (p[:, 0] + 3.0) / 6.0),
    Scene("crossing flows, 90°", crossing_flows, (0.0, 40.0), (-1.5, -1.5, 10.0, 10.0),
          lambda p: (p[:, 1] < 0.0) * 1.0, "two"),
    Scene("antipodal circle, 30 people", circle, (0.0, 40.0), (-6.3, -6.3, 6.3, 6.3),
          lambda p: np.arctan2(p[:, 1], p[:, 0]) / (2.0 * np.pi) % 1.0, "hsv"),
)  # fmt: skip


def tracks_of(scene: Scene, preset: Preset) -> tuple[list[FloatArray], FloatArray, FloatArray]:
    """The (k, 2) places of each person meanwhile, its (n, 2) first place, and the walls."""
    start, end = scene.seconds
    model = scene.make(preset)
    while model.elapsed < end and model.inside:
        model.step()
    found = Trajectories.of(model)
    places = np.column_stack([found.x, found.y])
    shown = found.frame >= start * found.frame_rate
    tracks = [places[shown & (found.person == person)] for person in np.unique(found.person)]
    tracks = [track for track in tracks if len(track)]
    return tracks, np.array([track[0] for track in tracks]), model.floor_plan.walls


def draw_scene(axes: Axes, scene: Scene, preset: Preset) -> None:
    """One line per person."""
    tracks, first, walls = tracks_of(scene, preset)
    shares = np.clip(scene.colour_by(first), 0.0, 1.0)
    if scene.colours == "two":
        colours = [BLUE if share else RED for share in shares]
    else:
        colours = list(colormaps[scene.colours](0.05 + 0.9 * shares))
    axes.add_collection(LineCollection(walls.reshape(-1, 2, 2), colors="#333333", linewidths=1.2))
    axes.add_collection(LineCollection(tracks, colors=colours, linewidths=0.6, alpha=0.85))
    x0, y0, x1, y1 = scene.view
    axes.set(aspect="equal", xlim=(x0 - 0.1, x1 + 0.1), ylim=(y0 - 0.1, y1 + 0.1))
    axes.set(xticks=[], yticks=[])
    axes.spines[["top", "left", "right"]].set_visible(False)
    axes.spines.bottom.set_bounds(x0, x0 + BAR)


def draw(picture: str) -> None:
    """Run the scenes and draw them."""
    figure = Figure(figsize=(18.0, 5.8), dpi=100, layout="constrained")
    widths = [1.15, 0.95, 1.6, 0.95, 1.1, 1.15]
    panels = figure.subplots(len(ROWS), len(SCENES), width_ratios=widths)
    for row, (name, preset) in zip(panels, ROWS.items(), strict=True):
        row[0].set_ylabel(name, fontsize=12)
        for axes, scene in zip(row, SCENES, strict=True):
            draw_scene(axes, scene, preset)
    for axes, scene in zip(panels[0], SCENES, strict=True):
        axes.set_title(scene.title, fontsize=11)
    for axes in panels[-1]:
        axes.set_xlabel(f"bar: {BAR:g} m", loc="left", fontsize=9)
    drawn = BytesIO()
    figure.savefig(drawn)
    # Of 256 colours, half as large.
    Image.open(drawn).convert("RGB").quantize(256).save(picture, optimize=True)


if __name__ == "__main__":
    draw(*sys.argv[1:])
