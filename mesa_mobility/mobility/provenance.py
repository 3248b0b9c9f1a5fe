"""Provenance of the clips behind a map, and acknowledgements."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mesa_mobility.capture import Recording

_ACKNOWLEDGEMENTS = {
    "CMU": (
        "The data used in this project was obtained from mocap.cs.cmu.edu. "
        "The database was created with funding from NSF EIA-0196217."
    ),
    "ACCAD": "Motion capture by ACCAD, The Ohio State University, licensed CC BY 3.0.",
}
"""Acknowledgements that sources require, by a word of their licence."""


def provenance(recordings: Sequence[Recording]) -> list[dict[str, Any]]:
    """One entry a clip, in order; a mirrored clip stands with its original."""
    entries: dict[str, dict[str, Any]] = {}
    for recording in recordings:
        clip = recording.clip
        key = recording.name.removesuffix("~mirror")
        entry = entries.setdefault(key, {"clip": key, "poses": recording.frames, "mirrored": False})
        if recording.name != key:
            entry["mirrored"] = True
        if clip is not None:
            entry.update(
                session=clip.session,
                subject=clip.subject,
                description=clip.description,
                licence=clip.licence,
                source=f"{clip.source_repo}@{clip.source_commit}:{clip.source_path}",
                sha256=clip.sha256,
            )
    return list(entries.values())


def acknowledgements(recordings: Sequence[Recording]) -> list[str]:
    """Acknowledgements required by the sources of the recordings."""
    licences = {r.clip.licence for r in recordings if r.clip is not None and r.clip.licence}
    said = set()
    for licence in licences:
        known = [text for word, text in _ACKNOWLEDGEMENTS.items() if word in licence]
        said.update(known or [f"Recordings under: {licence}"])
    return sorted(said)
