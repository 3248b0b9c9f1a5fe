"""`mesa-mobility preset`: the numbers of a preset, and files of presets."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mesa_mobility.commands.console import AsJson, answer_json, answer_rows, say, some_path
from mesa_mobility.commands.models.making import Numbers, split_settings
from mesa_mobility.errors import ModelError


def preset(
    name: Annotated[
        str, typer.Argument(metavar="NAME|FILE", help="default, paper or a TOML file.")
    ] = "default",
    numbers: Numbers = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            help="TOML file to write, with the preset and the numbers that --set changes. The "
            "preset is named after the file.",
            parser=some_path,
            metavar="FILE",
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """List the numbers of a preset, with the names by which --set takes them."""
    from dataclasses import replace

    from mesa_mobility.crowd.presets.files import write_preset
    from mesa_mobility.crowd.presets.naming import COMMAND_LINE
    from mesa_mobility.crowd.presets.shipped import preset_of
    from mesa_mobility.crowd.presets.sources import Sources

    own, given = split_settings(numbers or [])
    if own:
        raise ModelError(f"--set {own[0]}: expected a number such as headway.time=0.6")
    base = preset_of(name)
    rules = base.with_parameters(given)
    listed = Sources(base, rules, given, COMMAND_LINE, rules.behaviours()).listed(rules)
    if out is not None:
        # What is said of the numbers is not true of others.
        provenance = None if given else base.provenance
        write_preset(replace(rules, name=out.stem, provenance=provenance), out)
        say(f"written to {out}")
    if as_json:
        answer_json(
            {
                "preset": rules.name,
                "sha256": rules.digest,
                "numbers": {
                    each.name: {
                        "value": each.value,
                        "unit": each.unit,
                        "bounds": str(each.bounds),
                        "source": each.source,
                    }
                    for each in listed.values()
                },
            }
        )
        return
    answer_rows(
        ["number", "value", "bounds", "source"],
        [
            [each.name, f"{each.shown} {each.unit}".strip(), str(each.bounds), each.source]
            for each in listed.values()
        ],
    )
