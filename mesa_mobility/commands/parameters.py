"""`--set NAME=VALUE` against what a model's constructor takes."""

from __future__ import annotations

import builtins
import inspect
import math
import types
import typing
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from mesa_mobility.distributions import Distribution, parse
from mesa_mobility.errors import ModelError
from mesa_mobility.registry import did_you_mean

# Parameters that have an option of their own, or are the command's business.
OWN_OPTION = {"rng": "--seed", "preset": "--preset", "mobility_map": "--map"}
NOT_SETTABLE = {*OWN_OPTION, "record"}
_NAMES = {types.NoneType: "none", Distribution: "distribution"}
TRUE, FALSE = {"true", "yes", "on", "1"}, {"false", "no", "off", "0"}


@dataclass(frozen=True)
class Parameter:
    """One keyword parameter of a model.

    Attributes:
        name: as in the constructor.
        kinds: the types it takes: int, float, bool, str, NoneType, Distribution, or tuples of
            literal values.
        default: its default, or `inspect.Parameter.empty`.
    """

    name: str
    kinds: tuple[Any, ...]
    default: Any

    def __str__(self) -> str:
        text = f"{self.name}: {_kinds_text(self.kinds)}"
        return text if self.default is inspect.Parameter.empty else f"{text} = {self.default!r}"

    def convert(self, text: str, model: str) -> Any:
        """The value that a text stands for.

        Raises:
            ModelError: the text is none of the parameter's kinds.
        """
        for kind in self.kinds:
            try:
                return _convert(text, kind)
            except ValueError:
                continue
            except ModelError as error:
                raise ModelError(f"model {model}: {self.name}: {error}") from None
        raise ModelError(
            f"model {model}: {self.name}={text} is not {_kinds_text(self.kinds)} (parameter {self})"
        )


def parameters(model: type) -> dict[str, Parameter]:
    """The keyword parameters of a model's constructor, in their order."""
    found = {}
    for parameter in list(inspect.signature(model).parameters.values()):
        if parameter.kind not in (parameter.POSITIONAL_OR_KEYWORD, parameter.KEYWORD_ONLY):
            continue
        kinds = tuple(_kinds(_annotation(model, parameter)))
        found[parameter.name] = Parameter(parameter.name, kinds, parameter.default)
    return found


def descriptions(model: type) -> dict[str, str]:
    """What a model's docstring says of each parameter, under `Args:`, on one line each."""
    found: dict[str, list[str]] = {}
    name, indent = "", 0
    lines = iter((inspect.getdoc(model) or "").splitlines())
    for line in lines:
        if line.strip() in ("Args:", "Arguments:", "Parameters:"):
            break
    for line in lines:
        text = line.strip()
        depth = len(line) - len(line.lstrip())
        if text and depth == 0:
            break
        indent = indent or depth
        head, colon, rest = text.partition(":")
        if colon and depth == indent:
            name = head.split()[0]
            found[name] = [rest.strip()]
        elif text and name:
            found[name].append(text)
    return {name: " ".join(parts).strip() for name, parts in found.items()}


def chosen(model: type, name: str, settings: Iterable[str]) -> dict[str, Any]:
    """Constructor keywords from texts NAME=VALUE.

    Args:
        model: the model's class.
        name: what the user calls it.
        settings: the texts.

    Raises:
        ModelError: a text without =, an unknown name, a name set twice, or a value that is not
            what the parameter takes.
    """
    taken = {key: each for key, each in parameters(model).items() if key not in NOT_SETTABLE}
    values: dict[str, Any] = {}
    for setting in settings:
        key, equals, text = setting.partition("=")
        key = key.strip()
        if not equals:
            raise ModelError(f"--set {setting}: expected NAME=VALUE")
        if key in OWN_OPTION:
            raise ModelError(f"--set {setting}: use {OWN_OPTION[key]}")
        if key not in taken:
            raise ModelError(
                f"model {name}: unknown parameter {key!r}{did_you_mean(key, taken)}; "
                f"it takes {_listing(taken)}"
            )
        if key in values:
            raise ModelError(f"--set {setting}: {key} is set twice")
        values[key] = taken[key].convert(text, name)
    return values


def _listing(parameters: Mapping[str, Parameter]) -> str:
    return "; ".join(str(parameter) for parameter in parameters.values()) or "none"


def _annotation(model: type, parameter: inspect.Parameter) -> Any:
    annotation = parameter.annotation
    if not isinstance(annotation, str):
        return annotation
    # A name imported for type checkers alone is unknown here; it stands for a type that no text
    # converts to, and the rest of the annotation counts.
    constructor: Any = inspect.getattr_static(model, "__init__")
    namespace = vars(builtins) | getattr(inspect.unwrap(constructor), "__globals__", {})
    try:
        return eval(annotation, {}, _Lenient(namespace))
    except Exception:
        return inspect.Parameter.empty


class _Lenient(dict[str, Any]):
    def __missing__(self, name: str) -> type:
        return object


def _kinds(annotation: Any) -> Iterable[Any]:
    if annotation in (inspect.Parameter.empty, Any):
        yield str
    elif typing.get_origin(annotation) in (typing.Union, types.UnionType):
        # None and numbers before str, which any text fits, and before a distribution, which says
        # itself what is wrong with a text.
        members = [kind for each in typing.get_args(annotation) for kind in _kinds(each)]
        yield from sorted(members, key=lambda kind: kind in (str, Distribution))
    elif typing.get_origin(annotation) is typing.Literal:
        yield typing.get_args(annotation)
    elif annotation is None:
        yield types.NoneType
    elif annotation in (bool, int, float, str, types.NoneType, Distribution):
        yield annotation


def _convert(text: str, kind: Any) -> Any:
    if isinstance(kind, tuple):
        for value in kind:
            if text == str(value):
                return value
    elif kind is bool:
        if text.lower() in TRUE | FALSE:
            return text.lower() in TRUE
    elif kind is types.NoneType:
        if text.lower() == "none":
            return None
    elif kind is float:
        if math.isfinite(value := float(text)):
            return value
    elif kind is Distribution:
        # Whatever is wrong with it, its own message says so.
        return parse(text)
    else:
        return kind(text)
    raise ValueError(text)


def _kinds_text(kinds: tuple[Any, ...]) -> str:
    names: list[str] = []
    for kind in kinds:
        if isinstance(kind, tuple):
            names.extend(str(value) for value in kind)
        else:
            names.append(_NAMES.get(kind, kind.__name__))
    return " or ".join(names) or "settable from Python only"
