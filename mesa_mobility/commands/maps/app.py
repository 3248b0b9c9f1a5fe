"""`mesa-mobility map`: build, describe and judge mobility maps."""

from __future__ import annotations

import typer

from mesa_mobility.commands.maps.bootstrap import bootstrap
from mesa_mobility.commands.maps.build import build
from mesa_mobility.commands.maps.judging import coverage, info
from mesa_mobility.commands.maps.poses import poses

app = typer.Typer(help="Build, describe and judge mobility maps.", no_args_is_help=True)
app.command()(build)
app.command()(info)
app.command()(coverage)
app.command()(poses)
app.command()(bootstrap)
