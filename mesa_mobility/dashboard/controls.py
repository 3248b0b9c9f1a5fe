"""Controls for a running model: behaviours and time."""

from __future__ import annotations

import solara

from mesa_mobility.dashboard.forms import Choice, TextField
from mesa_mobility.dashboard.session.behaviours import TermState
from mesa_mobility.dashboard.session.session import Session
from mesa_mobility.errors import ModelError
from mesa_mobility.live.clock import FULL_SPEED
from mesa_mobility.plugins.parameters import Parameter

SPEEDS = {"0.25 x": 0.25, "1 x": 1.0, "2 x": 2.0, "5 x": 5.0, "20 x": 20.0, "full": FULL_SPEED}


@solara.component
def BehaviourControls(session: Session) -> None:
    """Behaviours on and off, and their weights, while the model runs."""
    choice = session.choice.value
    if len(choice.names) > 1:
        Choice(
            "where to go",
            list(choice.names),
            choice.name,
            session.choose_targets_by,
            "how people choose an exit, from each one's next decision on",
        )
    for state in session.behaviours.value:
        _Behaviour(session, state).key(state.name)


@solara.component
def _Behaviour(session: Session, state: TermState) -> None:
    error, set_error = solara.use_state("")

    def weigh(text: str) -> None:
        try:
            weight = Parameter("weight", (float,), 1.0).convert(text)
        except ModelError as problem:
            set_error(str(problem))
            return
        set_error("")
        if weight != state.weight:
            session.set_behaviour(state.name, state.on, weight)

    def switch(on: bool) -> None:
        session.set_behaviour(state.name, on, state.weight)

    label = state.name.replace("_", " ")
    with solara.Row(gap="4px", style={"align-items": "center"}):
        with solara.Div(style={"flex": "1"}, attributes={"title": state.description or label}):
            solara.v.Checkbox(
                label=label, v_model=state.on, on_v_model=switch, dense=True, hide_details=True,
                class_="mt-0 pt-0",
            )  # fmt: skip
        factor = f"Factor of {label} in the sum of costs; Enter applies it"
        with solara.Div(style={"width": "88px"}, attributes={"title": factor}):
            TextField("weight", f"{state.weight:g}", weigh, error, says=f"weight of {label}")


@solara.component
def TimeControls(session: Session) -> None:
    """Play, step, reset, speed, and how people are coloured."""
    status = session.status.value
    speed = next(name for name, value in SPEEDS.items() if value == session.speed.value)
    colour, set_colour = solara.use_state("speed")
    playing = status.state == "playing"
    over = status.state in ("no model", "finished", "failed", "building")

    def set_speed(name: str) -> None:
        session.set_speed(SPEEDS[name])

    def colour_by(name: str) -> None:
        set_colour(name)
        session.colour_by(name)

    row = {"align-items": "center", "flex-wrap": "wrap", "padding-top": "14px"}
    with solara.Row(gap="8px", style=row):
        solara.Button(
            "Pause" if playing else "Play",
            icon_name="mdi-pause" if playing else "mdi-play",
            on_click=lambda: session.play(not playing),
            disabled=over,
            color="primary",
            attributes={"title": "Let time go by, or not (space)"},
        )
        solara.Button(
            "Step",
            icon_name="mdi-skip-next",
            on_click=session.step,
            disabled=over or playing,
            attributes={"title": "One step of the model, 0.1 s unless it says otherwise"},
        )
        solara.Button(
            "Reset",
            icon_name="mdi-restart",
            on_click=session.reset,
            attributes={"title": "The same model from its beginning; behaviours stay as set"},
        )
        pace_help = "Simulated seconds in a second; full: as fast as possible"
        with solara.Div(style={"width": "90px"}, attributes={"title": pace_help}):
            solara.Select(
                "speed",
                list(SPEEDS),
                speed,
                on_value=set_speed,
                dense=True,
            )
        with solara.Div(
            style={"width": "130px"}, attributes={"title": "What the colours of people stand for"}
        ):
            names = list(session.colourings.value)
            shown = colour if colour in names else names[0]
            solara.Select("colour by", names, shown, on_value=colour_by, dense=True)
        pace = f", {status.pace:.1f} x real time" if playing and status.pace else ""
        reason = f": {status.reason}" if status.reason else ""
        solara.Text(f"{status.state}{pace}{reason}", classes=["mm-status"])
