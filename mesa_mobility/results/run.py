"""The folder of files that a run leaves behind."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from mesa_mobility.results.by_type import occupancy_by_type
from mesa_mobility.results.files import all_or_none, json_text
from mesa_mobility.results.measures import egress_time, occupancy
from mesa_mobility.results.trajectories import Trajectories

if TYPE_CHECKING:
    from mesa_mobility.floorplan import FloorPlan

RUN_FILES = (
    "trajectories.parquet",
    "floorplan.geojson",
    "occupancy.png",
    "trajectories.png",
    "summary.json",
)


def write_run(
    directory: str | os.PathLike[str],
    *,
    summary: Mapping[str, Any],
    trajectories: Trajectories,
    plan: FloorPlan,
    reference_occupancy: Mapping[float, float] | None = None,
) -> None:
    """Write summary.json, trajectories.parquet, floorplan.geojson and two pictures.

    Either all of them are written or none is; where the process is killed meanwhile, summary.json
    is missing.

    Args:
        directory: folder to write to, created if need be.
        summary: figures of the run; `model`, `seed` and `preset` go into the pictures' titles.
        trajectories: the run.
        plan: its floor plan.
        reference_occupancy: time (s) -> people inside, drawn beside the run's.

    Raises:
        ResultsError: the folder or a file cannot be written.
    """
    # Matplotlib takes half a second to load, so it is imported only when pictures are drawn.
    from mesa_mobility.results.plots import plot_occupancy, plot_trajectories

    title = _title(summary, trajectories)
    with all_or_none(directory, RUN_FILES) as temporary:
        text = json_text(summary, indent=2) + "\n"
        (temporary / "summary.json").write_text(text, encoding="utf-8")
        trajectories.to_parquet(temporary / "trajectories.parquet")
        plan.write_geojson(temporary / "floorplan.geojson")
        plot_occupancy(
            _curve(trajectories),
            temporary / "occupancy.png",
            by_type=_curves_by_type(trajectories),
            reference=reference_occupancy,
            title=title,
        )
        plot_trajectories(trajectories, plan, temporary / "trajectories.png", title=title)


def _curve(trajectories: Trajectories) -> list[list[float]]:
    curve, egress = occupancy(trajectories), egress_time(trajectories)
    # The last person rarely leaves on a full second.
    return curve if egress is None or egress <= curve[-1][0] else [*curve, [egress, 0]]


def _curves_by_type(trajectories: Trajectories) -> dict[str, list[list[float]]] | None:
    """Occupancy by type, where there are several."""
    if "type" not in trajectories.person_data:
        return None
    curves = occupancy_by_type(trajectories)
    return curves if len(curves) > 1 else None


def _title(summary: Mapping[str, Any], trajectories: Trajectories) -> str:
    egress = summary.get("egress_s")
    left = summary.get("left_inside", 0)
    ending = (
        f"all out after {egress:.0f} s"
        if egress is not None
        else f"{left} still inside after {trajectories.duration:.0f} s"
    )
    run = ", ".join(f"{key} {summary[key]}" for key in ("preset", "seed") if key in summary)
    name = str(summary.get("model", "run")).replace("_", " ")
    return f"{name}: {trajectories.people} people, {ending}" + (f" ({run})" if run else "")
