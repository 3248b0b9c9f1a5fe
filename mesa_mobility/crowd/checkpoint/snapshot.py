"""Saving a running model, and making it anew from the file.

A model is made by its own constructor, with the arguments that it was made with; then all that has
changed since is put in place. So only data is in the file, and terms, plans and maps come from the
code that the user has.
"""

from __future__ import annotations

import hashlib
import inspect
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from mesa_mobility._version import __version__
from mesa_mobility.crowd.checkpoint.archive import read_archive, write_archive
from mesa_mobility.crowd.checkpoint.behaviours import (
    behaviours_of,
    class_name,
    match_behaviours,
    pack_behaviour,
)
from mesa_mobility.crowd.checkpoint.checking import (
    CONTENT,
    COUNTERS,
    check_attributes,
    check_collected,
    check_crowd,
    check_ids,
    check_population,
    restore_behaviour,
    sizes_of,
)
from mesa_mobility.crowd.checkpoint.people import pack_people, restore_attributes
from mesa_mobility.crowd.checkpoint.plain import NotPlain, Packer, Unpacker, set_bits
from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.crowd.model.clock import scheduled_events, set_clock
from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.crowd.presets.shipped import PRESETS
from mesa_mobility.errors import MobilityError, ModelError
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.mobility.mapfile import shipped_map_path
from mesa_mobility.plugins import registry
from mesa_mobility.schema import Anything, Members, check

Model = TypeVar("Model", bound="CrowdModel")

SHIPPED = "able_bodied"
"""The map that a model without a map has."""


def save_model(model: CrowdModel, path: str | os.PathLike[str]) -> None:
    """Write a checkpoint, from which ``load`` goes on to the same trajectories.

    It holds the constructor's arguments and all that has changed since: people, behaviours,
    generators, records, and attributes of the model and its people. Maps are not in it but
    their digest is.

    Args:
        path: the file, a zip of arrays and JSON.

    Raises:
        ModelError: an attribute or a behaviour's state that cannot be saved, people who wait
            for a function, or a file that cannot be written.
    """
    model.bind()  # behaviours have a state from then on
    packer = Packer(_references(model))
    _refuse_functions(model)
    arguments, missing = _pack_arguments(model, packer)
    state = {
        "counters": {name: getattr(model, name) for name in COUNTERS},
        "random": [model.rng.bit_generator.state, model.random.getstate()],
        "parts": {name: part.state() for name, part in model.parts().items()},
        "collected": _collected(model),
    }
    content = {
        "mesa_mobility": __version__,
        "model": class_name(type(model)),
        "arguments": arguments,
        "missing_arguments": missing,
        "map_sha256": [map_digest(each) for each in model._scene.grounds.known.maps],
        **{
            name: packer.pack(value, f"{type(model).__name__}, {name}")
            for name, value in state.items()
        },
        "people": pack_people(model, packer),
        "behaviors": {
            group: [pack_behaviour(each, packer) for each in behaviours]
            for group, behaviours in behaviours_of(model).items()
        },
        "own": {
            name: packer.pack(vars(model)[name], f"{type(model).__name__}.{name}")
            for name in own_attributes(model)
        },
    }
    write_archive(path, content, packer.arrays)


def load_model(
    kind: type[Model],
    path: str | os.PathLike[str],
    plugins: Iterable[Plugin],
    given: Mapping[str, Any],
) -> Model:
    """The model of a checkpoint; see ``PedestrianModel.load``.

    Args:
        kind: class of the saved model, or one of its base classes.
        path: the file.
        plugins: behaviours that are neither installed nor made by the constructor.
        given: arguments for the constructor that the file cannot hold.
    """
    content, arrays = read_archive(path)
    try:
        check(content, CONTENT, "checkpoint")
        return _load(kind, content, arrays, plugins, given)
    except MobilityError as error:
        text = " ".join(str(error).split())  # texts of the file may have several lines
        raise ModelError(f"{os.fspath(path)}: {text}") from error
    except Exception as error:  # constructors of models meet values that no check knows of
        reason = next(iter(str(error).splitlines()), "")[:200]
        raise ModelError(
            f"{os.fspath(path)}: not a checkpoint of this version of the model "
            f"({type(error).__name__}: {reason})"
        ) from error


