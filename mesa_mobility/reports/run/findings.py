"""Findings of a run: main figures and results over time."""

from __future__ import annotations

from typing import Any

import numpy as np

from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.reports.html import Page
from mesa_mobility.reports.run.evidence import FAIL, PASS, checks_of
from mesa_mobility.reports.run.pictures import PAGE, drawn
from mesa_mobility.reports.run.places import add_clearing, add_storeys, rows_of, time_text
from mesa_mobility.reports.run.texts import count, in_words, level_words, number
from mesa_mobility.results.engineering.maps import DENSE
from mesa_mobility.results.engineering.measured import Measured
from mesa_mobility.results.measures.by_type import EVERYBODY
from mesa_mobility.results.measures.sites import first_of
from mesa_mobility.results.measures.speeds import mean_speed
from mesa_mobility.results.plots import plot_occupancy, plot_trajectories
from mesa_mobility.results.run import Run, occupancy_curve, occupancy_curves_by_type


def add_summary(page: Page, run: Run, measured: Measured) -> None:
    """Add the main figures, and what stands against them."""
    summary = run.summary
    page.section("Summary", "summary")
    for text in _objections(summary):
        page.notice(text)
    times = rows_of(measured.clearing)[0]
    used = [each for each in rows_of(measured.doors) if each["people"]]
    rows = [
        ["people", f"{measured.trajectories.people:,}"],
        ["simulated time", number(measured.trajectories.duration, 1, "s")],
        *(
            [f"time until {share} % of the people are out", f"{time_text(times, f't{share}_s')} s"]
            for share in (50, 95, 100)
        ),
        [
            "mean speed of the people, waiting included",
            number(mean_speed(measured.trajectories), 2, "m/s"),
        ],
    ]
    if used:
        busiest = max(used, key=lambda each: each["people"])
        latest = max(used, key=lambda each: each["last_s"])
        rows += [
            [
                "door or exit that most people pass",
                f"{busiest['door']}: {count(int(busiest['people']), 'person', 'people')}, "
                f"{number(busiest['flow_per_m_s'], 2)} persons per metre and second",
            ],
            [
                "door or exit that is passed last",
                f"{latest['door']}: after {number(latest['last_s'], 1, 's')}",
            ],
        ]
    rows += _densest(measured)
    if passed := [verdict for *_, verdict in checks_of(run) if verdict in (PASS, FAIL)]:
        said = f"{passed.count(PASS)} of {len(passed)} passed"
        rows.append(["checks of the run (section “Checks”)", said])
    page.table("Main figures of this run", ["figure", "value"], rows)
    page.text(
        "These are figures of a single run. They have no interval, since one run does not show how "
        "much they vary by chance. Times count from the start of the simulation. “Definitions” "
        "says how each figure is measured."
    )


def add_results(page: Page, run: Run, measured: Measured) -> None:
    """Add people inside over time, clearing and waiting times, levels, stairs and ways."""
    tracks, plan = measured.trajectories, measured.plan
    page.section("Results", "results")
    page.picture(
        "People inside over time",
        drawn(
            lambda path: plot_occupancy(
                occupancy_curve(tracks),
                path,
                by_type=occupancy_curves_by_type(tracks),
                title=" ",
            )
        ),
    )
    add_clearing(page, measured)
    page.table(
        "How long each person waits in all; they wait while they move less than 0.2 m in a second",
        ["people of type", "people", "mean (s)", "95 % wait at most (s)", "longest (s)"],
        [
            [
                kind,
                int(each["people"]),
                *(number(each[name]) for name in ("mean_wait_s", "p95_wait_s", "longest_wait_s")),
            ]
            for kind, each in _waiting(measured)
        ],
        "The time before people set off counts as waiting.",
    )
    add_storeys(page, run, measured.plan)
    levels = "" if isinstance(plan, FloorPlan) else ", level by level from the top"
    page.picture(
        f"Ways of all people, coloured by the time at which they were there{levels}",
        drawn(lambda path: plot_trajectories(tracks, plan, path, title=" ", largest=PAGE)),
    )


def _objections(summary: Any) -> list[str]:
    said = []
    if summary.get("stalled"):
        reason = summary.get("stall_reason")
        said.append(
            f"The run has stalled: {count(summary.get('left_inside', 0), 'person', 'people')} left "
            f"inside{f' ({reason})' if reason else ''}. Times that were not reached are given as "
            "bounds."
        )
    if summary.get("interrupted"):
        said.append("The run was interrupted: all figures are those up to then.")
    stood = len(summary.get("blocked") or ())
    if stood:
        said.append(f"{count(stood, 'person', 'people')} stood for a minute without a reason.")
    for name, words, places in (
        ("overlaps", "overlaps of bodies", "overlapping_pairs"),
        ("wall_crossings", "steps through walls", "crossings"),
        ("off_floor", "frames of people off the floor", ""),
    ):
        if summary.get(name):
            where = first_of(summary, places)
            said.append(f"The independent check has found {words}: {summary[name]}{where}.")
    return said


def _waiting(measured: Measured) -> list[tuple[str, Any]]:
    """Waiting times of everybody, and by type where there are several."""
    every, *types = measured.waiting.iterrows()
    some = types if len(types) > 1 else []
    return [("everybody", every[1]), *((in_words(str(kind)), own) for kind, own in some)]


def _densest(measured: Measured) -> list[list[str]]:
    """The greatest density and the longest time above the limit, each with its place."""
    found, levels = measured.maps[EVERYBODY], level_words(measured.plan)
    rows = []
    for what, said, digits, unit in (
        ("density_max", "greatest density of a cell", 1, "persons/m²"),
        ("dense_s", f"longest time of a cell above {DENSE:g} persons/m²", 0, "s"),
    ):
        value, level, at = max(
            (
                (float(values.flat[at]), level, at)
                for level, own in found.items()
                for values in [np.nan_to_num(getattr(own, what))]
                for at in [int(values.argmax())]
            ),
            key=lambda each: each[0],
        )
        text = number(value, digits, unit)
        if value > 0.0:
            grid = found[level].grid
            row, column = divmod(at, grid.shape[1])
            x, y = grid.x[column] + grid.cell / 2, grid.y[row] + grid.cell / 2
            on = f"level {levels[level]}, " if level in levels else ""
            text += f", at {on}x = {x:.1f} m, y = {y:.1f} m"
        rows.append([said, text])
    return rows
