"""Mesa, imported without pandas and NetworkX, which are imported when Mesa first uses them.

Mesa needs them for tables of collected data and for networks, which most runs never make. The
package takes Mesa from here, so that they are left out wherever Mesa is imported first.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

HARMLESS = {f"mesa-mobility {name}" for name in ("interrupts", "progress", "parent")}
"""Threads of commands and workers, which wait and tell, and import nothing."""


class _Later:
    """A stand-in for a module, which imports the module when Mesa asks for an attribute.

    It is no ``ModuleType``, so those who look through ``sys.modules`` for modules pass it over.
    """

    __spec__ = None
    """The import system asks for it. None stands for a module that is complete."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, attribute: str) -> Any:
        _remove(self._name)
        return getattr(import_module(self._name), attribute)


def _remove(name: str) -> None:
    if isinstance(sys.modules.get(name), _Later):
        sys.modules.pop(name, None)


@contextmanager
def _imported_later(*names: str) -> Iterator[None]:
    """Let modules that the block imports get the named ones only when they use them.

    After the block ``sys.modules`` has none of what stands in for them. In the block other threads
    could find it there, so if any runs that may import modules, they are imported as usual.
    """
    if not _others():
        for name in names:
            sys.modules.setdefault(name, _Later(name))  # type: ignore[arg-type]
    try:
        yield
    finally:
        for name in names:
            _remove(name)


def _others() -> bool:
    """Whether other threads run that may import modules."""
    own = threading.current_thread()
    return any(each is not own and each.name not in HARMLESS for each in threading.enumerate())


with _imported_later("pandas", "networkx"):
    import mesa as mesa
    from mesa.datacollection import DataCollector as DataCollector
    from mesa.experimental.continuous_space import ContinuousSpace as ContinuousSpace
    from mesa.experimental.continuous_space import ContinuousSpaceAgent as ContinuousSpaceAgent
