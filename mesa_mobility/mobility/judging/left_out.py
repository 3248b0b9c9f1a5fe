"""Recall and precision of a map's options, with its clips left out one at a time, or some at once.

Recall: how often the map of the other clips has an option that ends where the person of the
clip left out really was. Precision: movements of that clip are edited as options are; an edited
movement is supported if somebody in the other clips has a recorded option that ends within 5 cm
along and across, and 5 degrees of it. How often recorded movements themselves are supported says
how much the other clips could support at all: a minute of recording supports few.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.capture import Recording
from mesa_mobility.capture.transforms import MIRRORED
from mesa_mobility.errors import MapError
from mesa_mobility.mobility.build import options_of_recordings
from mesa_mobility.mobility.edits import EDITS, edit_paths
from mesa_mobility.mobility.judging.held_out import (
    HORIZON,
    NEAR,
    Ends,
    Movements,
    clusters_of,
    compare,
    figures,
    movements,
)
from mesa_mobility.mobility.paths import (
    DURATIONS,
    SAMPLE_EVERY,
    ReachableOptions,
    reachable_options,
)
from mesa_mobility.mobility.poses import pose_table

SUPPORTED = (0.05, 0.05, np.deg2rad(5.0))
"""Metres, metres and radians between a movement and a recorded option that supports it."""

FINE = (0.04, 0.04, np.deg2rad(4.0))
"""Cell of thinning of the options that support: finer than what they are compared with."""

SAMPLED = 7
"""Of many clips, every seventh is left out at once: one more build."""

EVERY = 5
"""Poses from one whose edited movements are looked at to the next: neighbours move alike."""


def left_out_one_at_a_time(
    recordings: Sequence[Recording],
    clusters: int | None = None,
    progress: Callable[[str, int, int], None] | None = None,
) -> dict[str, Any]:
    """Build a map without each clip in turn, and compare it with that clip.

    Args:
        recordings: clips at 30 Hz; mirror images are left out with their originals, and are not
            compared themselves.
        clusters: as for ``build_map``.
        progress: called as ``progress(stage, clips done, clips)``.

    Returns:
        What ``coverage`` returns, over all clips; ``supported_edited`` and ``supported_recorded``,
        shares of the edited and of the recorded movements that are supported; ``precision``, the
        first divided by the second, at most 1; ``clips``, the coverage of each. A movement is
        supported if the other clips have a recorded option that ends within 5 cm along and across,
        and 5 degrees of it.

    Raises:
        MapError: there are fewer than two clips of more than 45 frames.
    """
    tested = _tested(recordings)
    if len(tested) < 2:
        raise MapError(
            f"{len(tested)} clips of more than {HORIZON} frames: expected at least two, as each is "
            "compared with a map of the others"
        )
    distances, withins, clips = [], [], []
    supported: dict[str, list[NDArray[np.bool_]]] = defaultdict(list)
    for done, recording in enumerate(tested):
        if progress is not None:
            progress("leaving clips out", done, len(tested))
        name = recording.name.removesuffix(MIRRORED)
        others = [r for r in recordings if r.name.removesuffix(MIRRORED) != name]
        poses = pose_table([recording])
        moved = movements(poses)
        try:
            graph, grouped, options = options_of_recordings(others, clusters)
        except MapError as error:
            raise MapError(f"without {name}: {error}") from None
        cluster = clusters_of(poses, moved.rows, grouped.centres)
        distance, within = compare(_ends(options), cluster, moved.paths[:, -1], HORIZON, NEAR)
        distances.append(distance)
        withins.append(within)
        clips.append({"clip": name, **figures(distance, within)})
        known = _ends(reachable_options(graph, grouped, (), FINE))
        for kind, shares in _supported(known, moved).items():
            supported[kind].append(shares)
    share = {kind: float(np.concatenate(shares).mean()) for kind, shares in supported.items()}
    return {
        **figures(np.concatenate(distances), np.concatenate(withins)),
        "precision": min(1.0, share["edited"] / share["recorded"]) if share["recorded"] else 0.0,
        "supported_edited": share["edited"],
        "supported_recorded": share["recorded"],
        "clips": clips,
    }


def sample_left_out(
    recordings: Sequence[Recording],
    clusters: int | None = None,
    progress: Callable[[str, int, int], None] | None = None,
) -> dict[str, Any]:
    """Build a map without every seventh clip, and compare it with these.

    Args:
        recordings: as for ``left_out_one_at_a_time``.
        clusters: as for ``build_map``.
        progress: as for ``build_map``.

    Returns:
        What ``coverage`` returns.

    Raises:
        MapError: the other clips do not give a map, or there are fewer than seven of more than 45
            frames.
    """
    tested = _tested(recordings)[SAMPLED - 1 :: SAMPLED]
    if not tested:
        raise MapError(
            f"fewer than {SAMPLED} clips of more than {HORIZON} frames: none to leave out"
        )
    names = {r.name.removesuffix(MIRRORED) for r in tested}
    others = [r for r in recordings if r.name.removesuffix(MIRRORED) not in names]
    _, grouped, options = options_of_recordings(others, clusters, progress)
    poses = pose_table(tested)
    moved = movements(poses)
    cluster = clusters_of(poses, moved.rows, grouped.centres)
    return figures(*compare(_ends(options), cluster, moved.paths[:, -1], HORIZON, NEAR))


def _tested(recordings: Sequence[Recording]) -> list[Recording]:
    """The clips to compare with a map of others."""
    # Of people who limp on the other side, there are mirror images alone.
    originals = [r for r in recordings if not r.name.endswith(MIRRORED)] or recordings
    return [r for r in originals if r.frames > HORIZON]


def _ends(options: ReachableOptions) -> Ends:
    last = options.durations.astype(np.int64) // SAMPLE_EVERY - 1
    return Ends(options.offsets, options.durations, options.paths[np.arange(len(last)), last])


def _supported(known: Ends, moved: Movements) -> dict[str, NDArray[np.bool_]]:
    """Which recorded and which edited movements have a recorded option near their ends."""
    from scipy.spatial import cKDTree

    paths = moved.paths[::EVERY]
    trees = {
        frames: cKDTree(known.places[known.durations == frames] / SUPPORTED) for frames in DURATIONS
    }

    def near(paths: NDArray[np.float64]) -> NDArray[np.bool_]:
        found = []
        for frames, tree in trees.items():
            ends = paths[:, frames // SAMPLE_EVERY - 1] / SUPPORTED
            found.append(tree.query(ends, p=np.inf, distance_upper_bound=1.0)[0] <= 1.0)
        return np.concatenate(found)

    return {
        "recorded": near(paths),
        "edited": np.concatenate([near(edit_paths(paths, edit)) for edit in EDITS]),
    }
