"""What a map's examination has found, as its metadata keep it.

The tests walk people through doors and corridors, so they are above the crowd, in
``mesa_mobility.examination``. A map keeps what was measured in the tests that it has failed. Of
those that it has passed it keeps nothing, so the file of a good map depends on its recordings
alone.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from mesa_mobility.mobility.map import MobilityMap

KEY, FAILED = "examination", "failed"
"""Where the metadata have them."""


def with_verdict(map_: MobilityMap, failed: Mapping[str, Mapping[str, Any]]) -> MobilityMap:
    """A copy of a map that has failed these tests, with what was measured, and passed the rest."""
    said = {test: dict(measured) for test, measured in failed.items()}
    return replace(map_, metadata={**map_.metadata, KEY: {FAILED: said}})


def failed_tests(map_: MobilityMap) -> dict[str, Any] | None:
    """The tests that a map has failed, by name; None if it has never been examined."""
    said = map_.metadata.get(KEY)
    failed = said.get(FAILED) if isinstance(said, Mapping) else None
    return dict(failed) if isinstance(failed, Mapping) else None


def warn_unless_passed(map_: MobilityMap) -> None:
    """Warn of a map that has failed a test or has never been examined."""
    failed = failed_tests(map_)
    if failed == {}:
        return
    name = map_.pedestrian_type
    if failed is None:
        said = (
            f"the map {name!r} has never been examined, and what its people cannot do is not "
            "known: `mesa-mobility map info` examines it, and mesa_mobility.examination.examined "
            "notes the result in it"
        )
    else:
        said = (
            f"the map {name!r} has failed its examination ({', '.join(failed)}): "
            "`mesa-mobility map info` says what was measured and what helps"
        )
    warnings.warn(said, stacklevel=2)
