"""What a checkpoint must hold, compared with the model that is made of it.

Names of sizes in the declarations of parts and behaviours: ``people`` who have ever been in the
model, ``types``, ``options`` and ``clusters`` of all types together, ``bodies`` (distinct core
radii), ``destinations``, ``journeys``, ``groups``, ``exit_numbers``; names of ``exits``, ``gates``
and ``openings`` (both). A behaviour's own attributes with a length are sizes as well, such as
``counters``.
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any

import numpy as np

from mesa_mobility.crowd.arguments import MOST_FRAMES
from mesa_mobility.crowd.checkpoint.movements import check_choices, check_movements, check_next
from mesa_mobility.crowd.checkpoint.recordings import check_recording
from mesa_mobility.crowd.hooks import Plugin, ships
from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.state.records import LAST_FRAME
from mesa_mobility.errors import ContentError, MobilityError, ModelError
from mesa_mobility.schema import (
    Anything,
    Flag,
    Kind,
    Members,
    Real,
    Several,
    Sizes,
    Text,
    Whole,
    check,
)

_BEHAVIOUR = Members({"class": Text(), "name": Text(), "state": Anything()})

CONTENT = Members(
    {
        "format": Text(),
        "format_version": Whole(),
        "mesa_mobility": Text(),
        "model": Text(),
        "arguments": Several(Text(), dict),
        "missing_arguments": Several(Text()),
        "map_sha256": Several(Text()),
        "counters": Anything(),
        "random": Anything(),
        "parts": Anything(),
        "collected": Anything(),
        "people": Members(
            {
                "unique_ids": Several(Whole(1)),
                "last_id": Whole(),
                "own": Several(Text(), dict, values=Several(Text(), dict)),
            }
        ),
        "behaviors": Members(
            dict.fromkeys(("terms", "speed_rules", "target_choice", "tactics"), Several(_BEHAVIOUR))
        ),
        "own": Several(Text(), dict),
    }
)
"""The JSON object of a checkpoint, before the values in it are unpacked."""

COUNTERS: dict[str, Kind] = {
    "frame": Whole(high=LAST_FRAME),
    "frames_per_step": Whole(1, MOST_FRAMES),
    "running": Flag(),
    "steps": Whole(),
    "stalled": Flag(),
}
"""The attributes of a model itself that change while it runs."""


def sizes_of(model: CrowdModel) -> dict[str, Any]:
    """What names of sizes stand for in a model as it is now."""
    scene, plan = model._scene, model.floor_plan
    return {
        "people": model.population.count,
        "types": len(model.pedestrian_types),
        "options": len(scene.repertoire.table.options),
        "clusters": len(scene.repertoire.table.offsets) - 1,
        "bodies": scene.environment.bodies,
        "destinations": scene.environment.destinations,
        "journeys": len(model.journeys),
        "groups": len(model.population.groups),
        "exit_numbers": len(plan.exits),
        "exits": [each.name for each in plan.exits],
        "gates": [each.name for each in plan.gates],
        "ways": [
            *(each.name for each in plan.openings()),
            *(model.building.gates if model.building else ()),
        ],
        "openings": [each.name for each in plan.openings()],
    }


def check_population(model: CrowdModel, state: Any) -> None:
    """Raise ContentError unless the state of a model's population fits the model and itself."""
    given = state if isinstance(state, dict) else {}
    counts = {
        size: len(given[name]) if isinstance(given.get(name), list | np.ndarray) else 0
        for size, name in (("people", "agenda"), ("groups", "groups"))
    }
    check(state, Members(model.population.members()), "population", sizes_of(model) | counts)
    check(state["count"], Whole(counts["people"], counts["people"]), "population, count")


def check_crowd(model: CrowdModel, states: Mapping[str, Any]) -> None:
    """Raise ContentError unless the restored people fit the floor, and what else is restored."""
    scene, people, state = model._scene, model.population, states["population"]
    check_movements(scene, people.present, state, model.frame)
    check_next(scene, people.present, model.frame, states["dynamics"]["next"])
    columns = states.get("decisions", {}).get("columns")
    if columns:
        check_choices(columns[2], columns[3], scene)
    if model.recorder is not None:
        shifts = np.concatenate([scene.strips[:, 6:], *(each.shifts for each in scene.plan.shafts)])
        check_recording(states["recorder"], scene.crowd, model.frame, shifts)
    counted = (model.frame - 2) * FRAME_SECONDS
    for source, inflow in states["sources"]["inflows"]:
        if source.times is None:  # arrivals are counted frame by frame
            check(inflow["_next"], Real(counted, infinite=True), "sources, _next")


