"""Recordings drawn anew: how much a map depends on which clips happen to have been recorded."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

from mesa_mobility.capture import Recording
from mesa_mobility.capture.transforms import MIRRORED
from mesa_mobility.errors import MapError


def draw_clips(
    recordings: Sequence[Recording], seed: int, number: int
) -> tuple[list[Recording], dict[str, Any]]:
    """As many clips as there are, drawn with replacement.

    The parts of a clip and its mirror images are drawn together. A draw depends on the seed, its
    number and the clips, and not on how many draws there are.

    Source: B. Efron, Bootstrap methods: another look at the jackknife, Annals of Statistics 7
    (1979) 1-26.

    Args:
        recordings: of the clips, in their order.
        seed: of all draws.
        number: of this draw, from 1 on.

    Returns:
        The recordings drawn, in the order of the clips, and the entry of a map's metadata that
        says which: ``seed``, ``number``, ``clips`` (different ones) and ``drawn``, how often each.

    Raises:
        MapError: fewer than two clips.
    """
    parts: dict[str, list[Recording]] = {}
    for recording in recordings:
        parts.setdefault(_clip_of(recording), []).append(recording)
    if len(parts) < 2:
        raise MapError(f"{len(parts)} clip: expected two or more to draw from")
    names = list(parts)
    taken = np.random.default_rng([seed, number]).integers(len(names), size=len(names))
    drawn = Counter(names[k] for k in sorted(taken.tolist()))
    said = {"seed": seed, "number": number, "clips": len(drawn), "drawn": dict(drawn)}
    return [part for name, times in drawn.items() for part in parts[name] * times], said


def _clip_of(recording: Recording) -> str:
    if recording.clip is not None:
        return recording.clip.file
    return recording.name.removesuffix(MIRRORED)
