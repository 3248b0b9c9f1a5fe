"""The dashboard's page, assembled from its parts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import reacton.core
import solara

from mesa_mobility import MobilityError, PedestrianModel
from mesa_mobility.dashboard.address import Address, Start, read, write
from mesa_mobility.dashboard.board.board import Board
from mesa_mobility.dashboard.controls import BehaviourControls, TimeControls, standing_in_words
from mesa_mobility.dashboard.forms import ParameterForm
from mesa_mobility.dashboard.model_files import load_offered, offered_models
from mesa_mobility.dashboard.quiet import keep_quiet
from mesa_mobility.dashboard.saved_runs import SavedRuns
from mesa_mobility.dashboard.session.feed import Fed
from mesa_mobility.dashboard.session.session import AS_TAKEN, IF_NOW, NOBODY, Session
from mesa_mobility.dashboard.views.body_view import BodyCanvas
from mesa_mobility.dashboard.views.charts import Charts, dark
from mesa_mobility.dashboard.views.crowd_view import CrowdCanvas
from mesa_mobility.dashboard.views.decision_view import DecisionCanvas
from mesa_mobility.dashboard.views.map_view import MapView
from mesa_mobility.dashboard.views.page_frame import PageFrame
from mesa_mobility.dashboard.widgets.choosing import OneOf, Tabs
from mesa_mobility.dashboard.widgets.fields import Choice, TextField
from mesa_mobility.dashboard.widgets.text import Note, heading
from mesa_mobility.dashboard.widgets.text import status as said_aloud
from mesa_mobility.plugins import registry

DEFAULT_MODEL = "doorway"

PLAN, BODIES = "plan", "three dimensions"
"""The two views of the crowd."""

VIEWS = {PLAN: "The crowd from above, on its floor plan", BODIES: "The crowd as walking figures"}
DECISIONS = {
    AS_TAKEN: "The last decision of the selected person, with everything as it was then",
    IF_NOW: "The decision that the selected person would take at this moment",
}
"""Buttons that choose a view, and what they show."""

MODELS = "a model; floor_plan takes a plan of your own"
MODELS_AND_FILES = "floor_plan takes a plan of your own, .py files are models"

TABS = {
    "Simulation": "The model that runs",
    "Mobility map": "The recorded movements that people are made of",
    "Drawing board": "Draw a floor plan, and save it as GeoJSON",
    "Saved run": "Watch a run that was saved before",
}
"""The page's tabs, and what they are for."""

# A page that imports this is served by Solara a moment later.
keep_quiet()


@solara.component
def Dashboard(
    model: str | type[PedestrianModel] = DEFAULT_MODEL,
    given: Mapping[str, Any] = {},
    model_files: bool = False,
) -> None:
    """A model's whole page, with a run of its own for each browser tab.

    ``page = Dashboard(MyModel)`` in a file makes it a page for ``solara run``.

    Args:
        model: name of an installed model, or the class of one.
        given: values of model parameters that the page does not set, by name.
        model_files: whether models in Python files of the folder that the page was started in are
            offered as well; the file of a model that is chosen is executed.
    """
    router = solara.use_router()
    start = solara.use_memo(lambda: read(router.search or ""), [])
    own = model if isinstance(model, type) else None
    opening = model if isinstance(model, str) else model.__name__
    files = solara.use_memo(lambda: offered_models() if model_files else [], [])
    names = [*([] if own is None else [opening]), *registry.models(), *files]
    first = start.model if start.model in names else opening
    name, choose = solara.use_state(first)
    texts, set_texts = solara.use_state(start.texts)
    opened = solara.use_ref(False)

    def make_session() -> Session:
        made = Session(start.behaviours, start.choice)
        made.enter(start.run)
        return made

    session = solara.use_memo(make_session, [])
    session.together = reacton.core.get_render_context()

    def run() -> Callable[[], None]:
        session.start()
        opened.current = True
        return session.close

    solara.use_effect(run, [])
    problem, kind = "", own
    if own is None or name != opening:
        try:
            kind = load_offered(name) if name in files else registry.load_model(name)
        except MobilityError as error:
            problem, kind = str(error), None

    title = f"{name} - mesa-mobility"
    solara.Title(title)
    with solara.AppBar():
        solara.AppBarTitle("mesa-mobility")
        PageFrame(title=title, event_told=dark.set)
    with solara.Sidebar(), solara.Div(classes=["mm-sidebar"]):
        heading(2, "Model")
        about = MODELS_AND_FILES if model_files else MODELS
        Choice("model", names, name, choose, about, problem)
        if kind is not None:
            begins = name == first and not opened.current
            ParameterForm(
                session,
                kind,
                given=given if name == opening else {},
                start=start.texts if begins else {},
                on_made=set_texts,
            ).key(name)
        heading(2, "Behaviours")
        BehaviourControls(session)
    _Address(session, name, texts)
    solara.Style(STYLE)
    panels = {
        "Simulation": lambda: _Simulation(session),
        "Mobility map": lambda: _Map(session),
        "Drawing board": Board,
        "Saved run": SavedRuns,
    }
    Tabs("views of the model", TABS, panels)


