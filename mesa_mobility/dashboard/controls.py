"""What is set on the page: parameters of the model, behaviours, time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import solara

from mesa_mobility import PedestrianModel
from mesa_mobility.commands.parameters import NOT_SETTABLE, Parameter, descriptions, parameters
from mesa_mobility.crowd import PRESETS
from mesa_mobility.dashboard.behaviours import TermState
from mesa_mobility.dashboard.clock import FULL_SPEED
from mesa_mobility.dashboard.colouring import COLOURINGS
from mesa_mobility.dashboard.recipe import Recipe
from mesa_mobility.dashboard.session import Session
from mesa_mobility.errors import ModelError

SPEEDS = {"0.25 x": 0.25, "1 x": 1.0, "2 x": 2.0, "5 x": 5.0, "20 x": 20.0, "full": FULL_SPEED}

SEED = Parameter("rng", (int,), 1)


def settable(kind: type[PedestrianModel]) -> dict[str, Parameter]:
    """The parameters that the page sets, preset, map and seed among them where a model has them."""
    found = {}
    for name, parameter in parameters(kind).items():
        if name == "rng":
            found[name] = SEED
        elif name == "preset":
            found[name] = Parameter(name, (tuple(PRESETS),), parameter.default)
        elif parameter.kinds and name != "record":
            found[name] = parameter
    # What every model has comes last, the model's own parameters first.
    return dict(sorted(found.items(), key=lambda item: item[0] in NOT_SETTABLE))


def shown(value: Any) -> str:
    """The text of a value that `Parameter.convert` turns back into it."""
    return "none" if value is None else str(value)


def recipe_of(kind: type[PedestrianModel], texts: Mapping[str, str]) -> Recipe:
    """The recipe that texts by name of the parameter stand for.

    Raises:
        ModelError: a text is not what its parameter takes.
    """
    known = settable(kind)
    return Recipe(
        kind, {name: known[name].convert(text, kind.__name__) for name, text in texts.items()}
    )


def blamed(message: str, names: Mapping[str, object]) -> str:
    """Which of some parameters an error is about: the first that its beginning names, or ""."""
    words = message.partition(":")[0].replace(",", " ").split()
    return next((word for word in words if word in names), "")


@solara.component
def ParameterForm(session: Session, kind: type[PedestrianModel]) -> None:
    """The parameters of a model's constructor; a change starts the model anew."""
    known = settable(kind)
    texts, set_texts = solara.use_state({name: shown(each.default) for name, each in known.items()})
    errors, set_errors = solara.use_state(dict[str, str]())
    texts_now = solara.use_ref(texts)
    told = descriptions(kind)

    def build(changed: str = "") -> None:
        values = texts_now.current
        for name, text in values.items():
            try:
                known[name].convert(text, kind.__name__)
            except ModelError as error:
                set_errors({name: str(error)})
                return

        def answer(problem: str) -> None:
            set_errors({blamed(problem, known) or changed: problem} if problem else {})

        session.build(recipe_of(kind, values), answer)

    solara.use_effect(build, [])

    def change(name: str, text: str) -> None:
        if text != texts_now.current[name]:
            texts_now.current = {**texts_now.current, name: text}
            set_texts(texts_now.current)
            build(name)

    for name, parameter in known.items():
        _Field(
            parameter,
            "seed" if name == "rng" else name.replace("_", " "),
            told.get(name, ""),
            texts[name],
            errors.get(name, ""),
            partial(change, name),
        )
    if errors.get(""):
        solara.Error(errors[""], dense=True)


@solara.component
def _Field(
    parameter: Parameter,
    label: str,
    description: str,
    text: str,
    error: str,
    change: Callable[[str], None],
) -> None:
    choices = parameter.kinds[0]
    if parameter.kinds == (bool,):
        solara.Checkbox(
            label=label, value=text == "True", on_value=lambda value: change(str(value))
        )
    elif isinstance(choices, tuple) and len(parameter.kinds) == 1:
        solara.Select(label, [str(each) for each in choices], text, on_value=change, dense=True)
    else:
        _Text(label, text, change, error, description)
        return
    if error:
        solara.Error(error, dense=True)


@solara.component
def _Text(
    label: str,
    text: str,
    change: Callable[[str], None],
    error: str = "",
    description: str = "",
    says: str = "",
) -> None:
    """A field that tells of what was typed on Enter, or when it is left.

    What is being typed is kept as well: the page may be drawn anew meanwhile.
    """
    draft, set_draft = solara.use_state(text)
    solara.use_effect(lambda: set_draft(text), [text])
    field = solara.v.TextField(
        label=label,
        v_model=draft,
        on_v_model=set_draft,
        error=bool(error),
        messages=[error or description] if error or description else [],
        hide_details="auto",
        dense=True,
        class_="mb-1",
        attributes={"aria-label": says or label},
    )

    def done(widget: Any, event: str, data: Any) -> None:
        change(str(widget.v_model))

    solara.v.use_event(field, "blur", done)
    solara.v.use_event(field, "keyup.enter", done)


@solara.component
def BehaviourControls(session: Session) -> None:
    """Behaviours on and off, and their weights, while the model runs."""
    choice = session.choice.value
    if len(choice.names) > 1:
        solara.Select(
            "where to go", list(choice.names), choice.name, on_value=session.choose_targets_by,
            dense=True,
        )  # fmt: skip
    for state in session.behaviours.value:
        _Behaviour(session, state).key(state.name)


@solara.component
def _Behaviour(session: Session, state: TermState) -> None:
    error, set_error = solara.use_state("")

    def weigh(text: str) -> None:
        try:
            weight = Parameter("weight", (float,), 1.0).convert(text, state.name)
        except ModelError:
            set_error(f"{text!r}: expected a number")
            return
        set_error("")
        if weight != state.weight:
            session.set_behaviour(state.name, state.on, weight)

    def switch(on: bool) -> None:
        session.set_behaviour(state.name, on, state.weight)

    label = state.name.replace("_", " ")
    with solara.Row(gap="4px", style={"align-items": "center"}):
        with solara.Tooltip(state.description), solara.Div(style={"flex": "1"}):
            solara.v.Checkbox(
                label=label, v_model=state.on, on_v_model=switch, dense=True, hide_details=True,
                class_="mt-0 pt-0",
            )  # fmt: skip
        with solara.Div(style={"width": "88px"}):
            _Text("weight", f"{state.weight:g}", weigh, error, says=f"weight of {label}")


@solara.component
def TimeControls(session: Session) -> None:
    """Play, step, reset, speed, and how people are coloured."""
    status = session.status.value
    speed, set_speed = solara.use_state("1 x")
    colour, set_colour = solara.use_state("speed")
    playing = status.state == "playing"
    over = status.state in ("finished", "stalled", "failed", "building")

    def speed_up(name: str) -> None:
        set_speed(name)
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
        )
        solara.Button(
            "Step", icon_name="mdi-skip-next", on_click=session.step, disabled=over or playing
        )
        solara.Button("Reset", icon_name="mdi-restart", on_click=session.reset)
        with solara.Div(style={"width": "90px"}):
            solara.Select("speed", list(SPEEDS), speed, on_value=speed_up, dense=True)
        with solara.Div(style={"width": "130px"}):
            solara.Select("colour by", list(COLOURINGS), colour, on_value=colour_by, dense=True)
        pace = f", {status.pace:.1f} x real time" if playing and status.pace else ""
        solara.Text(f"{status.state}{pace}", classes=["mm-status"])
