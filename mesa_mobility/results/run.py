"""The folder of files that a run leaves behind."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.excerpts import title_of
from mesa_mobility.results.files import all_or_none, json_text
from mesa_mobility.results.measures.by_type import occupancy_by_type
from mesa_mobility.results.measures.occupancy import egress_time, occupancy
from mesa_mobility.results.tracks import Tracks
from mesa_mobility.results.trajectories import Trajectories, read_parquet

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan

SUMMARY, TRAJECTORIES = "summary.json", "trajectories.parquet"
DECISIONS = "decisions.parquet"

RUN_FILES = (
    TRAJECTORIES,
    DECISIONS,
    "floorplan.geojson",
    "occupancy.png",
    "trajectories.png",
    SUMMARY,
)


def write_run(
    directory: str | os.PathLike[str],
    *,
    summary: Mapping[str, Any],
    trajectories: Trajectories,
    plan: FloorPlan | Building,
    reference_occupancy: Mapping[float, float] | None = None,
) -> None:
    """Write summary.json, trajectories.parquet, floorplan.geojson and two pictures.

    Decisions are written to decisions.parquet, if there are any.

    Either all of them are written or none is; where the process is killed meanwhile, summary.json
    is missing.

    Args:
        directory: folder to write to, created if need be.
        summary: figures of the run; `model`, `seed` and `preset` go into the pictures' titles.
        trajectories: the run.
        plan: its floor plan, or its building.
        reference_occupancy: time (s) -> people inside, drawn beside the run's.

    Raises:
        ResultsError: the folder or a file cannot be written.
    """
    # Matplotlib takes half a second to load, so it is imported only when pictures are drawn.
    from mesa_mobility.results.plots import plot_occupancy, plot_trajectories

    title = title_of(summary, trajectories)
    with all_or_none(directory, RUN_FILES) as temporary:
        text = json_text(summary, indent=2) + "\n"
        (temporary / SUMMARY).write_text(text, encoding="utf-8")
        trajectories.to_parquet(temporary / TRAJECTORIES)
        if trajectories.decisions is not None:
            trajectories.decisions.to_parquet(temporary / DECISIONS)
        plan.write_geojson(temporary / "floorplan.geojson")
        plot_occupancy(
            occupancy_curve(trajectories),
            temporary / "occupancy.png",
            by_type=occupancy_curves_by_type(trajectories),
            reference=reference_occupancy,
            title=title,
        )
        plot_trajectories(trajectories, plan, temporary / "trajectories.png", title=title)


@dataclass(frozen=True)
class Run:
    """A run as its folder holds it.

    Attributes:
        trajectories: with the decisions, if they were recorded.
        plan: its floor plan, or its building.
        summary: its figures.
        folder: where it is; None for a run that has not been saved.
    """

    trajectories: Trajectories
    plan: FloorPlan | Building
    summary: Mapping[str, Any]
    folder: Path | None = None

    @property
    def floor_plan(self) -> FloorPlan:
        """Its one floor plan.

        Raises:
            ResultsError: it is a run in a building.
        """
        from mesa_mobility.floorplan import FloorPlan

        if not isinstance(self.plan, FloorPlan):
            raise ResultsError(
                f"{self.folder}: a run in a building of {len(self.plan.levels)} levels, expected "
                "one on a floor plan"
            )
        return self.plan

    def on(self, level: int) -> Run:
        """The part of a run in a building that is on one level, without decisions.

        Raises:
            ResultsError: a run on a floor plan.
            FloorPlanError: there is no such level.
        """
        from mesa_mobility.floorplan import FloorPlan

        if isinstance(self.plan, FloorPlan):
            raise ResultsError(f"{self.folder}: a run on a floor plan, expected one in a building")
        plan = self.plan.floor_plan_of(level)
        return replace(self, trajectories=self.trajectories.on(level=level), plan=plan)


def read_run(directory: str | os.PathLike[str]) -> Run:
    """Read the folder of a run.

    Raises:
        ResultsError: no folder of a complete run, or a damaged file.
        FloorPlanError: a damaged floor plan.
    """
    from mesa_mobility.buildings import read_floor
    from mesa_mobility.results.decisions import read_decisions

    folder = Path(directory)
    try:
        summary = json.loads((folder / SUMMARY).read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise ResultsError(
            f"{folder}: no summary.json, expected the folder of a run, "
            "which `mesa-mobility run --out` writes"
        ) from None
    except (OSError, ValueError, RecursionError) as error:
        raise ResultsError(f"{folder / SUMMARY}: cannot be read: {error}") from error
    if not isinstance(summary, dict):
        raise ResultsError(f"{folder / SUMMARY}: not a JSON object")
    trajectories = read_parquet(folder / TRAJECTORIES)
    decided = folder / DECISIONS
    if decided.exists():
        trajectories = replace(trajectories, decisions=read_decisions(decided))
    return Run(trajectories, read_floor(folder / "floorplan.geojson"), summary, folder)


def occupancy_curve(trajectories: Tracks) -> list[list[float]]:
    """``occupancy``, with the time at which the last person left."""
    curve, egress = occupancy(trajectories), egress_time(trajectories)
    # The last person rarely leaves on a full second.
    return curve if egress is None or egress <= curve[-1][0] else [*curve, [egress, 0]]


def occupancy_curves_by_type(trajectories: Tracks) -> dict[str, list[list[float]]] | None:
    """``occupancy_by_type``, or None where there is one type, or none is known."""
    if "type" not in trajectories.person_data:
        return None
    curves = occupancy_by_type(trajectories)
    return curves if len(curves) > 1 else None