def restore_behaviour(model: CrowdModel, behaviour: Plugin, state: Any) -> None:
    """Give a behaviour of a model its state.

    Raises:
        ModelError: of one line, which names the behaviour and the member, whatever goes wrong.
    """
    where = f"behaviour {behaviour.name!r}"
    read = _Noting(state if isinstance(state, dict) else {})
    try:
        check(state, Several(Text(), dict), "state")
        _check_members(behaviour, state, sizes_of(model))
        behaviour.restore(read)
        if ships(behaviour):
            _make_again(behaviour)
    except MobilityError as error:
        raise ModelError(f"{where}: {error}") from error
    except Exception as error:
        member = f", after the member {read.last!r}" if read.last else ""
        raise ModelError(f"{where}: no state of it{member} ({error!r:.200})") from error


def check_alike(there: Mapping[str, Any], given: Mapping[str, Any], of: type, where: str) -> None:
    """Raise ContentError where attributes of an object would not be of the types that they have in
    a fresh one, or would hide what its class has.

    Args:
        there: the attributes of the fresh object.
        given: those that it is to have.
        of: its class.
        where: what it is called, for the error.
    """
    for name, value in given.items():
        if not name.isidentifier() or _is_code(inspect.getattr_static(of, name, None)):
            raise ContentError(f"{where}{name:.40}: expected the name of an attribute")
        before = there.get(name)
        if before is None or value is None:
            continue
        same = isinstance(value, type(before)) or (_is_number(before) and _is_number(value))
        if isinstance(before, np.ndarray) and isinstance(value, np.ndarray):
            same = (before.dtype, before.ndim) == (value.dtype, value.ndim)
        if not same:
            raise ContentError(
                f"{where}{name}: got a {type(value).__name__}, expected a {type(before).__name__}"
            )


def check_attributes(model: CrowdModel, given: Mapping[str, Any]) -> None:
    """As ``check_alike``, of the attributes that subclasses and users have added to a model."""
    for name in model.framework_attributes & given.keys():
        raise ContentError(f"own, {name}: expected attributes that all models do not have")
    check_alike(vars(model), given, type(model), "own, ")


def check_collected(there: Mapping[str, Mapping[str, Any]], given: Any) -> None:
    """Raise ContentError unless the tables of a data collector are as it has them itself."""
    columns = Several(Anything(), length="steps")
    # Reporters that were added are added again once a model has been loaded.
    reported = given.get("model_vars") if isinstance(given, Mapping) else None
    names = [*there["model_vars"], *(reported if isinstance(reported, Mapping) else ())]
    tables = {
        name: Members(dict.fromkeys(columns_of, Several(Anything(), length=f"rows of {name}")))
        for name, columns_of in there["tables"].items()
    }
    kinds = {
        "model_vars": Members(dict.fromkeys(names, columns)),
        "_agent_records": Several(Real(), dict),
        "tables": Members(tables),
    }
    check(given, Members(kinds), "collected")


def check_ids(people: Mapping[str, Any], inside: int) -> None:
    """Raise ContentError unless everybody inside has a number of their own, up to the last one."""
    ids = people["unique_ids"]
    check(len(ids), Whole(inside, inside), "people, number of unique_ids")
    check(len(set(ids)), Whole(inside, inside), "people, number of different unique_ids")
    check(people["last_id"], Whole(max(ids, default=0)), "people, last_id")


class _Noting(dict[str, Any]):
    """Members that note which of them was read last."""

    last = ""

    def __getitem__(self, name: str) -> Any:
        self.last = name
        return super().__getitem__(name)


def _check_members(behaviour: Plugin, state: Mapping[str, Any], sizes: Sizes) -> None:
    """Raise ContentError unless a behaviour's state is as it declares, or else as it is now."""
    kind, declared = type(behaviour), behaviour.members()
    own = {
        name: len(each) for name, each in vars(behaviour).items() if hasattr(type(each), "__len__")
    }
    given = state
    if behaviour.saved is None and kind.state is Plugin.state:
        # All attributes: a subclass of the class that declares some of them may have others.
        given = {name: each for name, each in state.items() if name in (declared or ())}
        rest = {name: each for name, each in state.items() if name not in given}
        check_alike(vars(behaviour), rest, kind, "state, ")
    if declared is not None:
        check(given, Members(declared), "state", {**own, **sizes})


def _make_again(behaviour: Plugin) -> None:
    """Have the class's own constructor check the parameters among a behaviour's attributes."""
    parameters = list(inspect.signature(type(behaviour)).parameters.values())
    known = vars(behaviour)
    given = {
        each.name: known[name]
        for each in parameters
        for name in (each.name, f"_{each.name}")
        if name in known
    }
    if all(each.name in given or each.default is not each.empty for each in parameters):
        type(behaviour)(**given)


def _is_code(value: object) -> bool:
    """Whether an attribute of a class is a function, a property or the like."""
    return callable(value) or hasattr(type(value), "__get__")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float | np.number) and not isinstance(value, bool)
