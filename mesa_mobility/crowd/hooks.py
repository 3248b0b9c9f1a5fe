"""Behaviours: how they are bound to a model, set, saved and restored."""

from __future__ import annotations

from abc import ABC
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.buildings import Building
from mesa_mobility.crowd.journeys.journeys import Journeys
from mesa_mobility.crowd.journeys.visit import Route
from mesa_mobility.crowd.lifts.escalators import Escalators
from mesa_mobility.crowd.lifts.lifts import Lifts
from mesa_mobility.crowd.lifts.refuges import Refuges
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.state.wishes import Wishes
from mesa_mobility.crowd.types.pedestrian_type import PedestrianType
from mesa_mobility.errors import ContentError, ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.plugins.parameters import Parameter
from mesa_mobility.plugins.registry import did_you_mean
from mesa_mobility.plugins.settings import being_made, checked, declared, has_attribute, making
from mesa_mobility.schema import Kind, Sizes

SHIPPED = "mesa_mobility."
"""How the names of modules begin whose behaviours are taken on trust."""

_OF_PRESETS = "mesa_mobility.crowd."


class People(Protocol):
    """The people of a model, as behaviours see them."""

    @property
    def count(self) -> int:
        """People who have ever been in the model."""

    @property
    def rows(self) -> NDArray[np.int64]:
        """Rows of the people inside, in the order of the model's agents."""

    @property
    def present(self) -> NDArray[np.int64]:
        """Those of ``rows`` who have not left since the step began."""

    @property
    def groups(self) -> Sequence[str | int]:
        """Names of the groups, in the order of their numbers from 1 on."""

    def exits(self, row: int) -> tuple[str, ...]:
        """Names of the exits by which somebody may leave; none if they go round for ever."""

    def send(self, row: int, exits: Sequence[str] | None, route: Route, frame: int) -> None:
        """Send somebody along a route and out by one of these exits."""


class World(Protocol):
    """A model as behaviours and agents see it: all that they are bound to.

    ``PedestrianModel`` is one.
    """

    @property
    def floor_plan(self) -> FloorPlan:
        """Where people walk."""

    @property
    def building(self) -> Building | None:
        """The building, if it has several levels."""

    @property
    def pedestrian_types(self) -> tuple[PedestrianType, ...]:
        """The types of people."""

    @property
    def crowd(self) -> Crowd:
        """The crowd's arrays, a row a person."""

    @property
    def population(self) -> People:
        """Who has come and who is inside."""

    @property
    def journeys(self) -> Journeys:
        """The routes of people who cross gates and visit places in order."""

    @property
    def lifts(self) -> Lifts:
        """The lifts, and who rides them."""

    @property
    def escalators(self) -> Escalators:
        """The escalators that move, and whom they carry."""

    @property
    def refuges(self) -> Refuges:
        """Where people wait who cannot leave."""

    @property
    def speed_rules(self) -> Sequence[Any]:
        """Behaviours that change preferred speeds."""

    @property
    def tactics(self) -> Sequence[Any]:
        """The steps from a target to what people want of their next movement, in order."""

    def wishes(
        self,
        rows: NDArray[np.int64],
        points: NDArray[np.float64] | None = None,
        speeds: NDArray[np.float64] | None = None,
    ) -> Wishes:
        """What people would do if nobody else were there, and who is in the way of that.

        Cost terms written in NumPy do not count: they may look at the others.

        Args:
            rows: (n,) these people, who are inside.
            points: (n, 2) where each wants to go, metres; by default the target of their last
                decision.
            speeds: (n,) how fast, m/s; by default as at their last decision.
        """

    @property
    def frame(self) -> int:
        """Frames since the start."""

    @property
    def elapsed(self) -> float:
        """Seconds since the start."""

    @property
    def rng(self) -> np.random.Generator:
        """The generator that all random numbers are drawn from."""


