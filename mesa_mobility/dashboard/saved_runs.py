"""Saved runs on the page, in the player of ``mesa-mobility replay``."""

from __future__ import annotations

import solara

from mesa_mobility.animation.page import page_text
from mesa_mobility.dashboard import offered
from mesa_mobility.dashboard.widgets.fields import Choice
from mesa_mobility.dashboard.widgets.text import Note, heading
from mesa_mobility.errors import MobilityError, ResultsError
from mesa_mobility.results.excerpts import title_of
from mesa_mobility.results.run import SUMMARY, TRAJECTORIES, read_run

LARGEST = 60_000_000
"""Letters of a page that is shown inside another one."""

NONE = "none"

HELP = "Runs saved with `mesa-mobility run --out` in the folder that the dashboard was started in"


def offered_runs() -> list[str]:
    """Folders of saved runs below the one that the dashboard was started in, the newest first."""
    found = [
        each.parent
        for pattern in (f"*/{SUMMARY}", f"*/*/{SUMMARY}")
        for each in offered.FOLDER.glob(pattern)
        if (each.parent / TRAJECTORIES).is_file()
    ]
    found.sort(key=lambda folder: (folder / SUMMARY).stat().st_mtime, reverse=True)
    return [folder.relative_to(offered.FOLDER).as_posix() for folder in found]


def replay_of(name: str) -> str:
    """The page that plays an offered run.

    Raises:
        ResultsError: the run is not offered, damaged, or too large to show inside another page.
        FloorPlanError: its floor plan is damaged.
    """
    if name not in offered_runs():
        raise ResultsError(f"{name}: expected a saved run in {offered.FOLDER}")
    run = read_run(offered.FOLDER / name)
    text = page_text(run.trajectories, run.plan, title=title_of(run.summary, run.trajectories))
    if len(text) > LARGEST:
        raise ResultsError(
            f"{name}: {len(text) / 1e6:.0f} MB, expected at most {LARGEST / 1e6:.0f} MB on this "
            f"page: `mesa-mobility replay {name}` shows it in one of its own"
        )
    return text


@solara.component
def SavedRuns() -> None:
    """A list of saved runs, and the player of the one that is chosen."""
    names = solara.use_memo(offered_runs, [])
    name, choose = solara.use_state(NONE)
    heading(2, "Saved run", hidden=True)
    if not names:
        Note(f"No saved run in {offered.FOLDER}: `mesa-mobility run MODEL --out DIR` saves one.")
        return
    with solara.Div(style={"max-width": "480px", "padding-top": "14px"}):
        Choice("saved run", [NONE, *names], name, choose, HELP)
    if name != NONE:
        _Player(name).key(name)


@solara.component
def _Player(name: str) -> None:
    def read() -> tuple[str, str]:
        try:
            return replay_of(name), ""
        except MobilityError as error:
            return "", str(error)

    result: solara.Result[tuple[str, str]] = solara.use_thread(read, [name])
    if result.state == solara.ResultState.ERROR:
        solara.Error(f"{name}: {result.error}", dense=True)
    elif result.value is None:
        solara.ProgressLinear()
    elif result.value[1]:
        solara.Error(result.value[1], dense=True)
    else:
        _Frame(page=result.value[0])


@solara.component_vue("saved_run.vue")
def _Frame(page: str, height: str = "78vh") -> None:
    """A page in a frame that has no access to the one around it."""
