"""The figures of a model's run."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.model.crowd_model import CrowdModel


def summary(model: CrowdModel) -> dict[str, Any]:
    """Figures of the run so far, ready for JSON.

    Returns:
        ``model``, ``preset``, ``rules`` (all that the preset decides), ``pedestrians``,
        ``simulated_s``, ``egress_s`` (None while anybody is inside, but for people in refuges, or
        to come, or where nobody has left), ``left_inside``, ``stalled``,
        ``stall_reason`` (None unless stalled), ``blocked`` (everybody who has ever stood for a
        minute without a reason: ``person``, ``since_s``, ``ring`` as rows, and whether they
        still do, ``stands``), ``decisions``, ``fallback_decision_share``,
        ``fallback_time_share``, ``mean_speed_mps`` (over all pedestrian-time), ``occupancy``
        ([[t, inside], ...] each second), ``people`` (for each ``type`` the number of ``people``
        who were ever there and [least, mean, greatest] of the speeds at which they like to walk,
        ``preferred_mps``, and of the times at which they set off, ``sets_off_s``) and, in buildings
        with lifts, ``lifts`` (of each ``lift`` its ``trips`` and how many people it has
        ``carried``), in those with moving escalators ``escalators`` (of each ``escalator`` how many
        people it has ``carried``, and the seconds for which it ``stood_s`` with people on it) and
        in those with refuges ``refuges`` (of each ``refuge`` how many people are ``waiting`` there
        and, ``by_type``, of which types) and ``cannot_leave`` (all ``people`` who have no way since
        they cannot use stairs, ``by_type``).
    """
    last_left, standing = model.statistics.last_left, model.blocked
    left = model.inside == 0 or model.all_in_refuges
    out = left and last_left is not None and not model.sources.expecting
    return {
        "model": type(model).__name__,
        "preset": model.preset,
        "rules": model.rules.numbers(),
        "pedestrians": model.population.count,
        "simulated_s": round(model.elapsed, 6),
        "egress_s": round(last_left or 0.0, 6) if out else None,
        "left_inside": model.inside,
        "stalled": model.stalled,
        "stall_reason": model.stall_reason,
        "blocked": [
            {
                "person": each.person,
                "since_s": each.since,
                "ring": list(each.ring),
                "stands": each in standing,
            }
            for each in model._standing_watch.reported.values()
        ],
        "decisions": int(model.crowd.decisions.sum()),
        "fallback_decision_share": model.statistics.fallback_decision_share,
        "fallback_time_share": model.statistics.fallback_time_share,
        "mean_speed_mps": model.statistics.mean_speed_so_far,
        "occupancy": [list(row) for row in model.statistics.occupancy],
        "people": _people(model),
        **({"lifts": _lifts(model)} if len(model.lifts) else {}),
        **({"escalators": _escalators(model)} if len(model.escalators) else {}),
        **(_refuges(model) if len(model.refuges) else {}),
    }


def _people(model: CrowdModel) -> list[dict[str, Any]]:
    count, agenda = model.population.count, model.crowd.agenda
    of_type = model.crowd.type_index[:count]
    found = []
    for number, kind in enumerate(model.pedestrian_types):
        own = np.flatnonzero(of_type == number)
        if len(own):
            speeds, times = agenda["speed"][own], agenda["sets_off"][own] / model.frame_rate
            found.append(
                {
                    "type": kind.name,
                    "people": len(own),
                    "preferred_mps": _range(speeds),
                    "sets_off_s": _range(times),
                }
            )
    return found


def _range(values: NDArray[Any]) -> list[float]:
    return [round(float(each), 6) for each in (values.min(), values.mean(), values.max())]


def _lifts(model: CrowdModel) -> list[dict[str, Any]]:
    lifts = model.lifts
    return [
        {"lift": each.name, "trips": int(lifts.trips[k]), "carried": int(lifts.carried[k])}
        for k, each in enumerate(lifts.shafts)
    ]


def _escalators(model: CrowdModel) -> list[dict[str, Any]]:
    found = model.escalators
    return [
        {
            "escalator": each.name,
            "carried": int(found.carried[k]),
            "stood_s": round(float(found.stood_s[k]), 6),
        }
        for k, each in enumerate(found.seams)
    ]


def _refuges(model: CrowdModel) -> dict[str, Any]:
    refuges = [{"refuge": name, **_counted(model, rows)} for name, rows in model.in_refuges.items()]
    return {"refuges": refuges, "cannot_leave": _counted(model, model.without_stairs, "people")}


def _counted(model: CrowdModel, rows: list[int], what: str = "waiting") -> dict[str, Any]:
    kinds = [model.pedestrian_types[k].name for k in model.crowd.type_index[rows].tolist()]
    return {what: len(rows), "by_type": {kind: kinds.count(kind) for kind in sorted(set(kinds))}}
