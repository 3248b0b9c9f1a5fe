"""Doors and exits in the report of a run: flows, N-t curves, queues and clogs."""

from __future__ import annotations

from mesa_mobility.reports.html import Page
from mesa_mobility.reports.run.pictures import n_t_curves, queue_curves
from mesa_mobility.reports.run.places import rows_of, types_of
from mesa_mobility.reports.run.texts import count, in_words, number
from mesa_mobility.results.engineering.measured import Measured


def add_doors(page: Page, measured: Measured) -> None:
    """Add flows, N-t curves, queues and clogs."""
    page.section("Doors and exits", "doors")
    found = rows_of(measured.doors)
    if not found:
        page.text("The plan has no doors and no exits.")
        return
    page.table(
        "People and flows",
        [
            "door or exit",
            "width (m)",
            "people",
            "first passage (s)",
            "last passage (s)",
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
        "Everybody counts once, at their first passage. The specific flow is the flow for each "
        "metre of width. A door that fewer than two people pass has no flow.",
    )
    page.table(
        "Queues and clogs",
        [
            "door or exit",
            "people who waited",
            "mean wait (s)",
            "longest wait (s)",
            "longest queue (persons)",
            "when it was longest (s)",
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
                number(each["most_queue_s"], 0),
                int(each["clogs"]),
                number(each["clogged_s"]),
                number(each["longest_clog_s"]),
            ]
            for each in found
        ],
        "People who stand are in the queue of the door that they pass next, also before they set "
        "off: a queue that is longest at 0 s is that of the start.",
    )
    _by_type(page, measured)
    if not len(measured.n_t):
        return
    for draw, caption in (
        (n_t_curves, "N-t curves: how many people have passed each door or exit by each time"),
        (queue_curves, "How many people wait before each door or exit"),
    ):
        png, more = draw(measured)
        some = f"; {count(more, 'door or exit', 'doors or exits')} with fewer not shown"
        page.picture(caption + (some if more else ""), png)


def _by_type(page: Page, measured: Measured) -> None:
    """Add who passes which door, and how long they wait there, where there are several types."""
    types = types_of(measured.doors)
    if len(types) < 2:
        return
    own = {kind: rows_of(measured.doors, kind) for kind in types}
    page.table(
        "People of each type who pass a door or exit, and in brackets their mean wait before it",
        ["door or exit", *(f"{in_words(kind)} (s)" for kind in types)],
        [
            [
                each["door"],
                *(
                    f"{int(of['people'])} ({number(of['waiting_s'])})"
                    for of in (own[kind][row] for kind in types)
                ),
            ]
            for row, each in enumerate(rows_of(measured.doors))
        ],
        "The mean wait is that of the people of the type who waited; “-” if nobody did.",
    )
