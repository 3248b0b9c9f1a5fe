"""Controls for a running model: behaviours and time."""

from __future__ import annotations

import solara

from mesa_mobility.dashboard.session.behaviours import TermState
from mesa_mobility.dashboard.session.session import Session
from mesa_mobility.dashboard.session.view_state import Status
from mesa_mobility.dashboard.widgets.fields import Choice, Switch, TextField
from mesa_mobility.dashboard.widgets.text import status as said_aloud
from mesa_mobility.errors import ModelError
from mesa_mobility.live.clock import FULL_SPEED
from mesa_mobility.plugins.parameters import Parameter

SPEEDS = {"0.25 x": 0.25, "1 x": 1.0, "2 x": 2.0, "5 x": 5.0, "20 x": 20.0, "full": FULL_SPEED}

STATES = {
    "no model": "no model",
    "building": "the model is being made",
    "ready": "ready",
    "playing": "running",
    "finished": "ended",
    "stalled": "stalled",
    "failed": "failed",
}
"""What the page calls the states of a ``Status``."""

TOLD = 5
"""Blocked people that the page lists at most."""


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
    with solara.Div(classes=["mm-behaviour"]):
        Switch(label, state.on, switch, state.description or label, quiet=True)
        factor = f"Factor of {label} in the sum of costs; Enter applies it"
        with solara.Div(style={"width": "88px"}):
            TextField(
                "weight",
                f"{state.weight:g}",
                weigh,
                error,
                factor,
                says=f"weight of {label}",
                quiet=True,
            )


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

    row = {"align-items": "center", "flex-wrap": "wrap", "padding-top": "6px"}
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
        with solara.Div(style={"width": "90px"}):
            pace_help = "Simulated seconds in a second; full: as fast as possible"
            Choice("speed", list(SPEEDS), speed, set_speed, pace_help, quiet=True)
        with solara.Div(style={"width": "140px"}):
            names = list(session.colourings.value)
            shown = colour if colour in names else names[0]
            colour_help = "What the colours of people stand for"
            Choice("colour by", names, shown, colour_by, colour_help, quiet=True)
        said_aloud(in_words(status), "mm-status")
        # Apart from it: a pace that changes each second is not read aloud.
        if playing and status.pace:
            solara.Text(f"{status.pace:.1f} x real time")


def in_words(status: Status) -> str:
    """A run's state, and why nobody gets out."""
    return f"{STATES[status.state]}{f': {status.reason}' if status.reason else ''}"


def standing_in_words(status: Status) -> str:
    """Who has stood for a minute without a reason, and who is in the way of each."""
    told = [
        f"{row} (in the way: {', '.join(map(str, chain))})" if chain else f"{row}"
        for row, chain in status.blocked[:TOLD]
    ]
    if not told:
        return ""
    more = len(status.blocked) - len(told)
    people = "person" if len(status.blocked) == 1 else "people"
    return f"blocked for a minute: {people} {'; '.join(told)}{f'; {more} more' if more else ''}"
