"""Scenarios of JuPedSim's web editor as floor plans: a geometry and its exits."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats.assembling.archives import members, names_in
from mesa_mobility.floorplan.formats.assembling.drawn import assembled
from mesa_mobility.floorplan.formats.assembling.exit_areas import WayOut
from mesa_mobility.floorplan.formats.assembling.texts import parsed
from mesa_mobility.floorplan.formats.assembling.values import mapping_of, ring_of
from mesa_mobility.floorplan.formats.bare_wkt import drawn_of
from mesa_mobility.floorplan.formats.content import Content
from mesa_mobility.floorplan.formats.plan_format import PlanFormat

CONFIG, GEOMETRY = "config.json", "geometry.wkt"
"""Files of a scenario."""

MOST = 10_000
"""Exits of a scenario."""


class JuPedSimScenario(PlanFormat):
    """Scenario of JuPedSim, zip or folder: floor and exits. People are left out."""

    name = "jupedsim_scenario"
    suffixes = (".zip",)

    def takes(self, path: Path) -> bool:
        """Whether an archive or a folder has one of the files of a scenario."""
        return bool({GEOMETRY, CONFIG} & set(names_in(path)))

    def read(self, path: Path) -> Content:
        """Read the geometry and the exits of a scenario.

        Raises:
            FloorPlanError: the file cannot be read, or is no such scenario.
        """
        files = members(path, (GEOMETRY, CONFIG))
        drawn = drawn_of(files[GEOMETRY].strip(), f"{path}: {GEOMETRY}")
        config = mapping_of(parsed(files[CONFIG], f"{path}: {CONFIG}"), f"{path}: {CONFIG}")
        at = f"{path}: {CONFIG}: exits"
        exits = mapping_of(config.get("exits"), at)
        if len(exits) > MOST:
            raise FloorPlanError(f"{at}: {len(exits):,}, expected at most {MOST:,}")
        for key, each in exits.items():
            points = mapping_of(each, f"{at}: {key:.40}").get("coordinates")
            drawn.ways_out.append(WayOut(key[:40] or "exit", ring_of(points, f"{at}: {key:.40}")))
        drawn.notes += _left_out(config)
        return assembled(drawn, str(path))


def _left_out(config: Mapping[str, Any]) -> list[str]:
    """What a scenario has besides a floor and exits."""
    kinds = (
        "distributions",
        "checkpoints",
        "waypoints",
        "zones",
        "stages",
        "journeys",
        "transitions",
    )
    counts = {
        kind: len(config[kind]) for kind in kinds if isinstance(config.get(kind), dict | list)
    }
    said = [f"{count} {kind}" for kind, count in counts.items() if count]
    return [f"left out {', '.join(said)}: this is the floor plan alone"] if said else []
