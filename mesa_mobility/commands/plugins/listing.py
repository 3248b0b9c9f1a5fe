"""`mesa-mobility models`, `behaviors` and `formats`: list what is installed."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.table import Table

from mesa_mobility.commands.console import say
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins import registry
from mesa_mobility.plugins.formats import READ, WRITE, Formats


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
    table = _table("Setting", "Default", "Takes", "What it is")
    weight = getattr(kind, "default_weight", None)
    if weight is not None:
        table.add_row("weight", f"{weight:g}", "any number", "factor in the sum of costs")
    for row in settings_text(kind):
        table.add_row(*row)
    _print(_first_line(kind) or name, table)


def formats(
    name: Annotated[
        str | None, typer.Argument(metavar="[NAME]", help="One of them, for its options.")
    ] = None,
) -> None:
    """List the formats of floor plans and of saved runs, plug-ins included, or options of one."""
    from mesa_mobility.floorplan.formats.plan_format import PLANS
    from mesa_mobility.results.formats.output_format import OUTPUTS

    kinds: dict[str, Formats[Any]] = {"Floor plans": PLANS, "Saved runs": OUTPUTS}
    if name is not None:
        _list_options(name, kinds.values())
        return
    out = Console(highlight=False, markup=False)
    for heading, kind in kinds.items():
        out.print(heading, style="bold")
        table = _table("Name", "Does", "Files", "What it is", "From")
        for each in kind.usable().values():
            does = "/".join(what for what in (READ, WRITE) if kind.does(each, what))
            files, said = " ".join(each.format.suffixes), _first_line(type(each.format))
            table.add_row(each.plugin.name, does, files, said, each.plugin.package)
        out.print(table)
    for kind in kinds.values():
        for message in kind.broken():
            say(f"broken: {message}")


def _list_options(name: str, kinds: Iterable[Formats[Any]]) -> None:
    known = {each: kind for kind in kinds for each in registry.installed(kind.group)}
    if name not in known:
        guess = registry.did_you_mean(name, known)
        raise ModelError(f"unknown format {name!r}{guess}; installed: {', '.join(known)}")
    chosen = known[name].named(name)
    table = _table("Option", "Default", "Takes")
    for what in (READ, WRITE):
        if hasattr(chosen, what):
            for option in known[name].options(chosen, what).values():
                table.add_row(option.name, f"{option.default!r}", option.takes)
    _print(_first_line(type(chosen)), table)


def _table(*titles: str) -> Table:
    """A table whose column of texts takes several lines."""
    table = Table(box=None, padding=(0, 2, 0, 0))
    for title in titles:
        texts = title == "What it is"
        table.add_column(title, no_wrap=not texts, overflow="fold" if texts else "ellipsis")
    return table


def _print(heading: str, table: Table) -> None:
    out = Console(highlight=False, markup=False)
    out.print(heading)
    if table.row_count:
        out.print(table)


def _first_line(kind: type) -> str:
    return (inspect.getdoc(kind) or "").partition("\n")[0]


def _list(plugins: Mapping[str, registry.Plugin]) -> None:
    table = _table("Name", "What it is", "From")
    broken: list[str] = []
    for plugin in plugins.values():
        try:
            description = _first_line(plugin.load())
        except ModelError as error:
            broken.append(str(error))
        else:
            table.add_row(plugin.name, description, plugin.package)
    Console(highlight=False, markup=False).print(table)
    for message in broken:
        say(f"broken: {message}")
