"""What is installed, plug-ins of other packages included: models, behaviours, formats of files.

A package offers a model, for instance, by an entry point in the group `mesa_mobility.models`; each
is imported when it is first loaded by name.
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.metadata import Distribution, EntryPoint, entry_points
from pathlib import Path

from mesa_mobility.errors import ModelError

MODELS = "mesa_mobility.models"
BEHAVIORS = "mesa_mobility.behaviors"
PLAN_FORMATS = "mesa_mobility.plan_formats"
OUTPUT_FORMATS = "mesa_mobility.output_formats"
_KINDS = {
    MODELS: "model",
    BEHAVIORS: "behavior",
    PLAN_FORMATS: "plan format",
    OUTPUT_FORMATS: "output format",
}


@dataclass(frozen=True)
class Plugin:
    """An installed plug-in.

    Attributes:
        name: by which it is chosen.
        target: `module:attribute` that holds its class.
        package: distribution that brings it, with its version.
        rival: another distribution that offers the same name, or nothing.
    """

    name: str
    target: str
    package: str
    rival: str
    _entry: EntryPoint

    def __str__(self) -> str:
        return f"{_KINDS[self._entry.group]} {self.name} ({self.target}, from {self.package})"

    def load(self) -> type:
        """Import the class.

        Raises:
            ModelError: the plug-in cannot be imported, what it names is not a class, or two
                packages offer its name.
        """
        if self.rival:
            raise ModelError(
                f"{_KINDS[self._entry.group]} {self.name} is offered both by {self.package} and by "
                f"{self.rival}: remove one of them"
            )
        try:
            loaded = self._entry.load()
        # A plug-in may fail in any way; the user always needs its name.
        except Exception as error:
            reason = " ".join(str(error).split())
            said = f"{self} cannot be loaded: {type(error).__name__}: {reason}"
            raise ModelError(said) from error
        if not isinstance(loaded, type):
            raise ModelError(f"{self} is not a class")
        return loaded


def models() -> dict[str, Plugin]:
    """Installed models by name, in alphabetical order; none of them is imported."""
    return installed(MODELS)


def behaviors() -> dict[str, Plugin]:
    """Installed behaviours by name, in alphabetical order; none of them is imported."""
    return installed(BEHAVIORS)


def load_model(name: str) -> type:
    """The class of a model.

    Raises:
        ModelError: no model of that name (the message lists what is installed), or it is broken.
    """
    return find(name, MODELS).load()


def load_behavior(name: str) -> type:
    """The class of a behaviour.

    Raises:
        ModelError: no behaviour of that name (the message lists what is installed), or it is
            broken.
    """
    return find(name, BEHAVIORS).load()


def installed(group: str) -> dict[str, Plugin]:
    """The plug-ins of a group by name, in alphabetical order; none of them is imported."""
    plugins: dict[str, Plugin] = {}
    entries = sorted(entry_points(group=group), key=lambda each: (each.name, each.value))
    # Reading a distribution's name opens a file, and most offer several plug-ins.
    packages: dict[Distribution | None, str] = {}
    for entry in entries:
        dist = entry.dist
        if dist not in packages:
            packages[dist] = f"{dist.name} {dist.version}" if dist else "an unknown package"
        package = packages[dist]
        first = plugins.get(entry.name)
        if first is None:
            plugins[entry.name] = Plugin(entry.name, entry.value, package, rival="", _entry=entry)
        elif first.target != entry.value:
            plugins[entry.name] = replace(first, rival=package)
    return plugins


# Looking for what is installed opens a file of each package. Without a cache, the terms of a preset
# would take a third of the time of a run of 30 people.
@cache
def known(group: str) -> dict[str, Plugin]:
    """The plug-ins of a group by name, as first looked for in this process."""
    return installed(group)


def find(name: str, group: str) -> Plugin:
    """Find a plug-in by name, without importing it.

    Raises:
        ModelError: no plug-in has this name; the message lists the installed ones.
    """
    if name not in known(group):
        known.cache_clear()  # it may have been installed since
    plugins = known(group)
    if name in plugins:
        return plugins[name]
    names = ", ".join(plugins) or "none"
    file = f"{name}.py"
    beside = [file] if group == MODELS and Path(file).is_file() else []
    choices = dict.fromkeys([*plugins, *beside])
    raise ModelError(
        f"unknown {_KINDS[group]} {name!r}{did_you_mean(name, choices)}; installed: {names}"
        + ("; a model of your own is FILE.py or FILE.py:NAME" if group == MODELS else "")
    )


def did_you_mean(name: str, known: Mapping[str, object]) -> str:
    """``, did you mean 'doorway'?`` for the closest of the known names, or nothing."""
    lowered = {each.lower(): each for each in known}
    close = difflib.get_close_matches(name.lower(), lowered, n=1)
    return f", did you mean {lowered[close[0]]!r}?" if close else ""
