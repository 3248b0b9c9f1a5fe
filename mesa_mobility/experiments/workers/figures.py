"""The figures of a run as columns of the store."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from mesa_mobility.experiments.storing.rows import SERIES, Row


def has_pedestrians(model: Any) -> bool:
    """Whether it is one of ours, with people who walk."""
    from mesa_mobility.crowd import PedestrianModel

    return isinstance(model, PedestrianModel)


def plain(text: str) -> str:
    """A text that files can hold; names of files may have bytes that are no letters."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def figures_of(model: Any, taken: set[str], *, occupancy: bool) -> Row:
    """Figures of a run: its summary, or else the last values that it has collected."""
    if hasattr(model, "summary"):
        summary: Mapping[str, Any] = model.summary()
    else:
        collected = model.datacollector.model_vars
        summary = {name: values[-1] if values else None for name, values in collected.items()}
    row: Row = {}
    for name, value in summary.items():
        value = value.item() if hasattr(value, "item") and not hasattr(value, "__len__") else value
        if isinstance(value, int) and not isinstance(value, bool):
            value = float(value)  # as the store has it; one without end is an error of the run
        if isinstance(value, str):
            value = plain(value)
        if value is None or isinstance(value, bool | float | str):
            row[f"summary_{name}" if name in taken or name in SERIES else str(name)] = value
    if not has_pedestrians(model):
        return row
    more = _by_type(model) | _of_building(summary)
    if "blocked" in summary:
        more["blocked"] = float(len(summary["blocked"]))
    row |= {f"summary_{n}" if n in taken else n: v for n, v in more.items()}
    if occupancy:
        row["occupancy"] = [people for _, people in summary["occupancy"]]
    return row


def figures_by_place(model: Any) -> Row:
    """Clearing times, and figures of doors, rooms, levels, stairs and lifts.

    Their names are such as ``door.east.flow_per_s`` and ``level.1.clear_s``.
    """
    from mesa_mobility.results import Trajectories, clearing, rooms_of
    from mesa_mobility.results.engineering.summary import figures_of_places, figures_of_storeys

    building = getattr(model, "building", None)
    plan = building or model.floor_plan
    tracks, rooms = Trajectories.of(model), rooms_of(plan)
    row: Row = {}
    for times in clearing(tracks, plan, rooms).reset_index().to_dict("records"):
        where = "" if times["kind"] == "floor" else f"{times['kind']}.{times['place']}."
        for name in ("t50_s", "t95_s", "t100_s"):
            row[where + name] = None if math.isnan(times[name]) else float(times[name])
    found = figures_of_places(tracks, plan, rooms)
    for kind, places in (("door", found["doors"]), ("room", found["rooms"])):
        for place, figures in places.items():
            for name, value in figures.items():
                row[f"{kind}.{place}.{name}"] = None if value is None else float(value)
    for table, rows in figures_of_storeys(tracks, building).items():
        for each in rows:
            row |= _of_part(table.removeprefix("by_"), each)
    return row


def _of_building(summary: Mapping[str, Any]) -> Row:
    """Figures of each lift, escalator and refuge, and of people who cannot leave."""
    row: Row = {}
    for name in ("lifts", "escalators", "refuges"):
        for each in summary.get(name, ()):
            row |= _of_part(name.removesuffix("s"), each)
    if "cannot_leave" in summary:
        row["cannot_leave"] = float(summary["cannot_leave"]["people"])
    return row


def _of_part(kind: str, figures: Mapping[str, Any]) -> Row:
    """Numbers of a part of a building, by names such as ``lift.east.carried``.

    Args:
        kind: of the part, under which the figures have its name.
        figures: what is known of it; what is no number is left out.
    """
    return {
        f"{kind}.{figures[kind]}.{name}": None if math.isnan(value) else float(value)
        for name, value in figures.items()
        if name != kind and isinstance(value, int | float)
    }


def _by_type(model: Any) -> Row:
    """How long people of each type took, where all are out, and the flow of those who are."""
    crowd, count = model.crowd, model.population.count
    left = ~crowd.active[:count]
    seconds = crowd.active_frames[:count] / model.frame_rate
    types = []
    for number in sorted(set(crowd.type_index[:count].tolist())):
        of = crowd.type_index[:count] == number
        times = seconds[of & left]
        # Of those who are out alone, the times of the slowest would be missing.
        out = len(times) == int(of.sum())
        types.append(
            {
                "type": int(number),
                "people": int(of.sum()),
                "left": len(times),
                "mean_s": float(times.mean()) if out else None,
                "longest_s": float(times.max()) if out else None,
            }
        )
    times = seconds[left]
    flow = None
    # Times inside are times of leaving where everybody has been there from the start.
    if len(times) > 1 and not len(model.sources) and times.max() > times.min():
        flow = (len(times) - 1) / float(times.max() - times.min())
    return {
        "types": types,
        "mean_time_inside_s": float(times.mean()) if count and left.all() else None,
        "flow_per_s": flow,
    }
