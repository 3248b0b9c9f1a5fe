"""The dashboard: everything on one page."""

from __future__ import annotations

from collections.abc import Callable

import reacton.core
import solara
import solara.lab

from mesa_mobility import MobilityError, PedestrianModel, registry
from mesa_mobility.dashboard.charts import Charts
from mesa_mobility.dashboard.controls import BehaviourControls, ParameterForm, TimeControls
from mesa_mobility.dashboard.crowd_view import CrowdCanvas
from mesa_mobility.dashboard.decision_view import DecisionCanvas
from mesa_mobility.dashboard.feed import use_feed
from mesa_mobility.dashboard.map_view import MapView
from mesa_mobility.dashboard.session import AS_TAKEN, IF_NOW, Session

DEFAULT_MODEL = "doorway"


@solara.component
def Dashboard(model: str | type[PedestrianModel] = DEFAULT_MODEL) -> None:
    """A model's whole page, with a run of its own for each browser tab.

    ``page = Dashboard(MyModel)`` in a file makes it a page for ``solara run``.

    Args:
        model: name of an installed model, or the class of one.
    """
    given = model if isinstance(model, type) else None
    own = [] if given is None else [given.__name__]
    names = [*own, *registry.models()]
    name, choose = solara.use_state(model if isinstance(model, str) else model.__name__)
    session = solara.use_memo(Session, [])
    session.together = reacton.core.get_render_context()

    def run() -> Callable[[], None]:
        session.start()
        return session.close

    solara.use_effect(run, [])
    problem, kind = "", given
    if given is None or name != given.__name__:
        try:
            kind = registry.load_model(name)
        except MobilityError as error:
            problem, kind = str(error), None

    solara.Title(f"{name} - mesa-mobility")
    with solara.AppBar():
        solara.AppBarTitle("mesa-mobility")
    with solara.Sidebar():
        with solara.Card("Model", margin=0, elevation=0):
            solara.Select("model", names, name, on_value=choose, dense=True)
            if problem:
                solara.Error(problem, dense=True)
            if kind is not None:
                ParameterForm(session, kind).key(name)
        with solara.Card("Behaviours", margin=0, elevation=0):
            BehaviourControls(session)
    solara.Style(STYLE)
    with solara.lab.Tabs():
        with solara.lab.Tab("Simulation"):
            _Simulation(session)
        with solara.lab.Tab("Mobility map"):
            _Map(session)


@solara.component
def _Simulation(session: Session) -> None:
    TimeControls(session)
    _Problem(session)
    with solara.Div(classes=["mm-halves"]):
        with solara.Div(classes=["mm-left"]):
            _Crowd(session)
        with solara.Div(classes=["mm-right"]):
            _Decision(session)
    _Charts(session)


# Components of their own, so that only what has changed is worked out anew.


@solara.component
def _Map(session: Session) -> None:
    maps = {kind.name: kind.mobility_map for kind in session.types.value}
    name, choose = solara.use_state("")
    if not maps:
        return
    name = name if name in maps else next(iter(maps))
    if len(maps) > 1:
        solara.Select("pedestrian type", list(maps), name, on_value=choose, dense=True)
    MapView(maps[name]).key(name)


STYLE = (
    ".mm-halves { display: flex; flex-wrap: wrap; gap: 12px; }"
    ".mm-left { flex: 3 1 480px; min-width: 0; } .mm-right { flex: 2 1 380px; min-width: 0; }"
    ".mm-table { font-size: 13px; border-spacing: 0; padding: 6px 0; }"
    ".mm-table th { text-align: left; } .mm-table td, .mm-table th { padding: 1px 12px 1px 0;"
    " vertical-align: top; border-bottom: 1px solid #eee; overflow-wrap: anywhere; }"
)
"""Look of what is drawn with HTML."""


@solara.component
def _Problem(session: Session) -> None:
    if session.problem.value:
        solara.Error(session.problem.value, dense=True)


@solara.component
def _Crowd(session: Session) -> None:
    def toggle(what: dict[str, object]) -> None:
        if "opening" in what:
            session.toggle_opening(str(what["opening"]))
        else:
            session.toggle_obstacle(int(str(what["obstacle"])))

    canvas = CrowdCanvas(
        floor=session.floor.value,
        selected=session.selected.value,
        event_seen=session.seen,
        event_pick=session.select,
        event_toggle=toggle,
    )
    use_feed(canvas, session.frame)


@solara.component
def _Decision(session: Session) -> None:
    what, set_what = solara.use_state(AS_TAKEN)

    def tell(choice: str) -> None:
        set_what(choice)
        session.tell(choice)

    nobody = session.selected.value < 0
    with solara.Row(gap="8px", style={"align-items": "center"}):
        with solara.ToggleButtonsSingle(what, on_value=tell, dense=True):
            solara.Button(AS_TAKEN, value=AS_TAKEN, small=True)
            solara.Button(IF_NOW, value=IF_NOW, small=True)
        solara.Button(
            "To its next decision", small=True, on_click=session.play_to_decision, disabled=nobody
        )
    use_feed(DecisionCanvas(floor=session.floor.value), session.decision)


@solara.component
def _Charts(session: Session) -> None:
    # A number that grows: the observer's lists are drawn anew.
    number, observer = session.series.value
    recipe = session.recipe.value
    if recipe is not None and observer is not None and number:
        Charts(observer, number, recipe.kind.reference_occupancy, recipe.kind.__name__.lower())
