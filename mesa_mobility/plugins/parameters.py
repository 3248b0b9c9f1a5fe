"""Parameters of models and behaviours, as their constructors declare them; `--set NAME=VALUE`."""

from __future__ import annotations

import builtins
import inspect
import math
import types
import typing
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mesa_mobility.distributions import Distribution, parse
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.annotations import Files, ListOf, Range
from mesa_mobility.plugins.registry import did_you_mean

# Parameters that have an option of their own, or are the command's business.
OWN_OPTION = {"rng": "--seed", "preset": "--preset", "mobility_map": "--map"}
NOT_SETTABLE = {*OWN_OPTION, "record"}
_NAMES = {types.NoneType: "none", Distribution: "distribution", Path: "file"}
_EXPECTED = {
    int: "a whole number",
    float: "a number",
    bool: "yes or no",
    str: "text",
    types.NoneType: "none",
    Distribution: "a distribution",
    Path: "a file",
}
_LONGEST = 40
"""Characters of a text that a message repeats."""

TRUE, FALSE = {"true", "yes", "on", "1"}, {"false", "no", "off", "0"}


@dataclass(frozen=True)
class Parameter:
    """One keyword parameter of a model, or one setting of a behaviour.

    Attributes:
        name: as in the constructor.
        kinds: the types it takes: int, float, bool, str, NoneType, Distribution, Path, or tuples
            of literal values.
        default: its default, or `inspect.Parameter.empty`.
        range: what a slider offers and a setting accepts, or None.
        files: which files a page offers, or None.
        entries: what a list has, or None.
    """

    name: str
    kinds: tuple[Any, ...]
    default: Any
    range: Range | None = None
    files: Files | None = None
    entries: ListOf | None = None

    def __str__(self) -> str:
        text = f"{self.name}: {self.takes}"
        return text if self.default is inspect.Parameter.empty else f"{text} = {self.default!r}"

    @property
    def takes(self) -> str:
        """The kinds of values that it takes, in a few words."""
        return _kinds_text(self.kinds)

    def convert(self, text: str) -> Any:
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
                raise ModelError(f"{self.name}: {error}") from None
        raise ModelError(f"{self.name}: got {quoted(text)}, expected {_expected(self.kinds)}")


def quoted(text: str) -> str:
    """A text as a message repeats it: on one line, and not all of a long one."""
    if not text.strip():
        return "nothing"
    return repr(text if len(text) <= _LONGEST else text[:_LONGEST] + "...")


def parameters(model: type) -> dict[str, Parameter]:
    """The keyword parameters of a model's constructor, in their order."""
    found = {}
    for parameter in list(inspect.signature(model).parameters.values()):
        if parameter.kind not in (parameter.POSITIONAL_OR_KEYWORD, parameter.KEYWORD_ONLY):
            continue
        found[parameter.name] = parameter_of(
            parameter.name, _annotation(model, parameter), parameter.default
        )
    return found


def parameter_of(name: str, annotation: Any, default: Any) -> Parameter:
    """The parameter that an evaluated annotation and a default declare."""
    if annotation in (inspect.Parameter.empty, Any):
        kinds = _kinds_of_default(default)
    else:
        kinds = tuple(_kinds(annotation))
    said = {type(each): each for each in _said(annotation)}
    return Parameter(name, kinds, default, said.get(Range), said.get(Files), said.get(ListOf))


def descriptions(model: type) -> dict[str, str]:
    """The description of each parameter in a model's docstring, under `Args:`, on one line each."""
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
    settings = list(settings)
    for setting in settings:
        key = setting.partition("=")[0].strip()
        option = OWN_OPTION.get("rng" if key == "seed" and key not in taken else key)
        if option is not None and "=" in setting:
            raise ModelError(f"--set {setting}: use {option}")
    return values_of(taken, f"model {name}", settings)


