"""Formats of files as plug-ins: each is found by the end of a file's name, or by its own name.

A package offers a format by an entry point in the group of its kind. The entry names a class that
says which files it is for, and reads or writes them. All formats of a kind are imported when the
first file of that kind is read or written.
"""

from __future__ import annotations

import inspect
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

from mesa_mobility.errors import MobilityError, ModelError
from mesa_mobility.plugins import registry

if TYPE_CHECKING:
    from mesa_mobility.plugins.parameters import Parameter

READ, WRITE = "read", "write"


class Format:
    """What formats of all kinds declare. Its class is made without arguments.

    Attributes:
        name: by which it is chosen, the same as that of its entry point.
        suffixes: ends of the files' names, in lower case with their dots, the usual one first.
    """

    name: ClassVar[str] = ""
    suffixes: ClassVar[tuple[str, ...]] = ()

    def takes(self, path: Path) -> bool:
        """Whether a file is of this format, of those whose suffix other formats have, too.

        Formats that share a suffix each have a method of their own, which looks into the file.

        Args:
            path: the file, or a folder.

        Raises:
            MobilityError: the file cannot be read.
        """
        return True


F = TypeVar("F", bound=Format)


@dataclass(frozen=True)
class Known(Generic[F]):
    """A format, and the entry point that offers it."""

    format: F
    plugin: registry.Plugin

    def __str__(self) -> str:
        return f"{self.plugin.name} ({self.plugin.package})"


@dataclass(frozen=True)
class Formats(Generic[F]):
    """All installed formats of a kind.

    Args:
        group: of their entry points.
        base: their base class. A format does what it has a method of its own for: ``read``,
            ``write``, or both. Keyword-only parameters of these are options.
        error: class of errors that concern a file.
    """

    group: str
    base: type[F]
    error: type[MobilityError]

    def usable(self) -> dict[str, Known[F]]:
        """The formats that can be used, by name."""
        return _load(self)[0]

    def broken(self) -> list[str]:
        """What is wrong with the others, and with suffixes that several formats are for."""
        clashes = (_clash(suffix, self._for_suffix(suffix, does)) for suffix, does in self._all())
        return [*_load(self)[1], *dict.fromkeys(filter(None, clashes))]

    def does(self, known: Known[F], what: str) -> bool:
        """Whether a format has a method of its own for ``READ`` or ``WRITE``."""
        own, inherited = (getattr(kind, what, None) for kind in (type(known.format), self.base))
        return own is not inherited

    def suffixes(self, what: str) -> list[str]:
        """Suffixes of all files that can be read or written."""
        found = (each for each in self.usable().values() if self.does(each, what))
        return list(dict.fromkeys(suffix for each in found for suffix in each.format.suffixes))

    def usual(self, what: str) -> list[str]:
        """The usual suffix of each format."""
        found = (each for each in self.usable().values() if self.does(each, what))
        return list(dict.fromkeys(each.format.suffixes[0] for each in found))

    def named(self, name: str) -> F:
        """The format of a name.

        Raises:
            ModelError: there is none, or it is broken.
        """
        known = self.usable().get(name)
        if known is None:
            # Raises with the list of names, or with what is wrong with it.
            plugin = registry.find(name, self.group)
            known = Known(_made(plugin, self.base), plugin)
        return known.format

    def of(self, path: str | os.PathLike[str], what: str) -> F:
        """The format that reads or writes a file, by the end of the file's name.

        Raises:
            MobilityError: none does, or several do.
        """
        name = Path(path).name.lower()
        if Path(path).is_dir():
            name += ".zip"  # a folder is read as an archive of it
        for attempt in range(2):
            ends = [each for each in self.suffixes(what) if name.endswith(each)]
            if ends or attempt:
                break
            _load.cache_clear()  # what is not found is looked for again
        if not ends:
            known = ", ".join(self.suffixes(what)) or "no suffix: no format is installed"
            said = f"{path}: expected a name that ends in {known}"
            raise self.error("; ".join([said, *(f"broken: {each}" for each in self.broken())]))
        found = self._for_suffix(max(ends, key=len), what)
        if clash := _clash(max(ends, key=len), found):
            raise self.error(f"{path}: {clash}")
        if len(found) > 1 and what == READ:
            names = " or ".join(each.format.name for each in found)
            found = [each for each in found if each.format.takes(Path(path))]
            if len(found) != 1:
                raise self.error(f"{path}: expected a file of one of the formats {names}")
        return found[0].format

    def options(self, chosen: F, what: str) -> dict[str, Parameter]:
        """The options of a format's reader or writer, by name."""
        from mesa_mobility.plugins.parameters import evaluated, parameter_of

        function = getattr(chosen, what)
        names = getattr(inspect.unwrap(function), "__globals__", {})
        return {
            each.name: parameter_of(each.name, evaluated(each.annotation, names), each.default)
            for each in inspect.signature(function).parameters.values()
            if each.kind is each.KEYWORD_ONLY
        }

    def chosen_options(
        self, chosen: F, what: str, given: Mapping[str, Any], settings: Iterable[str] = ()
    ) -> dict[str, Any]:
        """Options for a format's reader or writer.

        Args:
            chosen: the format.
            what: ``READ`` or ``WRITE``.
            given: values by name; those that are None count for nothing.
            settings: texts NAME=VALUE.

        Raises:
            MobilityError: the format does not take an option, or not this value.
        """
        from mesa_mobility.plugins.parameters import unknown, values_of

        taken, name = self.options(chosen, what), f"format {chosen.name}"
        values = {key: value for key, value in given.items() if value is not None}
        for key in values:
            if key not in taken:
                raise self.error(unknown(name, key, taken, "option"))
        return values | values_of(taken, name, settings, "option")

    def _for_suffix(self, suffix: str, what: str) -> list[Known[F]]:
        return [
            each
            for each in self.usable().values()
            if suffix in each.format.suffixes and self.does(each, what)
        ]

    def _all(self) -> Iterable[tuple[str, str]]:
        return ((suffix, what) for what in (READ, WRITE) for suffix in self.suffixes(what))


