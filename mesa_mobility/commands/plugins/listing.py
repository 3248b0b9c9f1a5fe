"""`mesa-mobility models` and `mesa-mobility behaviors`: list the installed ones."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from mesa_mobility.commands.console import say
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins import registry


def models() -> None:
    """List the installed models, plug-ins included."""
    _list(registry.models())


def behaviors(
    name: Annotated[
        str | None, typer.Argument(metavar="[NAME]", help="One of them, for its settings.")
    ] = None,
) -> None:
    """List the installed behaviours, plug-ins included, or the settings of one."""
    if name is None:
        _list(registry.behaviors())
        return
    from mesa_mobility.plugins.settings import settings_text

    kind = registry.load_behavior(name)
    out = Console(highlight=False, markup=False)
    out.print((inspect.getdoc(kind) or name).partition("\n")[0])
    table = Table(box=None, padding=(0, 2, 0, 0))
    for title in ("Setting", "Default", "Takes"):
        table.add_column(title, no_wrap=True)
    table.add_column("What it is", overflow="fold")
    weight = getattr(kind, "default_weight", None)
    if weight is not None:
        table.add_row("weight", f"{weight:g}", "any number", "factor in the sum of costs")
    for row in settings_text(kind):
        table.add_row(*row)
    if table.row_count:
        out.print(table)


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
