"""Scenarios of JuPedSim's web editor as floor plans: a geometry and its exits."""

import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats.assembling.drawn import assembled
from mesa_mobility.floorplan.formats.assembling.exit_areas import WayOut
from mesa_mobility.floorplan.formats.assembling.texts import (
    LARGEST_FILE,
    decoded,
    parsed,
    read_bytes,
)
from mesa_mobility.floorplan.formats.assembling.values import mapping_of, ring_of
from mesa_mobility.floorplan.formats.bare_wkt import drawn_of
from mesa_mobility.floorplan.formats.content import Content
from mesa_mobility.floorplan.formats.plan_format import PlanFormat

CONFIG, GEOMETRY = "config.json", "geometry.wkt"
"""Files of a scenario."""

_BROKEN = (OSError, zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, ValueError)
"""What ``zipfile`` raises for a damaged archive depends on where it is damaged."""

MOST = 10_000
"""Exits of a scenario, and files of an archive."""


class JuPedSimScenario(PlanFormat):
    """Scenario of JuPedSim, zip or folder: floor and exits. People are left out."""

    name = "jupedsim_scenario"
    suffixes = (".zip",)

    def read(self, path: Path) -> Content:
        """Read the geometry and the exits of a scenario.

        Raises:
            FloorPlanError: the file cannot be read, or is no such scenario.
        """
        files = {name: decoded(data, f"{path}: {name}", "text") for name, data in _files(path)}
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


def _files(path: Path) -> list[tuple[str, bytes]]:
    """The two files of a scenario, of a folder or an archive."""
    if path.is_dir():
        return [(name, read_bytes(path / name)) for name in (GEOMETRY, CONFIG)]
    try:
        with zipfile.ZipFile(path) as archive:
            return [(name, _member(archive, name, path)) for name in (GEOMETRY, CONFIG)]
    except FloorPlanError:
        raise
    except (
        OSError,
        zipfile.BadZipFile,
        zlib.error,
        EOFError,
        NotImplementedError,
        RuntimeError,
        ValueError,
    ) as error:
        reason = " ".join(str(error).split())[:100]
        raise FloorPlanError(f"{path}: is not a zip that can be read ({reason})") from None


def _member(archive: zipfile.ZipFile, name: str, path: Path) -> bytes:
    """A file that is in an archive once, in any folder."""
    names = [each for each in archive.infolist() if each.filename.rpartition("/")[2] == name]
    if len(names) != 1:
        raise FloorPlanError(f"{path}: has {len(names)} files {name}, expected one")
    with archive.open(names[0]) as file:
        data = file.read(LARGEST_FILE + 1)
    if len(data) > LARGEST_FILE:
        raise FloorPlanError(f"{path}: {name}: more than {LARGEST_FILE / 1e6:g} MB")
    return data
