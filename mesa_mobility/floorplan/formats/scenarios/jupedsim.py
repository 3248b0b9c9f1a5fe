"""Scenarios of JuPedSim's web editor: a geometry, its exits, zones and people."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.zones import SpeedZone
from mesa_mobility.floorplan.formats.assembling.archives import members, names_in
from mesa_mobility.floorplan.formats.assembling.drawn import Drawn, assembled
from mesa_mobility.floorplan.formats.assembling.exit_areas import WayOut
from mesa_mobility.floorplan.formats.assembling.parts import polygons_of
from mesa_mobility.floorplan.formats.assembling.texts import parsed
from mesa_mobility.floorplan.formats.assembling.values import mapping_of, number_of, ring_of
from mesa_mobility.floorplan.formats.bare_wkt import drawn_of
from mesa_mobility.floorplan.formats.content import Content
from mesa_mobility.floorplan.formats.people import left_out
from mesa_mobility.floorplan.formats.plan_format import PlanFormat
from mesa_mobility.floorplan.formats.scenarios.jupedsim_people import exit_name, people_of

CONFIG, GEOMETRY = "config.json", "geometry.wkt"
"""Files of a scenario."""

MOST = 10_000
"""Exits of a scenario."""


class JuPedSimScenario(PlanFormat):
    """Scenario of JuPedSim, zip or folder: floor, exits, people and their journeys."""

    name = "jupedsim_scenario"
    suffixes = (".zip",)

    def has_people(self, path: Path) -> bool:
        """All such files do."""
        return True

    def takes(self, path: Path) -> bool:
        """Whether an archive or a folder has one of the files of a scenario."""
        return bool({GEOMETRY, CONFIG} & set(names_in(path)))

    def read(self, path: Path) -> Content:
        """Read the geometry, the exits and the people of a scenario.

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
            drawn.ways_out.append(WayOut(exit_name(key), ring_of(points, f"{at}: {key:.40}")))
        where = f"{path}: {CONFIG}"
        _add_zones(drawn, mapping_of(config.get("zones"), f"{where}: zones"), where)
        throttled = sum(
            mapping_of(each, at).get("enable_throughput_throttling") is True
            for each in exits.values()
        )
        people = people_of(config, where, drawn.notes)
        counts = {"greatest throughputs of exits": throttled}
        counts |= {kind: _size(config.get(kind)) for kind in ("journeys", "transitions", "stages")}
        drawn.notes += left_out(counts)
        content = assembled(drawn, str(path))
        content.people = people
        return content


def _size(value: Any) -> int:
    return len(value) if isinstance(value, dict | list) else 0


def _add_zones(drawn: Drawn, zones: Mapping[str, Any], where: str) -> None:
    """Zones in which people walk at a share of their speed."""
    for key, each in list(zones.items())[:MOST]:
        at = f"{where}: {key:.40}"
        zone = mapping_of(each, at)
        factor = number_of(zone.get("speed_factor"), f"{at}: speed_factor", 1.0)
        if not 0 < factor < 1:
            drawn.notes.append(f"left out {key:.40}: its speed factor is {factor:g}")
            continue
        for part in polygons_of(ring_of(zone.get("coordinates"), at), at, drawn.notes):
            drawn.zones.append(SpeedZone(part.polygon, factor, f"{key:.40}"))
