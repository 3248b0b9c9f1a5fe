"""`mesa-mobility run`: run a model, check it, print and write the results."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import typer

from mesa_mobility._startup import nothing_collected
from mesa_mobility.commands.console import (
    AsJson,
    NoProgress,
    answer_json,
    answer_table,
    progress_bar,
    say,
    some_path,
)
from mesa_mobility.commands.exits import ExitOptions
from mesa_mobility.commands.grouping import grouped
from mesa_mobility.commands.models.making import (
    ModelName,
    ModelOptions,
    create_model,
    model_of_file,
    origin_of,
)
from mesa_mobility.commands.reports.options import ReportOptions
from mesa_mobility.commands.reports.results import RoomsFile, rooms_in
from mesa_mobility.errors import ModelError
from mesa_mobility.interrupts import INTERRUPTED, Stopped, gentle_interrupt

STALLED = 1

NAMED = 10
"""People named in the last line at most."""


@dataclass(frozen=True)
class Written(ReportOptions):
    """What is written of a run."""

    out: Annotated[
        Path | None,
        typer.Option(
            help="Folder for summary, trajectories, floor plan and pictures.",
            parser=some_path,
            metavar="PATH",
        ),
    ] = None
    record: Annotated[
        str | None,
        typer.Option(
            metavar="decisions",
            help="Also write which option each person took. `export` and `replay` need this to "
            "show bodies, and `explain` needs it, too.",
        ),
    ] = None
    rooms: RoomsFile = None
    as_json: AsJson = False
    no_progress: NoProgress = False


@grouped
def run(
    model: ModelName,
    options: ModelOptions,
    doors: ExitOptions,
    *,
    seconds: Annotated[
        float | None,
        typer.Option(
            help="Stop after this simulated time in seconds. By default the run ends when "
            "everybody has left, or when it stalls."
        ),
    ] = None,
    population: Annotated[
        str | None,
        typer.Option(
            help="Types of people: mixed, care_home, the name of a type, or shares such as "
            "'able_bodied: 0.9, child: 0.1'."
        ),
    ] = None,
    fill: Annotated[
        list[str] | None,
        typer.Option(
            metavar="[ROOM=]LOAD",
            help="People in rooms of the plan: a number, a density (0.5/m2), a use (office, "
            "nfpa101:office) or a table (ibc) for the rooms' own uses, for a room or a pattern "
            "(office*=office); ' after uniform(0, 30)' adds the time before they set off; "
            "repeatable.",
        ),
    ] = None,
    written: Written,
) -> None:
    """Run a model and report its figures.

    Ends with status 1 if the evacuation stalled with people left inside.
    """
    if seconds is not None and not (math.isfinite(seconds) and seconds > 0):
        raise ModelError(f"--seconds {seconds:g}: expected a positive number")
    record, out = written.record, written.out
    if record not in (None, "decisions"):
        raise ModelError(f"--record {record}: expected decisions")
    written.check_report()
    model, options = model_of_file(model, options.with_seed())
    areas = rooms_in(written.rooms)
    if population is not None:
        options = replace(options, settings=[*(options.settings or []), f"population={population}"])
    if fill:
        options = replace(options, settings=[*(options.settings or []), f"fill={'; '.join(fill)}"])
    with progress_bar(shown=not written.no_progress) as report, nothing_collected():
        report("loading")
        from mesa_mobility.crowd.model_files import find_model
        from mesa_mobility.crowd.precompile import COMPILING, compiling_ahead, is_compiled

        report("preparing" if is_compiled() else COMPILING)
        with compiling_ahead():
            simulation, given = create_model(
                find_model(model),
                model,
                options,
                record=record or True,
                buildings=True,
                **doors.keywords(),
            )

    from mesa_mobility.results import Trajectories, check_safety, check_writable, write_run
    from mesa_mobility.results.engineering.rooms import check_rooms, rooms_of
    from mesa_mobility.results.engineering.summary import figures_of_places, figures_of_storeys
    from mesa_mobility.results.measures.by_type import rows_by_type
    from mesa_mobility.results.run import RUN_FILES, Run

    if out is not None:
        check_writable(out, RUN_FILES)
    plan, building = simulation.floor_plan, getattr(simulation, "building", None)
    every_room = check_rooms([*rooms_of(building or plan), *areas], building or plan)
    # From here on there is something to lose: Ctrl-C stops the simulation, not the writing.
    with gentle_interrupt() as stop_here:
        wall, cpu, interrupted = _simulate(
            simulation, seconds, stop_here, shown=not written.no_progress
        )
        with progress_bar(shown=not written.no_progress) as report:
            report("checking distances and walls", 0, 1)
            trajectories = Trajectories.of(simulation)
            safety = check_safety(trajectories, plan.walls, plan.free, building=building)
            summary = {
                **simulation.summary(),
                "model": model,
                "preset": options.preset or getattr(simulation, "preset", "default"),
                "seed": options.seed,
                "by_type": rows_by_type(trajectories) if "type" in trajectories.person_data else [],
                **figures_of_storeys(trajectories, building),
                **figures_of_places(trajectories, building or plan, every_room),
                **origin_of(given, simulation),
                "behaviors": options.behaviors or [],
                "wall_s": round(wall, 3),
                "cpu_s": round(cpu, 3),
                "overlaps": safety.overlaps,
                "overlapping_pairs": [asdict(each) for each in safety.overlapping_pairs],
                "min_distance_m": safety.min_distance_m,
                "wall_crossings": safety.wall_crossings,
                "crossings": [asdict(each) for each in safety.crossings],
                "off_floor": safety.off_floor,
                "stalled": bool(simulation.stalled),
                "interrupted": interrupted,
            }
            if out is not None:
                report("writing files and pictures", 0, 1)
                write_run(
                    out,
                    summary=summary,
                    trajectories=trajectories,
                    plan=building or plan,
                    reference_occupancy=simulation.reference_occupancy,
                )
            if written.report_file is not None:
                found = Run(trajectories, building or plan, summary, out)
                _write_report(found, areas, written.report_file, report)
    if out is not None:
        say(f"written to {out}")
    written.finish_report()
    if written.as_json:
        answer_json(summary)
    else:
        answer_table(_figures(summary))
    if interrupted:
        say(f"interrupted after {simulation.elapsed:.1f} simulated seconds: results up to there")
        raise typer.Exit(INTERRUPTED)
    stood = _said_of_blocked(summary)
    if simulation.stalled:
        reason = summary.get("stall_reason")
        say(
            f"stalled: {simulation.inside} people left inside after {simulation.elapsed:.1f} s"
            + (f": {reason}" if reason else "")
            + (f"; blocked: {stood}" if stood else "")
        )
        raise typer.Exit(STALLED)
    if stood:
        say(f"blocked: {stood}")


def _write_report(found: Any, rooms: list[Any], path: Path, report: Callable[..., None]) -> None:
    """Measure a run, and write its report."""
    from mesa_mobility.reports.run.report import write_run_report
    from mesa_mobility.results import measure

    measured = measure(found.trajectories, found.plan, rooms, progress=report)
    write_run_report(found, measured, path, progress=report)


def _said_of_blocked(summary: dict[str, Any]) -> str:
    """How many have stood for a minute without a reason, and who; nothing if nobody has."""
    rows = [each["person"] for each in summary.get("blocked") or []]
    if not rows:
        return ""
    from mesa_mobility.crowd.running.blocking import in_words

    people = "person" if len(rows) == 1 else "people"
    who = in_words(rows) if len(rows) <= NAMED else f"{', '.join(map(str, rows[:NAMED]))}, ..."
    return f"{len(rows)} {people} stood for a minute without a reason ({who})"


def _simulate(
    simulation: Any, seconds: float | None, stop_here: Callable[[], None], *, shown: bool
) -> tuple[float, float, bool]:
    """Run; returns wall and CPU seconds, and whether the user stopped it."""
    people = simulation.inside
    interrupted = False
    with progress_bar(shown=shown) as report:
        report("preparing the first step")

        def progress(elapsed: float, inside: int) -> None:
            # The share of the time or that of the people, whichever is larger.
            done = 1.0 - inside / people if people else 1.0
            if seconds is not None:
                done = max(done, elapsed / seconds)
            report(f"{inside} people inside, {elapsed:.0f} s simulated", done, 1.0)
            stop_here()

        wall, cpu = time.perf_counter(), time.process_time()
        try:
            simulation.run(max_seconds=seconds, progress=progress)
        except Stopped:
            interrupted = True
        return time.perf_counter() - wall, time.process_time() - cpu, interrupted


def _figures(summary: dict[str, Any]) -> dict[str, str]:
    from mesa_mobility.results.measures.sites import first_of

    egress = summary["egress_s"]
    distance, speed = summary["min_distance_m"], summary["mean_speed_mps"]
    types = summary["by_type"] if len(summary["by_type"]) > 1 else []
    return {
        "Model": f"{summary['model']}, preset {summary['preset']}, seed {summary['seed']}",
        "People": f"{summary['pedestrians']}",
        "Simulated": f"{summary['simulated_s']:.1f} s",
        "Everybody out": f"after {egress:.1f} s"
        if egress is not None
        else f"no: {summary['left_inside']} left inside",
        "Blocked": _said_of_blocked(summary) or "nobody stood for a minute without a reason",
        "Mean speed": "-" if speed is None else f"{speed:.2f} m/s",
        **{f"  {each['type']}": _figures_of_type(each) for each in types},
        **{
            f"Level {each['level']}": _figures_of_level(each)
            for each in summary.get("by_level", ())
        },
        **{
            f"Stairs {each['stairs']}": _figures_of_stairs(each)
            for each in summary.get("by_stairs", ())
        },
        **{
            f"Lift {each['lift']}": _figures_of_lift(each, found)
            for each, found in zip(
                summary.get("lifts", ()), summary.get("by_lift", ()), strict=True
            )
        },
        **{
            f"Escalator {each['escalator']}": f"{each['carried']} people carried, "
            f"stood for {each['stood_s']:.1f} s"
            for each in summary.get("escalators", ())
        },
        **{
            f"Refuge {each['refuge']}": f"{each['waiting']} people wait there"
            for each in summary.get("refuges", ())
        },
        "Decisions": f"{summary['decisions']}",
        "Fallback": f"{summary['fallback_decision_share']:.1%} of decisions, "
        f"{summary['fallback_time_share']:.1%} of the time",
        "Overlaps": f"{summary['overlaps']}{first_of(summary, 'overlapping_pairs')}",
        "Smallest distance": "-" if distance is None else f"{distance:.3f} m",
        "Wall crossings": f"{summary['wall_crossings']}{first_of(summary, 'crossings')}",
        "Off the floor": f"{summary['off_floor']} frames",
        "Wall time": f"{summary['wall_s']:.1f} s ({summary['cpu_s']:.1f} s of CPU)",
    }


def _figures_of_type(each: dict[str, Any]) -> str:
    text = f"{each['left']} of {each['people']} out"
    times = [
        f"{each[key]:.1f} s ({words})"
        for key, words in (("mean_egress_s", "mean"), ("p95_egress_s", "95 %"))
        if not math.isnan(each[key])
    ]
    if times:
        text += f", after {', '.join(times)}"
    return text + (
        "" if math.isnan(each["mean_speed_mps"]) else f", {each['mean_speed_mps']:.2f} m/s"
    )


def _figures_of_level(each: dict[str, Any]) -> str:
    text = f"{each['at_start']} people at the start"
    if each["at_end"]:
        return f"{text}, {each['at_end']} at the end"
    clear = each["clear_s"]
    return text if math.isnan(clear) else f"{text}, empty after {clear:.1f} s"


def _figures_of_stairs(each: dict[str, Any]) -> str:
    text = f"{each['people']} people"
    mean = each["mean_s"]
    return text if math.isnan(mean) else f"{text}, {mean:.1f} s on average"


def _figures_of_lift(each: dict[str, Any], found: dict[str, Any]) -> str:
    text = f"{each['carried']} people carried in {each['trips']} rides"
    if math.isnan(found["mean_wait_s"]):
        return text
    mean, longest = found["mean_wait_s"], found["longest_wait_s"]
    return f"{text}, waited {mean:.1f} s (mean), {longest:.1f} s (longest)"