# Loading looks through what is installed, and imports the formats.
@cache
def _load(formats: Formats[F]) -> tuple[dict[str, Known[F]], list[str]]:
    """The formats of a kind that can be used, and what is wrong with the others."""
    usable: dict[str, Known[F]] = {}
    broken: list[str] = []
    for plugin in registry.installed(formats.group).values():
        try:
            usable[plugin.name] = Known(_made(plugin, formats.base), plugin)
        except ModelError as error:
            broken.append(str(error))
    return usable, broken


def _made(plugin: registry.Plugin, base: type[F]) -> F:
    """The format of an entry point.

    Raises:
        ModelError: the entry point cannot be loaded, or is no format of this kind.
    """
    kind = plugin.load()
    suffixes = getattr(kind, "suffixes", ())
    wrong = ""
    if not issubclass(kind, base):
        wrong = f"is no {base.__name__}"
    elif kind.name != plugin.name:
        wrong = f"calls itself {kind.name!r}, expected the name of its entry point"
    elif not (isinstance(suffixes, tuple) and suffixes and all(map(_is_suffix, suffixes))):
        wrong = f"has suffixes {suffixes!r}, expected a tuple such as ('.txt',), in lower case"
    if wrong:
        raise ModelError(f"{plugin} {wrong}")
    try:
        return kind()
    # A plug-in may fail in any way; the user always needs its name.
    except Exception as error:
        reason = " ".join(str(error).split())
        raise ModelError(f"{plugin} cannot be made: {type(error).__name__}: {reason}") from error


def _is_suffix(text: object) -> bool:
    return isinstance(text, str) and len(text) > 1 and text[0] == "." and text == text.lower()


def _clash(suffix: str, found: list[Known[F]]) -> str:
    """What is wrong where several formats are for a suffix, or nothing."""
    own = [type(each.format).takes is not Format.takes for each in found]
    if len(found) < 2 or all(own):
        return ""
    return f"suffix {suffix} is offered both by {found[0]} and by {found[1]}: remove one of them"
