"""The methods of a model that list and set its numbers by their names."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.crowd.presets.naming import (
    CODE,
    MOST_ACCELERATION,
    MOST_ACCELERATION_NAME,
    ModelParameter,
    as_value,
    named,
    unknown,
)
from mesa_mobility.errors import ModelError


def parameters(model: CrowdModel) -> dict[str, ModelParameter]:
    """Every number of the model's behaviours and of its options, by its name.

    ``headway.weight`` is the weight of the term ``headway``, and ``headway.time`` its setting
    ``time``; tactics, speed rules and the target choice have their settings likewise. A term that
    is for some types of people alone has their names in brackets, as in ``headway[child].time``.
    ``options.most_acceleration`` is the preset's own.

    Returns:
        A ``ModelParameter`` for each: value, unit, bounds and source.
    """
    return model.numbers.listed(model.rules, _behaviours(model))


def set_parameters(model: CrowdModel, values: Mapping[str, Any], source: str = CODE) -> None:
    """Set numbers of the model's behaviours; all of them, or none.

    Args:
        values: by name, as ``parameters`` lists them; a text stands for a number, as with `--set`.
        source: what ``parameters`` gives as the source of these values.

    Raises:
        ModelError: an unknown name, a value out of range, or a number of the options, which are
            made with the model.
    """
    places = {name: (made, parameter) for name, made, parameter in named(_behaviours(model))}
    before: list[tuple[Plugin, str, Any]] = []
    try:
        for name, given in values.items():
            if name == MOST_ACCELERATION_NAME:
                if as_value(name, MOST_ACCELERATION, given) != model.rules.most_acceleration:
                    raise ModelError(
                        f"{name}: options are made with the model, expected it in a preset, in "
                        "model_rules or on the command line"
                    )
                continue
            if name not in places:
                raise unknown(name, [*places, MOST_ACCELERATION_NAME])
            made, parameter = places[name]
            value = as_value(name, parameter, given)
            before.append((made, parameter.name, getattr(made, parameter.name)))
            setattr(made, parameter.name, value)
    except ModelError:
        for made, attribute, value in reversed(before):
            object.__setattr__(made, attribute, value)
        raise
    for name in values:
        if name in places:
            made, parameter = places[name]
            model.numbers.note(name, getattr(made, parameter.name), source)


def rules_used(model: CrowdModel) -> dict[str, str]:
    """The preset with its digest, and the numbers that are not the preset's, as inputs of a run."""
    base = model.numbers.base
    found = {"preset": base.inputs_text}
    own = {f"preset {base.name}", "behaviour", base.source} - {CODE}
    changed = [str(each) for each in parameters(model).values() if each.source not in own]
    return found | ({"changed numbers": "; ".join(changed)} if changed else {})


def _behaviours(model: CrowdModel) -> list[Plugin]:
    return [*model.terms, *model.tactics, *model.speed_rules, model.target_choice]