def _load(
    kind: type[Model],
    content: Mapping[str, Any],
    arrays: Mapping[str, Any],
    plugins: Iterable[Plugin],
    given: Mapping[str, Any],
) -> Model:
    made = _class_of(kind, content["model"])
    needed = [name for name in content["missing_arguments"] if name not in given]
    if needed:
        raise ModelError(
            f"the arguments {', '.join(needed)} of {made.__name__} are not in the file, expected "
            f"load(path, {', '.join(f'{name}=...' for name in needed)})"
        )
    unpacker = Unpacker(arrays, _Shipped())
    arguments = {name: unpacker.unpack(each) for name, each in content["arguments"].items()}
    model = made(**{**arguments, **given})
    digests = [map_digest(each) for each in model._scene.grounds.known.maps]
    if digests != content["map_sha256"]:
        raise ModelError("its mobility maps are others than those of the model that was saved")
    unpacker.objects = objects = dict(_names(model))

    parts = model.parts()
    states = unpacker.unpack(content["parts"])
    check(states, Members(dict.fromkeys(parts, Anything())), "parts")
    counters = unpacker.unpack(content["counters"])
    check(counters, Members(COUNTERS), "counters")
    for name, value in counters.items():
        setattr(model, name, value)
    model.time = model.elapsed
    set_clock(model)
    for name, part in parts.items():
        if name == "population":
            check_population(model, states[name])
        else:
            check(states[name], Members(part.members()), name, sizes_of(model))
        part.restore(states[name])
    check_crowd(model, states)
    check_ids(content["people"], model.inside)
    model.population.make_agents(
        model, content["people"]["unique_ids"], content["people"]["last_id"], model.frame
    )
    match_behaviours(model, content["behaviors"], plugins)
    objects.update(_names(model))
    restore_attributes(model, content["people"], unpacker)
    model.bind()
    for group, behaviours in behaviours_of(model).items():
        for each, saved in zip(behaviours, content["behaviors"][group], strict=True):
            restore_behaviour(model, each, unpacker.unpack(saved["state"]))
    own = {name: unpacker.unpack(value) for name, value in content["own"].items()}
    check_attributes(model, own)
    for name, value in own.items():
        setattr(model, name, value)
    _restore_collected(model, unpacker.unpack(content["collected"]))
    bits, state = unpacker.unpack(content["random"])
    set_bits(model.rng, bits)
    model.random.setstate(state)
    if unpacker.left:
        raise ModelError(f"arrays that nothing refers to: {', '.join(unpacker.left)}"[:200])
    return model


def own_attributes(model: CrowdModel) -> list[str]:
    """Names of the attributes that subclasses and users have added to a model."""
    return sorted(vars(model).keys() - model.framework_attributes)


def map_digest(map_: MobilityMap) -> str:
    """SHA-256 of all that a map says about movement."""
    digest = hashlib.sha256()
    for name, array in sorted(vars(map_).items()):
        if isinstance(array, np.ndarray):
            digest.update(f"{name} {array.dtype.str} {array.shape}".encode())
            digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()


class _Shipped(dict[Any, Any]):
    """The maps that ship, read when they are asked for."""

    def __missing__(self, name: tuple[str, str]) -> MobilityMap:
        return MobilityMap.load(shipped_map_path(name[1]))


def _references(model: CrowdModel) -> list[tuple[object, Any]]:
    return [(thing, name) for name, thing in _names(model)]


def _names(model: CrowdModel) -> list[tuple[Any, Any]]:
    """Objects that a constructor makes, by the names that values in the file have for them."""
    named: list[tuple[Any, Any]] = [
        ("model", model),
        ("plan", model.floor_plan),
        ("rng", model.rng),
        ("random", model.random),
        ("crowd", model.crowd),
        ("space", model.space),
    ]
    named += [(("type", k), each) for k, each in enumerate(model.pedestrian_types)]
    named += [(("map", k), each.mobility_map) for k, each in enumerate(model.pedestrian_types)]
    named += [(("inflow", k), each) for k, each in enumerate(model.sources)]
    named += [(("person", each.row), each) for each in model.space.active_agents]
    for group, behaviours in behaviours_of(model).items():
        named += [((group, k), each) for k, each in enumerate(behaviours)]
    return named


