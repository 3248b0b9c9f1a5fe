"""Manifests: tables of clips with their content and origin."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from mesa_mobility.capture.motion import FRAME_TIME_S
from mesa_mobility.capture.text import (
    check_unit,
    number,
    quote,
    read_bytes,
    text_lines,
    whole_number,
)
from mesa_mobility.errors import CaptureError

COLUMNS = (
    "file",
    "type",
    "session",
    "subject",
    "clip",
    "description",
    "tags",
    "native_fps",
    "use_from",
    "use_to",
    "unit_to_m",
    "licence",
    "source_repo",
    "source_commit",
    "source_path",
    "sha256",
)
"""Columns that a manifest must have, in any order; others are ignored."""

UNKNOWN_TYPE = ""
"""Pedestrian type of a clip that no manifest describes."""

_CONVERTED = ("tags", "native_fps", "use_from", "use_to", "unit_to_m")


@dataclass(frozen=True)
class Clip:
    """One recording: a row of a manifest.

    Attributes:
        file: path of the recording, as the manifest has it.
        type: pedestrian type, such as "able_bodied"; empty where it is not known.
        session: recordings that belong together.
        subject: who moved.
        clip: name of the clip.
        description: what happens.
        tags: kinds of movement.
        native_fps: frames a second of the file.
        use_from: first native frame that is fit for use.
        use_to: the frame after the last one fit for use.
        unit_to_m: metres in one unit of the file.
        licence: terms of use.
        source_repo: where the file was published.
        source_commit: version of the publication.
        source_path: file in the publication.
        sha256: of the uncompressed recording.
        path: where the file is.
        where: manifest and line, for errors.
    """

    file: str
    type: str
    session: str
    subject: str
    clip: str
    description: str
    tags: tuple[str, ...]
    native_fps: float
    use_from: int
    use_to: int
    unit_to_m: float
    licence: str
    source_repo: str
    source_commit: str
    source_path: str
    sha256: str
    path: Path
    where: str

    def read(self) -> bytes:
        """Uncompressed content of the recording.

        Raises:
            CaptureError: the file cannot be read, or its sha256 is another.
        """
        data = read_bytes(self.path)
        found = hashlib.sha256(data).hexdigest()
        if found != self.sha256.lower():
            raise CaptureError(
                f"{self.where}: {self.file} has sha256 {found}, expected {self.sha256}"
            )
        return data


@dataclass(frozen=True)
class Manifest:
    """The clips of a manifest, in its order."""

    path: Path
    clips: tuple[Clip, ...]

    def __len__(self) -> int:
        return len(self.clips)

    def __iter__(self) -> Iterator[Clip]:
        return iter(self.clips)


def read_manifest(path: str | Path) -> Manifest:
    """Read a manifest: tab-separated, one header line, one line a clip.

    Files are named relative to the manifest.  They must exist; their sha256 is checked when they
    are read.

    Raises:
        CaptureError: the manifest cannot be read, lacks a column, has no clips, names a file
            twice, has a value that is out of range, or names a file that does not exist.
    """
    path = Path(path)
    lines = text_lines(read_bytes(path), path)
    header = [column.strip() for column in lines[0].split("\t")]
    for column in COLUMNS:
        if column not in header:
            raise CaptureError(
                f"{path}, line 1: no column {column!r}, expected {', '.join(COLUMNS)}"
            )
    clips: list[Clip] = []
    lines_of: dict[str, int] = {}
    for line, text in enumerate(lines[1:], start=2):
        if not text.strip():
            continue
        where = f"{path}, line {line}"
        row = text.split("\t")
        if len(row) != len(header):
            raise CaptureError(f"{where}: {len(row)} columns, expected {len(header)}")
        clip = _clip(dict(zip(header, row, strict=True)), path, where)
        if clip.file in lines_of:
            raise CaptureError(
                f"{where}: file {quote(clip.file)} is on line {lines_of[clip.file]} too"
            )
        lines_of[clip.file] = line
        clips.append(clip)
    if not clips:
        raise CaptureError(f"{path}: no clips, expected one line for each")
    return Manifest(path, tuple(clips))


def _clip(row: dict[str, str], path: Path, where: str) -> Clip:
    row = {key: value.strip() for key, value in row.items()}
    for column in ("file", "type", "clip", "sha256"):
        if not row[column]:
            raise CaptureError(f"{where}: column {column} is empty")
    native_fps = number(row["native_fps"], f"{where}, native_fps")
    unit_to_m = number(row["unit_to_m"], f"{where}, unit_to_m")
    shortest, longest = FRAME_TIME_S
    if not 1 / longest <= native_fps <= 1 / shortest:
        raise CaptureError(
            f"{where}: native_fps {native_fps:g}, expected {1 / longest:g} to {1 / shortest:g} Hz"
        )
    check_unit(unit_to_m, f"{where}, unit_to_m")
    use_from = whole_number(row["use_from"], f"{where}, use_from")
    use_to = whole_number(row["use_to"], f"{where}, use_to")
    if not 0 <= use_from < use_to:
        raise CaptureError(f"{where}: frames {use_from}:{use_to}, expected 0 <= use_from < use_to")
    recording = path.parent / row["file"]
    if not recording.is_file():
        raise CaptureError(f"{where}: no file {quote(row['file'])} beside the manifest")
    return Clip(
        **{name: row[name] for name in COLUMNS if name not in _CONVERTED},
        tags=tuple(tag for tag in row["tags"].split(",") if tag),
        native_fps=native_fps,
        use_from=use_from,
        use_to=use_to,
        unit_to_m=unit_to_m,
        path=recording,
        where=where,
    )
