"""Fields for the parameters of a model."""

from __future__ import annotations

import math
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
from mesa_mobility.plugins.parameters import Parameter, descriptions

SLIDER_STEPS = 100
"""Number of steps of a slider for real numbers."""

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
    with solara.Warning(text, dense=True), solara.Row(gap="8px"):
        solara.Button("Make it", small=True, on_click=go_on)
        solara.Button("Leave it", small=True, on_click=leave)


@solara.component
def _Making(session: Session) -> None:
    seconds = session.making.value
    if seconds >= SOON:
        with solara.Info(f"The model is being made: {seconds:.0f} s", dense=True):
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
        solara.v.Checkbox(
            label=label,
            v_model=text == "True",
            on_v_model=lambda value: change(str(value)),
            **_below(error, description),
        )
    elif isinstance(choices, tuple) and len(parameter.kinds) == 1:
        Choice(label, [str(each) for each in choices], text, change, description, error)
    else:
        TextField(label, text, change, error, description)
        if parameter.range is not None and parameter.range.high is not None:
            _Slider(parameter, label, text, change)


def _below(error: str, description: str) -> dict[str, Any]:
    """What stands below a field: what is wrong, or else what it is for."""
    return {
        "error": bool(error),
        "messages": _messages(error, description),
        "hide_details": "auto",
        "dense": True,
    }


def _messages(error: str, description: str) -> list[str]:
    return [error or description] if error or description else []


@solara.component
def Choice(
    label: str,
    values: list[str],
    value: str,
    change: Callable[[str], None],
    description: str = "",
    error: str = "",
) -> None:
    """A list to choose from, with what it is for below it."""
    solara.v.Select(
        label=label,
        items=values,
        v_model=value,
        on_v_model=change,
        class_="mb-1",
        **_below(error, description),
    )


@solara.component_vue("text_field.vue")
def _TextField(
    text: str,
    label: str,
    says: str,
    error: bool,
    messages: list[str],
    event_done: Callable[[str], None],
) -> None: ...


@solara.component
def TextField(
    label: str,
    text: str,
    change: Callable[[str], None],
    error: str = "",
    description: str = "",
    says: str = "",
) -> None:
    """A field that reports its text on Enter, or when it loses the focus.

    Text that is being typed stays in the browser until then.
    """
    _TextField(
        text=text,
        label=label,
        says=says or label,
        error=bool(error),
        messages=_messages(error, description),
        event_done=change,
    )


@solara.component
def _Slider(parameter: Parameter, label: str, text: str, change: Callable[[str], None]) -> None:
    """A slider over a number's range, beside a field that takes other values, too."""
    assert parameter.range is not None
    assert parameter.range.high is not None
    low, high = parameter.range.low, parameter.range.high
    whole = int in parameter.kinds
    step = 1 if whole else (high - low) / SLIDER_STEPS
    value = _within(text, low, high)
    draft, set_draft = solara.use_state(value)
    solara.use_effect(lambda: set_draft(value), [value])
    slider = solara.v.Slider(
        v_model=draft,
        on_v_model=set_draft,
        min=low,
        max=high,
        step=step,
        dense=True,
        hide_details=True,
        thumb_label=True,
        class_="mb-2",
        attributes={"aria-label": f"{label}, slider", "title": f"Drag to set {label}"},
    )

    def released(widget: Any, event: str, data: Any) -> None:
        change(str(round(data)) if whole else f"{float(data):.6g}")

    # The model is not made anew while the slider is dragged.
    solara.v.use_event(slider, "change", released)


def _within(text: str, low: float, high: float) -> float:
    """The number nearest to what is typed; `low` where that is none, since NaN is not JSON."""
    try:
        value = float(text)
    except ValueError:
        return low
    return low if math.isnan(value) else min(max(value, low), high)
