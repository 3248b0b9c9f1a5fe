"""Findings of a run: main figures, results over time, and doors."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from mesa_mobility.reports.html import Page
from mesa_mobility.reports.run.pictures import PAGE, drawn, left_out, n_t_curves, queue_curves
from mesa_mobility.reports.run.texts import count, number
from mesa_mobility.results.engineering.maps import DENSE, FloorMaps
from mesa_mobility.results.engineering.measured import Measured
from mesa_mobility.results.measures.by_type import EVERYBODY
from mesa_mobility.results.plots import plot_occupancy, plot_trajectories
from mesa_mobility.results.run import Run, occupancy_curve, occupancy_curves_by_type

if TYPE_CHECKING:
    import pandas as pd

_KINDS = {"floor": "the whole floor", "level": "level", "stairs": "stairs", "room": "room"}


def add_summary(page: Page, run: Run, measured: Measured) -> None:
    """Add the main figures, and what stands against them."""
    summary = run.summary
    page.section("Summary", "summary")
    for text in _objections(summary):
        page.notice(text)
    times = _cleared(measured)[0]
    used = [each for each in _doors(measured) if each["people"]]
    rows = [
        ["people", f"{measured.trajectories.people:,}"],
        ["simulated time", number(measured.trajectories.duration, 1, "s")],
        *(
            [f"time until {share} % of the people are out", f"{_time(times, f't{share}_s')} s"]
            for share in (50, 95, 100)
        ),
        [
            "mean speed of the people, waiting included",
            number(summary.get("mean_speed_mps"), 2, "m/s"),
        ],
    ]
    if used:
        busiest = max(used, key=lambda each: each["people"])
        latest = max(used, key=lambda each: each["last_s"])
        rows += [
            [
                "door with most people",
                f"{busiest['door']}: {count(int(busiest['people']), 'person', 'people')}, "
                f"{number(busiest['flow_per_m_s'], 2)} persons/(m s)",
            ],
            [
                "door that people passed last",
                f"{latest['door']}: after {number(latest['last_s'], 1, 's')}",
            ],
        ]
    dense = list(measured.maps[EVERYBODY].values())
    longest_s = max(float(np.nanmax(own.dense_s, initial=0.0)) for own in dense)
    rows += [
        ["greatest density of a cell", number(max(map(_most, dense)), 1, "persons/m²")],
        [
            f"longest time of a cell above {DENSE:g} persons/m²",
            number(longest_s, 0, "s"),
        ],
    ]
    page.table("Main figures of this run", ["figure", "value"], rows)
    page.text(
        "These are figures of a single run. They have no interval, since one run does not show how "
        "much chance changes them. Times are those from the start of the simulation."
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
    page.table(
        "Clearing times: when 50, 95 and 100 % of those who were ever there have left for good",
        ["place", "people", "left", "50 % (s)", "95 % (s)", "100 % (s)"],
        [
            [
                _place(each["kind"], each["place"]),
                each["people"],
                each["left"],
                *(_time(each, f"t{share}_s") for share in (50, 95, 100)),
            ]
            for each in _cleared(measured)
        ],
        "“> …” where the share falls among people who are still there when the run ends: it takes "
        "longer than that.",
    )
    page.table(
        "How long people wait in all (they move less than 0.2 m in a second)",
        ["people of type", "people", "mean (s)", "95 % wait at most (s)", "longest (s)"],
        [
            [
                kind,
                int(each["people"]),
                *(number(each[name]) for name in ("mean_wait_s", "p95_wait_s", "longest_wait_s")),
            ]
            for kind, each in _waiting(measured)
        ],
        "People who have not set off yet wait as well.",
    )
    _storeys(page, run)
    page.picture(
        "Ways of all people, coloured by time",
        drawn(lambda path: plot_trajectories(tracks, plan, path, title=" ", largest=PAGE)),
    )


def add_doors(page: Page, measured: Measured) -> None:
    """Add flows, N-t curves, queues and clogs."""
    page.section("Doors and exits", "doors")
    found = _doors(measured)
    if not found:
        page.text("The plan has no doors and no exits.")
        return
    page.table(
        "People and flows",
        [
            "door or exit",
            "width (m)",
            "people",
            "first (s)",
            "last (s)",
            "flow (persons/s)",
            "specific flow (persons/(m s))",
        ],
        [
            [
                each["door"],
                number(each["width_m"], 2),
                int(each["people"]),
                number(each["first_s"]),
                number(each["last_s"]),
                number(each["flow_per_s"], 2),
                number(each["flow_per_m_s"], 2),
            ]
            for each in found
        ],
        "Everybody counts at their first passage. A door that fewer than two people pass has no "
        "flow.",
    )
    page.table(
        "Queues and clogs",
        [
            "door or exit",
            "people who waited",
            "mean wait (s)",
            "longest wait (s)",
            "longest queue (persons)",
            "clogs",
            "clogged in all (s)",
            "longest clog (s)",
        ],
        [
            [
                each["door"],
                int(each["waited"]),
                number(each["waiting_s"]),
                number(each["longest_wait_s"]),
                int(each["most_queue"]),
                int(each["clogs"]),
                number(each["clogged_s"]),
                number(each["longest_clog_s"]),
            ]
            for each in found
        ],
        "People who have not set off yet are in the queue of their next door.",
    )
    if len(measured.n_t):
        more = left_out(measured)
        some = f"; {count(more, 'door')} with fewer people not shown" if more else ""
        page.picture(f"N-t curves: people who have passed each door{some}", n_t_curves(measured))
        page.picture(f"People who wait before each door{some}", queue_curves(measured))


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
    for name, words in (
        ("overlaps", "overlaps of bodies"),
        ("wall_crossings", "steps through walls"),
        ("off_floor", "frames of people off the floor"),
    ):
        if summary.get(name):
            said.append(f"The independent check has found {words}: {summary[name]}.")
    return said


def _cleared(measured: Measured) -> list[dict[str, Any]]:
    """Rows of the clearing times of everybody; the first is that of the whole floor."""
    return _rows(measured.clearing)


def _doors(measured: Measured) -> list[dict[str, Any]]:
    """Rows of the doors, of everybody."""
    return _rows(measured.doors)


def _waiting(measured: Measured) -> list[tuple[str, Any]]:
    """Waiting times of everybody, and by type where there are several."""
    every, *types = measured.waiting.iterrows()
    some = types if len(types) > 1 else []
    return [("everybody", every[1]), *((str(kind).replace("_", " "), own) for kind, own in some)]


def _rows(table: pd.DataFrame) -> list[dict[str, Any]]:
    own = table.loc[EVERYBODY].reset_index()
    return [{str(name): value for name, value in row.items()} for row in own.to_dict("records")]


def _time(row: Any, name: str) -> str:
    """A time to a share, or the bound where it was not reached."""
    value, censored = row[name], row["censored_s"]
    if math.isfinite(value):
        return f"{value:.1f}"
    return f"> {censored:.1f}" if math.isfinite(censored) else "-"


def _place(kind: str, place: str) -> str:
    return _KINDS[kind] if kind == "floor" else f"{_KINDS[kind]} {place}"


def _storeys(page: Page, run: Run) -> None:
    levels, stairs = run.summary.get("by_level"), run.summary.get("by_stairs")
    if levels:
        page.table(
            "Levels",
            ["level", "people", "at the start", "at the end", "empty after (s)", "most at a time"],
            [
                [
                    each["level"],
                    each["people"],
                    each["at_start"],
                    each["at_end"],
                    number(each["clear_s"]),
                    each["most"],
                ]
                for each in levels
            ],
        )
    if stairs:
        page.table(
            "Stairs",
            [
                "stairs",
                "people",
                "walked down",
                "walked up",
                "mean time (s)",
                "flow at the head (persons/s)",
                "flow at the foot (persons/s)",
                "most at a time",
            ],
            [
                [
                    each["stairs"],
                    each["people"],
                    each["down"],
                    each["up"],
                    number(each["mean_s"]),
                    number(each["head_per_s"], 2),
                    number(each["foot_per_s"], 2),
                    each["most"],
                ]
                for each in stairs
            ],
        )


def _most(own: FloorMaps) -> float:
    return float(np.nanmax(own.density_max, initial=0.0))