def _pack_arguments(model: CrowdModel, packer: Packer) -> tuple[dict[str, Any], list[str]]:
    """The constructor's arguments, and the names of those that the file cannot hold."""
    positional, keywords = model.made_with
    signature = inspect.signature(type(model).__init__)
    bound = signature.bind(model, *positional, **keywords)
    given = dict(list(bound.arguments.items())[1:])
    for parameter in signature.parameters.values():
        if parameter.kind is parameter.VAR_KEYWORD:
            given |= given.pop(parameter.name, {})
        elif parameter.kind is parameter.VAR_POSITIONAL and given.pop(parameter.name, None):
            raise ModelError(
                f"{type(model).__name__}: made with *{parameter.name}, expected arguments by name"
            )
    # Files change, and blocks of rules end.
    if "preset" in signature.parameters and model.rules != PRESETS.get(model.preset):
        given["preset"] = model.rules
    references: list[tuple[object, Any]] = []
    if any(_may_hold_a_map(value) for value in given.values()):
        references.append((MobilityMap.load(), ("shipped", SHIPPED)))
    own = Packer(references)
    own.arrays = packer.arrays
    packed: dict[str, Any] = {}
    missing = []
    for name, value in given.items():
        known = len(own.arrays)
        try:
            packed[name] = own.pack(value, name)
        except NotPlain:
            if name == "rng":  # the generator's own state follows
                packed[name] = 0
            else:
                missing.append(name)
            for each in list(own.arrays)[known:]:  # of what has been packed of it
                del own.arrays[each]
    return packed, missing


def _may_hold_a_map(value: Any) -> bool:
    return isinstance(value, MobilityMap) or (
        isinstance(value, Sequence) and any(hasattr(each, "mobility_map") for each in value)
    )


def _refuse_functions(model: CrowdModel) -> None:
    """Raise ModelError where functions of the user's are kept for later."""
    kind = type(model).__name__
    if model.waits.waiting_for_functions:
        raise ModelError(
            f"{kind}: {model.waits.waiting_for_functions} people wait until a function says so, "
            "which cannot be saved; expected waits of so many seconds"
        )
    if scheduled_events(model) > model.events_at_first:
        raise ModelError(f"{kind}: scheduled events cannot be saved; expected none to come")


_COLLECTED = ("model_vars", "_agent_records", "tables")


def _collected(model: CrowdModel) -> dict[str, Any]:
    found = {name: getattr(model.datacollector, name) for name in _COLLECTED}
    return {name: dict(each) for name, each in found.items()}


def _restore_collected(model: CrowdModel, saved: Mapping[str, Any]) -> None:
    check_collected(_collected(model), saved)
    for name in _COLLECTED:
        there = getattr(model.datacollector, name)
        there.clear()
        there.update(saved[name])
    # Functions are not in the file: columns that were added go on once they are added again.
    for name in saved["model_vars"].keys() - model.datacollector.model_reporters.keys():
        model.datacollector.model_reporters[name] = _nothing


def _nothing(model: CrowdModel) -> None:
    """What is collected in a column whose function is missing."""


def _class_of(kind: type[Model], name: str) -> type[Model]:
    """The class of a saved model: ``kind``, one below it that is imported, or an installed one."""
    known = [kind, *_below(kind)]
    for each in known:
        if class_name(each) == name:
            return each
    # A script is __main__ in one process and has a name of its own in another.
    if name.partition(":")[2] == kind.__qualname__:
        return kind
    wanted = name.rpartition(".")[2].rpartition(":")[2]
    for plugin in registry.models().values():
        if plugin.target.rpartition(":")[2] == wanted:
            installed: type[Any] = plugin.load()
            if class_name(installed) == name and issubclass(installed, kind):
                return installed
    raise ModelError(
        f"a checkpoint of {name}, which is neither {kind.__name__} nor installed nor imported; "
        "expected its class, as in MyModel.load(path)"
    )


def _below(kind: type[Model]) -> list[type[Model]]:
    children: list[type[Model]] = kind.__subclasses__()
    return [each for child in children for each in (child, *_below(child))]
