"""`mesa-mobility explain`: why somebody moved as they did in a saved run."""

from __future__ import annotations

from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mesa_mobility.commands.console import (
    NoProgress,
    answer_json,
    answer_rows,
    answer_table,
    progress_bar,
    some_path,
)
from mesa_mobility.commands.export import RunDir

if TYPE_CHECKING:
    from mesa_mobility.crowd import Explanation, PedestrianModel

CHEAPER, NEXT = 8, 5
"""Rows of the table at most: cheaper options that something was in the way of, and dearer ones."""

SAID = 2
"""Terms named in a row of the table."""


def explain(
    run: RunDir,
    person: Annotated[int, typer.Option(min=0, help="Number of the person.")],
    time: Annotated[
        float,
        typer.Option(
            help="Time in seconds. The command explains the movement under way at that time."
        ),
    ],
    map_file: Annotated[
        Path | None,
        typer.Option(
            "--map",
            help="The run's mobility map, if the run was made with --map.",
            parser=some_path,
            metavar="PATH",
        ),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print one JSON object with all options.")
    ] = False,
    no_progress: NoProgress = False,
) -> None:
    """Say why somebody took this option, in a run that was saved with `--record decisions`.

    The run is repeated up to the decision, and compared with what was saved.
    """
    from mesa_mobility.commands.models.repeating import decision_frame, repeat_decision
    from mesa_mobility.results.run import read_run

    found = read_run(run)
    frame = decision_frame(found.trajectories, person, time)
    with progress_bar(shown=not no_progress) as report:
        model, explained = repeat_decision(
            found,
            run,
            person,
            frame,
            map_file=map_file,
            progress=lambda done: report("running again", done, 1.0),
        )
    values = answer_of(explained, model)
    if as_json:
        answer_json(values)
        return
    answer_table(_heading(values))
    answer_rows(*_rows(values))


def answer_of(explained: Explanation, model: PedestrianModel) -> dict[str, Any]:
    """A decision, ready for JSON; options by rising cost."""
    import numpy as np

    from mesa_mobility.crowd import FREE, WALL

    candidates, chosen = explained.candidates, explained.chosen
    number = int(model.crowd.type_index[explained.pedestrian])
    kind = model.pedestrian_types[number]
    totals, parts = explained.totals, explained.weights[:, None] * explained.costs
    turns = np.degrees(candidates.headings - candidates.facings[0])
    parts_of = explained.capability.parts
    before = takewhile(
        lambda each: each is not explained.capability.map, model.mobility_maps[number]
    )
    first_row = sum(each.n_options for each in before)

    def in_the_way(k: int) -> str | int | None:
        if explained.verdicts[k] == FREE:
            return None
        return "wall" if explained.verdicts[k] == WALL else int(explained.blockers[k])

    # Of equal costs the one that turns least comes first, as the decision has it.
    order = np.lexsort((abs(turns), totals))
    return {
        "person": explained.pedestrian,
        "type": kind.name,
        "time": explained.frame / model.frame_rate,
        "frame": explained.frame,
        "position": candidates.positions[0].tolist(),
        "heading": float(candidates.facings[0]),
        "target": candidates.targets[0].tolist(),
        "preferred_speed": float(candidates.preferred_speeds[0]),
        "fallback": chosen < 0,
        "blocked_by": None if explained.blocked_by < 0 else explained.blocked_by,
        "options": [
            {
                "option": first_row + int(parts_of.rows[candidates.options[k]]),
                "share": float(parts_of.share[candidates.options[k]]),
                "taken": k == chosen,
                "in_the_way": in_the_way(k),
                "ends_at": candidates.points[k].tolist(),
                "turn_deg": float(turns[k]),
                "seconds": float(candidates.durations[k]),
                "speed": float(candidates.speeds[k]),
                "cost": float(totals[k]),
                "costs": dict(zip(explained.terms, parts[:, k].tolist(), strict=True)),
            }
            for k in order.tolist()
        ],
    }


def _heading(values: dict[str, Any]) -> dict[str, str]:
    options = values["options"]
    free = sum(each["in_the_way"] is None for each in options)
    taken = next((k for k, each in enumerate(options) if each["taken"]), None)
    (x, y), (tx, ty) = values["position"], values["target"]
    return {
        "Person": f"{values['person']}, {values['type']}",
        "Decided": f"at {values['time']:.2f} s at ({x:.2f}, {y:.2f})",
        "Wants": f"to ({tx:.2f}, {ty:.2f}) at {values['preferred_speed']:.2f} m/s",
        "Alone": "they would hit nobody"
        if values["blocked_by"] is None
        else f"they would hit person {values['blocked_by']}",
        "Options": f"{len(options)}, of which {free} hit nothing",
        "Took": "the fallback: no option was free"
        if taken is None
        else f"the cheapest free one; something was in the way of {taken} cheaper ones",
    }


def _rows(values: dict[str, Any]) -> tuple[list[str], list[list[str]]]:
    """Columns and rows of the options around the one that was taken."""
    options = values["options"]
    at = next((k for k, each in enumerate(options) if each["taken"]), len(options))
    shown = options[:at][:CHEAPER] + options[at : at + 1 + NEXT]
    against = options[at]["costs"] if at < len(options) else None
    rows = [
        [
            "taken" if each["taken"] else "",
            f"{each['option']}" + (f" x {each['share']:g}" if each["share"] < 1.0 else ""),
            f"{each['ends_at'][0]:.2f}, {each['ends_at'][1]:.2f}",
            f"{each['turn_deg']:.0f}°",
            _obstacle(each["in_the_way"]),
            f"{each['cost']:.3f}",
            "" if each["taken"] else _differences(each["costs"], against),
        ]
        for each in shown
    ]
    columns = ["", "option", "ends at", "turns", "in the way", "cost"]
    return [*columns, "cost by term" if against is None else "differs by"], rows


def _differences(costs: dict[str, float], against: dict[str, float] | None) -> str:
    """The terms that matter most in the difference between two options, or in a cost itself."""
    parts = {name: cost - (against or {}).get(name, 0.0) for name, cost in costs.items()}
    most = sorted(parts, key=lambda name: -abs(parts[name]))[:SAID]
    sign = "" if against is None else "+"
    return "\n".join(f"{name} {parts[name]:{sign}.3f}" for name in most if parts[name])


def _obstacle(what: str | int | None) -> str:
    if what is None:
        return "-"
    if isinstance(what, str):
        return f"a {what}"
    return "several people" if what < 0 else f"person {what}"