class _Setting(Kind):
    """A value that a setting takes."""

    def __init__(self, setting: Parameter) -> None:
        self._setting = setting

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all others."""
        try:
            checked(self._setting, value)
        except ModelError as error:
            raise ContentError(f"{where}: {error}") from None


_MAKING = ("__init__", "__post_init__", "bind", "restore")
"""Methods in which a behaviour may take on new attributes."""


class Plugin(ABC):
    """What all behaviours have in common: a name, settings, and three hooks to override.

    A setting is a parameter of the constructor with a ``Range``, and the attribute of this name::

        def __init__(self, time: Annotated[float, Range(0.1, 10, "s")] = 1.2) -> None:
            self.time = time

    A setting is checked whenever it is set. Once a behaviour is made, it takes on no new attributes
    except those that its class annotates, those that ``bind`` sets, and names that begin with _.

    Attributes:
        name: unique name, as it is registered and shown.
        saved: the attributes that a checkpoint holds beside the settings, and what each of them is,
            in the words of ``mesa_mobility.schema``:
            ``{"_lines": Several(Whole(below="people"))}``.
            A checkpoint with other attributes is refused. By default None: a checkpoint holds all
            attributes, and they are only compared with those of a fresh object.
    """

    name: ClassVar[str]

    saved: ClassVar[Mapping[str, Kind] | None] = None

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        for method in _MAKING:
            if method in vars(cls):
                setattr(cls, method, making(vars(cls)[method]))

    def __setattr__(self, name: str, value: Any) -> None:
        # Values are plain attributes, so that to read one costs nothing.
        if name[:1] != "_":
            setting = declared(type(self)).get(name)
            if setting is not None:
                self._set(setting, value)
                return
            if not (being_made(self) or has_attribute(self, name)):
                raise ModelError(self._unknown(name))
        object.__setattr__(self, name, value)

    def _set(self, setting: Parameter, value: Any) -> None:
        name, made = setting.name, not being_made(self)
        if made and setting.entries is not None and setting.entries.once:
            raise ModelError(f"{self._called}: {name} is set by the constructor alone")
        try:
            value = checked(setting, value)
        except ModelError as error:
            raise ModelError(f"{self._called}: {error}") from None
        before = getattr(self, name, value)
        object.__setattr__(self, name, value)
        if made:
            try:
                self.check_settings()
            except ModelError:
                object.__setattr__(self, name, before)
                raise

    @property
    def _called(self) -> str:
        """The name, or that of the class: a behaviour without a name is refused later."""
        return str(getattr(self, "name", type(self).__name__))

    def _unknown(self, name: str) -> str:
        kind = type(self)
        properties = [each for each in dir(kind) if isinstance(getattr(kind, each), property)]
        named = dict.fromkeys([*declared(kind), *vars(self), *properties])
        known = [each for each in named if each[0] != "_"]
        meant = did_you_mean(name, dict.fromkeys(known)) or f", it has {', '.join(known) or 'none'}"
        return f"{self._called}: no setting {name!r}{meant}"

    def settings(self) -> dict[str, Any]:
        """Numbers and names that are settings, as they are now, for ``state``.

        Lists of objects are left out: whoever makes the behaviour anew gives them again.
        """
        return {
            name: getattr(self, name)
            for name, each in declared(type(self)).items()
            if hasattr(self, name) and (each.entries is None or each.entries.kind is str)
        }

    def check_settings(self) -> None:  # noqa: B027
        """Raise ModelError where settings, each in its range, do not fit together.

        Called when a behaviour has been made, and whenever a setting has changed.
        """

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(self._told())})"

    def _told(self) -> list[str]:
        """The settings that differ from their defaults, as NAME=VALUE."""
        told = []
        for name, setting in declared(type(self)).items():
            value = getattr(self, name, setting.default)
            if setting.entries is not None and setting.entries.kind is not str:
                told += [f"{name}=[{len(value)} {setting.entries.kind.__name__}]"] * bool(value)
            elif value != setting.default and (value or setting.entries is None):
                told.append(f"{name}={value!r:.60}")
        return told

    def bind(self, model: World) -> None:  # noqa: B027
        """Called once by each model before it uses the behaviour.

        Args:
            model: the model; the behaviour may keep it, and all that it gives.
        """

    def members(self) -> Mapping[str, Kind] | None:
        """What the members of ``state`` are: settings, and those in ``saved``, if it has any."""
        return None if self.saved is None else {**self.setting_kinds(), **self.saved}

    def setting_kinds(self) -> dict[str, Kind]:
        """What ``settings`` are, for ``members``."""
        known = declared(type(self))
        return {name: _Setting(known[name]) for name in self.settings()}

    def state(self) -> dict[str, Any]:
        """All that the behaviour needs to go on from a checkpoint; by default its attributes.

        They are the settings and those in ``saved``, or all of them.

        Numbers, texts, arrays, lists and dictionaries of them, geometries, distributions and
        generators can be saved, and the model itself, its plan and its people.
        """
        if self.saved is None:
            return dict(vars(self))
        return {**self.settings(), **{name: getattr(self, name) for name in self.saved}}

    @making
    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given, in this process or another."""
        for name, value in state.items():
            setattr(self, name, value)


def check_behaviours(what: str, given: Iterable[object], kind: type[Plugin]) -> None:
    """Raise ModelError unless all are behaviours of a kind, with names."""
    for each in given:
        if not isinstance(each, kind):
            text = f"{each!r:.80}"
            raise ModelError(f"{what}: got {text}, expected an object of a {kind.__name__}")
        name = getattr(each, "name", None)
        if not (isinstance(name, str) and name):
            raise ModelError(
                f"{what}: {type(each).__name__} has the name {name!r}, expected a text"
            )


def ships(behaviour: Plugin) -> bool:
    """Whether a behaviour is the package's own."""
    return type(behaviour).__module__.startswith(SHIPPED)


def keeps_its_model(behaviour: Plugin) -> bool:
    """Whether a behaviour takes something from the model by which it is bound.

    Those of presets do, but are made for one model.
    """
    made_for_one = type(behaviour).__module__.startswith(_OF_PRESETS)
    return not made_for_one and type(behaviour).bind is not Plugin.bind
