"""Fields for the parameters of a model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import solara

from mesa_mobility import PedestrianModel
from mesa_mobility.dashboard.offered import (
    COMMON,
    blamed,
    large,
    problems,
    recipe_of,
    settable,
    shown,
)
from mesa_mobility.dashboard.session.run_config import Recipe
from mesa_mobility.dashboard.session.session import Session
from mesa_mobility.dashboard.widgets.fields import Choice, Switch, TextField
from mesa_mobility.dashboard.widgets.text import Note
from mesa_mobility.plugins.parameters import Parameter, descriptions

SOON = 1.0
"""Seconds after which the page says that a model is being made."""


@solara.component
def ParameterForm(
    session: Session,
    kind: type[PedestrianModel],
    given: Mapping[str, Any] = {},
    start: Mapping[str, str] = {},
    key: str | None = None,
    on_made: Callable[[dict[str, str]], None] | None = None,
) -> None:
    """Fields for the parameters of a model's constructor; a change makes a new model.

    Args:
        session: the page's session.
        kind: the model's class.
        given: parameters that the page does not set.
        start: by name, texts of parameters that differ from the defaults.
        on_made: called with such texts when a model has been made of them.
    """
    known = solara.use_memo(lambda: settable(kind, given), [kind])
    defaults = {name: shown(each.default) for name, each in known.items()}
    texts, set_texts = solara.use_state(
        {name: start.get(name, default) for name, default in defaults.items()}
    )
    errors, set_errors = solara.use_state(dict[str, str]())
    nothing: tuple[Recipe, str] | None = None
    asking, ask = solara.use_state(nothing)
    texts_now = solara.use_ref(texts)
    explanations = {**COMMON, **descriptions(kind)}

    def make(recipe: Recipe, changed: str) -> None:
        made_of = texts_now.current

        def answer(problem: str) -> None:
            about = blamed(problem, known) or [changed]
            set_errors(dict.fromkeys(about, problem) if problem else {})
            if not problem and on_made is not None:
                on_made({name: text for name, text in made_of.items() if text != defaults[name]})

        session.build(recipe, answer)

    def build(changed: str = "") -> None:
        values = texts_now.current
        wrong = problems(known, values)
        set_errors(wrong)
        ask(None)
        if wrong:
            return
        recipe = recipe_of(kind, values, given)
        if large(known, recipe):
            ask((recipe, changed))
        else:
            make(recipe, changed)

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
            explanations.get(name) or str(parameter),
            texts[name],
            errors.get(name, ""),
            partial(change, name),
        )
    if errors.get(""):
        solara.Error(errors[""], dense=True)
    if asking is not None:
        recipe, changed = asking

        def go_on() -> None:
            ask(None)
            make(recipe, changed)

        _Question(large(known, recipe), go_on, lambda: ask(None))
    _Making(session)


@solara.component
def _Question(
    values: Mapping[str, Any], go_on: Callable[[], None], leave: Callable[[], None]
) -> None:
    what = ", ".join(f"{name} {value:,}" for name, value in values.items())
    text = f"{what}: to make this model may take minutes and gigabytes."
    with Note(text):
        solara.Button("Make it", small=True, on_click=go_on)
        solara.Button("Leave it", small=True, on_click=leave)


@solara.component
def _Making(session: Session) -> None:
    seconds = session.making.value
    if seconds >= SOON:
        # Not announced each second: the run's status says that a model is being made.
        with Note(f"The model is being made: {seconds:.0f} s", announced=False):
            solara.Button("Cancel", small=True, on_click=session.give_up)


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
        Switch(label, text == "True", lambda on: change(str(on)), description, error)
    elif isinstance(choices, tuple) and len(parameter.kinds) == 1:
        Choice(label, [str(each) for each in choices], text, change, description, error)
    else:
        whole = int in parameter.kinds
        span = parameter.range
        limits = None if span is None or span.high is None else span
        TextField(label, text, change, error, description, limits=limits, whole=whole)
