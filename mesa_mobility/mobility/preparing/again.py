"""Load the recordings that an existing map was built from, prepared in the same way."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from mesa_mobility.capture import Manifest, Recording, scale
from mesa_mobility.mobility.preparing.clips import (
    ALONE,
    BOTH,
    STANDING_TYPE,
    PreparedRecordings,
    prepare_recordings,
)
from mesa_mobility.mobility.preparing.derived import DERIVED_TYPES
from mesa_mobility.mobility.preparing.stairs import on_long_stairs

if TYPE_CHECKING:
    from mesa_mobility.mobility.map import MobilityMap


def recordings_behind(
    map_: MobilityMap, manifest: Manifest, progress: Callable[[int, int], None] | None = None
) -> PreparedRecordings:
    """Load the recordings that a map was built from, mirrored, scaled or repeated as for it.

    Args:
        map_: the map.
        manifest: the clips.
        progress: called as ``progress(done, total)`` after each clip.

    Raises:
        CaptureError: as ``load_clips`` does.
    """
    # Older maps tell by clip.
    sides = map_.metadata.get("preparation", {}).get("mirrored")
    each = [clip["mirrored"] for clip in map_.metadata.get("provenance", [])]
    prepared = prepare_recordings(
        manifest,
        _recorded_type(map_, manifest),
        mirrored=sides == BOTH if sides else all(each),
        other_side=sides == ALONE,
        progress=progress,
    )
    derived = map_.metadata.get("derived")
    if derived is not None and "tread_m" in derived:
        prepared.recordings[:], _ = on_long_stairs(
            prepared.recordings, up=derived["direction"] == "up", tread=derived["tread_m"]
        )
    elif derived is not None:
        length, time = _factors(derived, prepared.recordings)
        prepared.recordings[:] = [scale(one, length, time) for one in prepared.recordings]
    return prepared


def _recorded_type(map_: MobilityMap, manifest: Manifest) -> str:
    """Type of the recordings; a map's own may be another, as ``limping_left``."""
    behind = {clip.get("sha256") for clip in map_.metadata.get("provenance", [])} - {None}
    types = {clip.type for clip in manifest if clip.sha256 in behind} - {STANDING_TYPE}
    if len(types) == 1:
        return types.pop()
    return str(map_.metadata.get("derived", {}).get("from", map_.pedestrian_type))


def _factors(derived: dict[str, Any], recordings: Sequence[Recording]) -> tuple[float, float]:
    """Factors of lengths and times to the last bit, of which the metadata have four decimals."""
    rounded = derived["length_factor"], derived["time_factor"]
    for plan in DERIVED_TYPES.values():
        if plan.source == derived["from"] and round(plan.length, 4) == rounded[0]:
            time = plan.time_factor(recordings)
            if round(time, 4) == rounded[1]:
                return plan.length, time
    return rounded
