"""The report of a calibration: one HTML page with training and held-out figures."""

from __future__ import annotations

import os

from mesa_mobility.calibration.outcome import NEW_DATA, NEW_SEEDS, TRAINED, Calibrated
from mesa_mobility.calibration.task import Task
from mesa_mobility.reports.html import Page, picture
from mesa_mobility.reports.versions import add_versions, machine, versions

_SAYS = {
    TRAINED: "Training: data and seeds that the search has seen in its last generation",
    NEW_SEEDS: "New seeds: data that the search has seen, seeds that it has not",
    NEW_DATA: "Held-out data: neither data nor seeds were seen",
}


def write_report(found: Calibrated, task: Task, path: str | os.PathLike[str]) -> None:
    """Write a calibration as one HTML page, which needs no other file.

    Args:
        found: the outcome.
        task: what was asked for.
        path: of the page.

    Raises:
        ResultsError: the page cannot be written.
    """
    page = Page(f"Calibration of the preset {task.preset.name}")
    tried = sum(len(each.numbers) for each in found.history)
    failed = sum(each.failed for each in found.history)
    page.section("Summary", "summary")
    page.text(
        f"{tried} sets of numbers in {len(found.history)} generations, {failed} of them with a run "
        f"that failed; {task.seeds.each} new seeds a generation, {task.seeds.held_out} seeds held "
        f"out. Began on {found.began}."
    )
    page.section("Numbers", "numbers")
    page.table(
        "Numbers at the start and found",
        ["number", "from", "to", "at the start", "found"],
        [
            [
                each.name,
                *(f"{end:.4g}" for end in each.bounds),
                f"{each.start:.4g}",
                f"{found.values[each.name]:.4g}",
            ]
            for each in task.free
        ],
        "A number found at an end of its range may be better beyond.",
    )
    for part, heading in _SAYS.items():
        rows = [each for each in found.figures if each.part == part]
        if rows:
            page.section(part.capitalize(), part.replace(" ", "-"))
            page.table(
                heading,
                ["scenario", "distance", "at the start", "found", "change", "verdict", "failed"],
                [
                    [
                        each.scenario or "all",
                        each.distance,
                        str(each.start),
                        str(each.found),
                        str(each.change),
                        each.verdict,
                        each.failed,
                    ]
                    for each in rows
                ],
                "Means over the seeds, with intervals of 95 %. The change is taken seed by seed.",
            )
    page.section("Search", "search")
    page.picture("The best and the middle cost in each generation", _drawn(found))
    page.section("Scenarios", "scenarios")
    page.table(
        "Scenarios and their data",
        ["scenario", "simulates", "measured", "distances", "held out"],
        [
            [
                name,
                each.simulates,
                each.measures if len(each.measures) < 200 else "in the store",
                ", ".join(f"{of.name} x {of.weight:g}" for of in each.distances),
                "yes" if each.held_out else "no",
            ]
            for name, each in task.scenarios.items()
        ],
    )
    page.section("Versions and inputs", "repeat")
    add_versions(
        page,
        {**versions(), "preset at the start": task.preset.inputs_text},
        dict(task.files),
        machine(),
    )
    page.write(path)


def _drawn(found: Calibrated) -> bytes:
    import numpy as np
    from matplotlib.figure import Figure

    drawn: Figure = Figure(figsize=(6.4, 3.4), dpi=110, layout="constrained")
    axes = drawn.subplots()
    across = np.arange(1, len(found.history) + 1)
    axes.plot(across, [min(each.costs) for each in found.history], label="best", color="#2166ac")
    axes.plot(
        across,
        [float(np.median(each.costs)) for each in found.history],
        label="middle",
        color="#999999",
    )
    axes.set(xlabel="generation", ylabel="cost")
    axes.grid(alpha=0.3)
    axes.legend()
    return picture(drawn)
