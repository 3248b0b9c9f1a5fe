"""Lazy names of packages, imported when they are first used, and subpackages of a checkout."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from importlib import import_module

# As in the package itself.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any


def names_of(
    package: str, modules: Mapping[str, str]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """A package's ``__getattr__`` and ``__dir__`` for lazy names (PEP 562).

    Args:
        package: its ``__name__``.
        modules: for each name, the module of the package that defines it.
    """

    def get(name: str) -> Any:
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value = getattr(import_module(f"{package}.{modules[name]}"), name)
        setattr(sys.modules[package], name, value)
        return value

    def names() -> list[str]:
        return sorted({*vars(sys.modules[package]), *modules})

    return get, names


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