@solara.component
def _Simulation(session: Session) -> None:
    folded, fold = solara.use_state(False)
    with solara.Div(classes=["mm-time"]):
        TimeControls(session)
    with solara.Div(classes=["mm-halves", "mm-folded"] if folded else ["mm-halves"]):
        with solara.Div(classes=["mm-left"]):
            _Crowd(session)
            solara.Button(
                "Show decision and charts" if folded else "Crowd alone",
                small=True,
                on_click=lambda: fold(not folded),
                attributes={
                    "title": "The crowd over the whole page, or beside decision and charts",
                    "aria-pressed": "true" if folded else "false",
                },
            )
            _Messages(session)
        with solara.Div(classes=["mm-right"]):
            _Decision(session)
            # Beside the crowd, where they are seen without scrolling until a decision is shown.
            _Charts(session)


# Separate components, so that only what has changed is rendered again.


@solara.component
def _Address(session: Session, name: str, texts: Mapping[str, str]) -> None:
    behaviours, choice = session.set_behaviours.value, session.set_choice.value
    Address(write(Start(session.key.value, name, texts, behaviours, choice)))


@solara.component
def _Map(session: Session) -> None:
    maps = {kind.name: kind.mobility_map for kind in session.types.value}
    name, choose = solara.use_state("")
    if not maps:
        return
    name = name if name in maps else next(iter(maps))
    if len(maps) > 1:
        Choice("pedestrian type", list(maps), name, choose, "whose map is shown below")
    MapView(maps[name]).key(name)


STYLE = (
    ".mm-halves { display: flex; flex-wrap: wrap; gap: 12px; }"
    ".mm-left { flex: 5 1 480px; min-width: 0; } .mm-right { flex: 2 1 340px; min-width: 0; }"
    ".mm-folded .mm-right { display: none; }"
    # In a low window they cover the lower end of the crowd.
    ".mm-messages { position: sticky; bottom: 0; background: #fff; }"
    ".theme--dark .mm-messages { background: #121212; }"
    ".mm-table { font-size: 13px; border-spacing: 0; padding: 6px 0; }"
    ".mm-table th { text-align: left; } .mm-table td, .mm-table th { padding: 1px 12px 1px 0;"
    " vertical-align: top; border-bottom: 1px solid #8884; overflow-wrap: anywhere; }"
    ".mm-sidebar { padding: 16px 20px; }"
    ".mm-heading { font-size: 18px; font-weight: 500; margin: 8px 0; }"
    "h3.mm-heading { font-size: 14px; margin: 4px 0 2px; }"
    # Read by screen readers, and nowhere else.
    ".mm-hidden { position: absolute; width: 1px; height: 1px; margin: -1px; overflow: hidden;"
    " clip-path: inset(50%); white-space: nowrap; }"
    ".mm-note-box { padding: 8px 12px; margin: 6px 0; font-size: 14px; border-radius: 4px;"
    " border-left: 4px solid #1565c0; background: #8881; }"
    ".mm-one-of { display: inline-flex; flex-wrap: wrap; gap: 2px; }"
    ".mm-one-of .mm-down { background-color: #37474f !important; color: #fff !important; }"
    ".mm-behaviour { display: flex; gap: 8px; align-items: center; }"
    ".mm-behaviour > :first-child { flex: 1; }"
    ".mm-person { display: flex; flex-wrap: wrap; gap: 8px; align-items: center; }"
)
"""Styles of the HTML."""


