"""The presets that ship, and what stands for a preset: its name, its file or itself."""

from __future__ import annotations

import os
from importlib.resources import files
from pathlib import Path

from mesa_mobility.crowd.presets.files import SUFFIX, parse_preset, read_preset
from mesa_mobility.crowd.presets.preset import Preset
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.registry import did_you_mean

DEFAULT = "default"
"""The preset of models that ask for no other."""


def _shipped(name: str) -> Preset:
    file = files("mesa_mobility").joinpath(f"data/presets/{name}{SUFFIX}")
    return parse_preset(file.read_text("utf-8"), f"{name}{SUFFIX}", f"preset {name}")


PRESETS = {name: _shipped(name) for name in ("paper", DEFAULT)}


def is_preset_file(preset: object) -> bool:
    """Whether this is the path of a preset, and not the name of one that ships."""
    return isinstance(preset, os.PathLike) or (
        isinstance(preset, str) and (preset.endswith(SUFFIX) or os.sep in preset)
    )


def preset_of(preset: str | os.PathLike[str] | Preset) -> Preset:
    """The preset that is given as an object, by the name of a shipped one, or as a file.

    Raises:
        ModelError: no preset has this name, the argument is of another type, or the file is
            unusable.
    """
    if isinstance(preset, Preset):
        return preset
    if is_preset_file(preset):
        return read_preset(Path(preset))
    if not isinstance(preset, str):
        raise ModelError(f"preset: got {preset!r:.80}, expected a name, a TOML file or a Preset")
    if preset not in PRESETS:
        meant = did_you_mean(preset, dict.fromkeys(PRESETS))
        known = ", ".join(PRESETS)
        raise ModelError(
            f"preset {preset!r} is unknown{meant}, expected one of {known}, or a {SUFFIX} file"
        )
    return PRESETS[preset]