def values_of(
    taken: Mapping[str, Parameter], whose: str, settings: Iterable[str], called: str = "parameter"
) -> dict[str, Any]:
    """Values from texts NAME=VALUE.

    Args:
        taken: the parameters that may be set, by name.
        whose: they are, for messages.
        settings: the texts.
        called: what the parameters are, for messages.

    Raises:
        ModelError: a text without =, an unknown name, a name set twice, or a value that is not
            what the parameter takes.
    """
    values: dict[str, Any] = {}
    for setting in settings:
        key, equals, text = setting.partition("=")
        key = key.strip()
        if not equals:
            raise ModelError(f"--set {setting}: expected NAME=VALUE")
        if key not in taken:
            raise ModelError(unknown(whose, key, taken, called))
        if key in values:
            raise ModelError(f"--set {setting}: {key} is set twice")
        try:
            values[key] = taken[key].convert(text)
        except ModelError as error:
            raise ModelError(f"{whose}: {error}") from None
    return values


def unknown(whose: str, name: str, taken: Mapping[str, Parameter], called: str) -> str:
    """The message for a name that is not among those that are taken."""
    listed = "; ".join(str(parameter) for parameter in taken.values()) or "none"
    return f"{whose}: unknown {called} {name!r}{did_you_mean(name, taken)}; it takes {listed}"


def _annotation(model: type, parameter: inspect.Parameter) -> Any:
    constructor: Any = inspect.getattr_static(model, "__init__")
    return evaluated(parameter.annotation, getattr(inspect.unwrap(constructor), "__globals__", {}))


def evaluated(annotation: Any, names: Mapping[str, Any]) -> Any:
    """An annotation that may be text, with the names that it can use; `empty` where it is none."""
    if not isinstance(annotation, str):
        return annotation
    # A name imported for type checkers alone is unknown here; it stands for a type that no text
    # converts to, and the rest of the annotation counts.
    namespace = vars(builtins) | dict(names)
    try:
        return eval(annotation, {}, _Lenient(namespace))
    except Exception:
        return inspect.Parameter.empty


class _Lenient(dict[str, Any]):
    def __missing__(self, name: str) -> type:
        return object


def _kinds(annotation: Any) -> Iterable[Any]:
    origin = typing.get_origin(annotation)
    if annotation is Any:
        yield str
    elif origin is typing.Annotated:
        yield from _kinds(typing.get_args(annotation)[0])
    elif origin in (typing.Union, types.UnionType):
        # None and numbers come before types that accept any text, and before a distribution,
        # whose own message names the fault of a text.
        members = [kind for each in typing.get_args(annotation) for kind in _kinds(each)]
        yield from sorted(members, key=lambda kind: kind in (str, Path, Distribution))
    elif origin is typing.Literal:
        yield typing.get_args(annotation)
    elif annotation is None:
        yield types.NoneType
    elif annotation in (bool, int, float, str, types.NoneType, Distribution, Path):
        yield annotation


def _kinds_of_default(default: Any) -> tuple[Any, ...]:
    """The types of a parameter without an annotation."""
    if default is inspect.Parameter.empty:
        return (str,)
    if default is None:
        return (types.NoneType, int, float, str)
    if isinstance(default, Distribution):
        return (float, Distribution)
    if isinstance(default, Path):
        return (Path,)
    return (type(default),) if type(default) in (bool, int, float, str) else ()


def _said(annotation: Any) -> Iterable[Any]:
    """The metadata beside the types in an annotation."""
    if typing.get_origin(annotation) is typing.Annotated:
        yield from annotation.__metadata__
    for each in typing.get_args(annotation):
        yield from _said(each)


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
        # The class's own message names the fault.
        return parse(text)
    elif kind is Path and not text:
        raise ValueError(text)
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


def _expected(kinds: tuple[Any, ...]) -> str:
    texts: list[str] = []
    for kind in kinds:
        texts += map(str, kind) if isinstance(kind, tuple) else [_EXPECTED[kind]]
    return " or ".join(texts) or "a value that only Python can give"
