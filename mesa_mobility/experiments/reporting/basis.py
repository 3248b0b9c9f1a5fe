"""The basis of the runs of an experiment: plan, people, assumptions, design."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any

from mesa_mobility.crowd import PedestrianModel
from mesa_mobility.errors import MobilityError
from mesa_mobility.experiments.experiment import Experiment, model_class
from mesa_mobility.experiments.reporting.labels import labels_of, meanings_of
from mesa_mobility.experiments.reporting.pictures import value_text
from mesa_mobility.experiments.workers.one_run import make_model, rules_of
from mesa_mobility.reports.run.basis import (
    ASSUMPTIONS,
    LIMITS,
    add_plan_picture,
    add_rooms,
    add_rules,
    add_types,
)
from mesa_mobility.reports.run.texts import count
from mesa_mobility.reports.words import with_value, words_of
from mesa_mobility.results import rooms_of

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.experiments.store import Store
    from mesa_mobility.reports.html import Page


def model_again(experiment: Experiment, frame: pd.DataFrame) -> PedestrianModel | None:
    """The model of the first run, as it was at the start; None where there is none to show.

    Args:
        experiment: the experiment.
        frame: rows of its store.
    """
    with suppress(MobilityError):  # the model need not be installed where the report is written
        if not issubclass(model_class(experiment.model), PedestrianModel):
            return None
        point = experiment.point(0)
        with rules_of(point).followed():
            made = make_model(experiment.model, point, int(frame["seed"].iloc[0]))
        return made if isinstance(made, PedestrianModel) else None
    return None


def add_basis(page: Page, store: Store, frame: pd.DataFrame) -> None:
    """Add plan, people and assumptions of the first run, where its model can be made again."""
    experiment = store.experiment()
    model = model_again(experiment, frame)
    page.section("Plan, people and assumptions", "basis")
    if model is None:
        page.text(
            "The model has no crowd, or is not installed where this page was written: its plan and "
            "its people are not shown."
        )
    else:
        plan = getattr(model, "building", None) or model.floor_plan
        add_plan_picture(page, plan)
        if len(rooms := rooms_of(plan)) > 1:
            add_rooms(page, rooms, plan)
        more = int(frame["inputs"].nunique()) - 1 if "inputs" in frame else 0
        page.text(
            f"Plan, people and behaviour are those of the first run{_point_said(experiment)}, at "
            "its start."
            + (" Other runs differ in what the section “Inputs” lists." if more > 0 else "")
        )
        add_types(page, model.summary()["people"])
        if len(model.sources):
            page.text(f"{count(len(model.sources), 'source')} of people let in more during a run.")
        for text in ASSUMPTIONS[:-1]:
            page.text(text)
        page.notice(LIMITS)
        add_rules(page, model.rules.numbers())
    _design(page, experiment, frame)


def _point_said(experiment: Experiment) -> str:
    """The values of the first point, in brackets."""
    labels = labels_of(experiment)
    said = [
        with_value(words_of(name, labels), value_text(value))
        for name, value in experiment.design[0].items()
    ]
    return f" ({', '.join(said)})" if said else ""


def _design(page: Page, experiment: Experiment, frame: pd.DataFrame) -> None:
    page.section("Design of the experiment", "design")
    rows: list[list[Any]] = [
        ["model", experiment.model],
        ["kind of design", experiment.design.kind.replace("_", " ")],
        ["points of the design (sets of parameters)", len(experiment.design)],
        [
            "runs of each point, with a seed each",
            "as many as it takes" if experiment.replications == "auto" else experiment.replications,
        ],
        ["seed of the experiment", experiment.seed],
        [
            "seeds of the points",
            "common: runs of one number have the same seed at all points"
            if experiment.seeds == "common"
            else "independent",
        ],
    ]
    for name, unit in (("max_seconds", "simulated s"), ("time_limit", "s of real time")):
        if getattr(experiment, name) is not None:
            rows.append([f"a run is stopped after ({unit})", f"{getattr(experiment, name):g}"])
    page.table("Design", ["what", "value"], [[what, str(value)] for what, value in rows])
    values, labels, meant = [], labels_of(experiment), meanings_of(experiment)
    for name, value in experiment.fixed.items():
        said = [words_of(name, labels), "the same in all runs", value_text(value)]
        values.append([*said, meant.get(name, "")])
    for name in experiment.design.column_types():
        each = sorted(frame[name].dropna().unique().tolist())
        listed = ", ".join(value_text(value) for value in each[:12])
        if len(each) > 12:
            listed = f"{value_text(each[0])} to {value_text(each[-1])}, {len(each)} values"
        values.append([words_of(name, labels), "varied", listed, meant.get(name, "")])
    if values:
        page.table("Parameters", ["parameter", "role", "values", "meaning"], values)
    else:
        page.text("All parameters of the model have their default values.")
