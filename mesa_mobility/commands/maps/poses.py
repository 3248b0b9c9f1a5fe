"""`mesa-mobility map poses`: the full-body poses behind a map's options."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mesa_mobility.commands.console import NoProgress, say, some_path, stoppable_progress
from mesa_mobility.commands.maps.judging import load_recordings
from mesa_mobility.interrupts import putting_in_place


def poses(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Map file.")],
    source: Annotated[
        Path,
        typer.Argument(
            metavar="MANIFEST_OR_DIR", help="The recordings that the map was built from."
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            help="File to write, by default beside the map (.poses.npz).",
            parser=some_path,
            metavar="PATH",
        ),
    ] = None,
    no_progress: NoProgress = False,
) -> None:
    """Write the recorded poses that a map's options use."""
    from mesa_mobility.bodies import build_bank
    from mesa_mobility.bodies.bankfile import poses_path
    from mesa_mobility.mobility import MobilityMap
    from mesa_mobility.results import check_writable

    output = output or poses_path(file)
    check_writable(output.parent)
    mobility_map = MobilityMap.load(file)
    with stoppable_progress(shown=not no_progress) as report:
        recordings = load_recordings(source, report, mobility_map)
        bank = build_bank(mobility_map, recordings, report)
    with putting_in_place():
        bank.save(output)
    say(f"{len(bank.rotations)} poses of {bank.n_options} options written to {output}")
