"""Lazy names of packages, imported when they are first used, and subpackages of a checkout."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable, Mapping
from importlib import import_module

# As in the package itself.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any


def names_of(package: str, file: str) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """A package's ``__getattr__`` and ``__dir__`` for lazy names (PEP 562).

    The names stand once in the package's file, where type checkers find them: below
    ``if TYPE_CHECKING:``, each as ``from module import name as name``.

    Args:
        package: its ``__name__``.
        file: its ``__file__``.
    """
    modules: dict[str, str] = {}

    def known() -> dict[str, str]:
        if not modules:
            with open(file, encoding="utf-8") as lines:
                module = ""
                for line in lines:
                    words = line.split()
                    if line[:9] == "    from ":
                        module, words = words[1], words[3:]  # what is too long is in brackets
                    if module and words[1:2] == ["as"]:
                        modules[words[0]] = module
        return modules

    def get(name: str) -> Any:
        if name == "__all__":
            return list(known())
        if name not in known():
            raise _unknown(package, name, modules, sys._getframe(1))
        collects = gc.isenabled()
        gc.disable()  # what is imported stays, and scanning it takes a fourteenth of an import
        try:
            value = getattr(import_module(modules[name]), name)
        finally:
            if collects:
                gc.enable()
        setattr(sys.modules[package], name, value)
        return value

    def names() -> list[str]:
        return sorted({*vars(sys.modules[package]), *known()})

    return get, names


def _unknown(package: str, name: str, known: Mapping[str, str], caller: Any) -> Exception:
    """The error of a name that a package does not have, with the nearest one that it has."""
    said = f"module {package!r} has no attribute {name!r}"
    if name.startswith("__"):  # which programs try and nobody types
        return AttributeError(said)
    from difflib import get_close_matches
    from dis import opname

    close = get_close_matches(name, known, n=1)
    if not close:
        return AttributeError(said)
    said += f", did you mean {close[0]!r}?"
    # Python turns an AttributeError of ``from package import name`` into words of its own.
    if opname[caller.f_code.co_code[caller.f_lasti]] == "IMPORT_FROM":
        return ImportError(said)
    return AttributeError(said, name=name)  # with a name, tracebacks do not say it once more


def beside_in_a_checkout(package: str, subpackage: str) -> list[str]:
    """Further search path of a package: its parent folder, if a subpackage lies there.

    An installed package contains all of its subpackages. In a checkout some lie beside it, and if
    that is the current folder, Python finds it before an installed one.

    Args:
        package: folder of the package.
        subpackage: name of the subpackage.
    """
    parent = os.path.dirname(package)
    beside = os.path.isfile(os.path.join(parent, subpackage, "__init__.py"))
    return [parent] if beside and not os.path.isdir(os.path.join(package, subpackage)) else []
