"""`mesa-mobility models` and `mesa-mobility behaviors`: list the installed ones."""

from __future__ import annotations

import inspect
from collections.abc import Mapping

from rich.console import Console
from rich.table import Table

from mesa_mobility.commands.console import say
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins import registry


def models() -> None:
    """List the installed models, plug-ins included."""
    _list(registry.models())


def behaviors() -> None:
    """List the installed behaviours: cost terms, target choices and speed rules, plug-ins too."""
    _list(registry.behaviors())


def _list(plugins: Mapping[str, registry.Plugin]) -> None:
    table = Table(box=None, padding=(0, 2, 0, 0))
    table.add_column("Name", no_wrap=True)
    table.add_column("What it is", overflow="fold")
    table.add_column("From", no_wrap=True)
    broken: list[str] = []
    for plugin in plugins.values():
        try:
            description = (inspect.getdoc(plugin.load()) or "").partition("\n")[0]
        except ModelError as error:
            broken.append(str(error))
        else:
            table.add_row(plugin.name, description, plugin.package)
    Console(highlight=False, markup=False).print(table)
    for message in broken:
        say(f"broken: {message}")