@solara.component
def _Messages(session: Session) -> None:
    # Below the crowd, which would move under the pointer if they came above it.
    with solara.Div(classes=["mm-messages"]):
        said_aloud(standing_in_words(session.status.value))
        if session.problem.value:
            solara.Error(session.problem.value, dense=True)
        for notice in session.notices.value:
            Note(notice)


@solara.component
def _Crowd(session: Session) -> None:
    def pick(what: dict[str, Any]) -> None:
        if "by" in what:
            session.select_beside(what["by"], what["run"])
        else:
            session.select(what["row"], what["run"])

    def toggle(what: dict[str, Any]) -> None:
        if "opening" in what:
            session.toggle_opening(what["opening"], what["run"])
        else:
            session.toggle_obstacle(what["obstacle"], what["run"])

    def steer(what: dict[str, Any]) -> None:
        session.steer(what["row"], what["direction"], what["run"])

    shared = {
        "floor": session.floor.value,
        "selected": session.selected.value,
        "event_seen": session.seen,
        "event_pick": pick,
        "event_steer": steer,
        "event_play": lambda _: session.play(session.status.peek().state != "playing"),
    }
    view, set_view = solara.use_state(PLAN)

    def choose(name: str) -> None:
        set_view(name)
        session.show_bodies(name == BODIES)

    with solara.Column(gap="6px"):
        heading(2, "Crowd", hidden=True)
        OneOf("view of the crowd", VIEWS, view, choose)
        if view == BODIES and session.poses.value:
            solid = {"poses": session.poses.value, "solid": session.solid.value}
            Fed(session.frame, BodyCanvas, **solid, **shared).key("bodies")
        elif view == PLAN:
            Fed(session.frame, CrowdCanvas, event_toggle=toggle, shortcuts=True, **shared).key(
                "plan"
            )


@solara.component
def _Decision(session: Session) -> None:
    what, set_what = solara.use_state(AS_TAKEN)

    def tell(choice: str) -> None:
        set_what(choice)
        session.tell(choice)

    nobody = session.selected.value < 0
    heading(2, "Decision", hidden=True)
    _Person(session)
    with solara.Div(classes=["mm-person"]):
        OneOf("decision shown", DECISIONS, what, tell)
        solara.Button(
            "To the next decision",
            small=True,
            on_click=session.play_to_decision,
            disabled=nobody,
            attributes={"title": "Play until the selected person decides, and stop there"},
        )
    Fed(session.decision, DecisionCanvas, floor=session.floor.value)


@solara.component
def _Person(session: Session) -> None:
    """Whose decision is shown, without a pointer."""
    error, set_error = solara.use_state("")
    row = session.selected.value

    def choose(text: str) -> None:
        # Digits alone: nobody has a negative number, and an empty field is nobody.
        wrong = bool(text) and not text.isdecimal()
        set_error(f"person: got {text!r}, expected the number of a person" if wrong else "")
        if not wrong:
            session.select(int(text) if text else NOBODY)

    with solara.Div(classes=["mm-person"]):
        for name, by, about in (
            ("Previous person", -1, "Select the person with the next lower number (P)"),
            ("Next person", 1, "Select the person with the next higher number (N)"),
        ):
            solara.Button(
                name,
                small=True,
                on_click=lambda by=by: session.select_beside(by),
                attributes={"title": about},
            )
        with solara.Div(style={"width": "110px"}):
            TextField(
                "person",
                "" if row < 0 else str(row),
                choose,
                error,
                "Number of the person whose decision is shown; Enter selects",
                quiet=True,
            )


@solara.component
def _Charts(session: Session) -> None:
    # A number that grows: the observer's lists are drawn anew.
    number, observer = session.series.value
    recipe = session.recipe.value
    if recipe is not None and observer is not None and number:
        heading(2, "Charts", hidden=True)
        Charts(observer, number, recipe.kind.reference_occupancy, recipe.kind.__name__.lower())
