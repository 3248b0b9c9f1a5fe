"""A decision in the form that its view draws."""

from __future__ import annotations

from typing import Any

import numpy as np

from mesa_mobility import PedestrianModel
from mesa_mobility.crowd import Explanation
from mesa_mobility.dashboard.session.serialization import packed
from mesa_mobility.mobility.poses import POSE_JOINTS

BONES = [
    [POSE_JOINTS.index(f"{side}_{a}"), POSE_JOINTS.index(f"{side}_{b}")]
    for side in ("left", "right")
    for a, b in (("hip", "knee"), ("knee", "ankle"), ("ankle", "toe"))
] + [[POSE_JOINTS.index("left_hip"), POSE_JOINTS.index("right_hip")]]
"""Pairs of joints between which the stick figure has a bone: left leg, right leg, hips."""


def described(explained: Explanation, model: PedestrianModel) -> dict[str, Any]:
    """Data of a decision for its view.

    Numbers of options are base64 float32, options in the order of the explanation's: ``costs``
    (terms, n) weighted, ``totals``, ``verdicts``, ``blockers``, ``ends`` (n, 2), ``durations``,
    ``speeds``, ``paths`` (n, 16, 2) and ``knots``. A neighbour is row, x, y, core radius, and x, y
    of where their movement leads. ``lost`` says that there is no way to the target. ``blocked_by``
    is the row of the person whom the pedestrian would hit first with the movement that they would
    take alone, or -1.
    """
    row, crowd, candidates = explained.pedestrian, model.crowd, explained.candidates
    kind = model.pedestrian_types[int(crowd.type_index[row])]
    return {
        "pedestrian": row,
        "when": _when(explained, model),
        "goes": _goes(explained, model),
        "lost": _lost(explained, model),
        "taken": explained.taken,
        "frame": explained.frame,
        "type": kind.name,
        "cluster": explained.cluster,
        "poses": int(explained.capability.map.sizes[explained.cluster]),
        "pose": explained.capability.map.mean_poses[explained.cluster].tolist(),
        "bones": BONES,
        "core": float(crowd.core[row]),
        "preferred": float(candidates.preferred_speeds[0]),
        "position": candidates.positions[0].tolist(),
        "heading": float(candidates.facings[0]),
        "target": candidates.targets[0].tolist(),
        "chosen": explained.chosen,
        "blocked_by": explained.blocked_by,
        "terms": list(explained.terms),
        "weights": explained.weights.tolist(),
        "options": len(candidates),
        "costs": packed(explained.weights[:, None] * explained.costs),
        "totals": packed(explained.totals),
        "verdicts": packed(explained.verdicts),
        "blockers": packed(explained.blockers),
        "ends": packed(candidates.points),
        "durations": packed(candidates.durations),
        "speeds": packed(candidates.speeds),
        "paths": packed(np.moveaxis(explained.paths[:, :2], 1, 2)),
        "knots": packed(explained.knots),
        "neighbours": [
            [int(j), *place, float(crowd.core[j]), *end]
            for j, place, end in zip(
                candidates.neighbours,
                candidates.neighbour_positions.tolist(),
                explained.neighbour_ends.tolist(),
                strict=True,
            )
        ],
    }


def _lost(explained: Explanation, model: PedestrianModel) -> bool:
    """Whether there is no way to where somebody wants to go."""
    return not np.isfinite(model.crowd.route[explained.pedestrian])


def _goes(explained: Explanation, model: PedestrianModel) -> str:
    """Where somebody goes next on their way, in a few words."""
    row, agenda = explained.pedestrian, model.crowd.agenda
    stop, lost = model.journeys.next_stop(row, model.crowd), _lost(explained, model)
    if stop is None:
        exits = " or ".join(model.population.exits(row)) or "no exit"
        return "There is no way to any exit; they wait" if lost else f"They go to {exits}"
    if model.journeys.stays.stands(row):
        return f"They stay at {stop} until {agenda['waits_until'][row] / model.frame_rate:.1f} s"
    later = len(model.journeys.stops(int(agenda["journey"][row]))) - int(agenda["crossed"][row]) - 1
    place = f"gate {stop}" if isinstance(stop, str) else str(stop)
    if lost:
        return f"There is no way to {place}; they wait"
    return f"They go to {place}" + (f", then to {later} more" if later > 0 else "")


def _when(explained: Explanation, model: PedestrianModel) -> str:
    at = explained.frame / model.frame_rate
    if explained.taken:
        return f"Decision as taken at {at:.2f} s"
    due = max(int(model.crowd.end[explained.pedestrian]) - explained.frame, 0) / model.frame_rate
    when = "in this step" if due == 0 else f"in {due:.2f} s, when their movement ends"
    return f"If they decided now, at {at:.2f} s, before everybody else; they will decide {when}"
