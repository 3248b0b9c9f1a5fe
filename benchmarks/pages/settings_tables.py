"""Tables of what the presets and the shipped map are, with numbers taken from the code.

python benchmarks/pages/settings_tables.py [--out FOLDER]

The tables are cost_terms.md, default_numbers.md and shipped_map.md beside this file. In them
{{default.headway}} is a weight, {{headway.time}} a setting of a term or tactic,
{{anticipation.HORIZON}} a constant of the module of a tactic, or of `people_ahead`,
{{preset.durations}} a member of the preset `default`, and {{map.options}} a figure of the map.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from blocks import give
from mesa_mobility.behaviors.steering import people_ahead

from mesa_mobility import MobilityMap
from mesa_mobility.crowd import PRESETS
from mesa_mobility.mobility.map_data import CORE_RADIUS

TABLES = {
    "cost-terms": "cost_terms.md",
    "default-numbers": "default_numbers.md",
    "shipped-map": "shipped_map.md",
}


def names() -> dict[str, Mapping[str, Any]]:
    """What a table may name, by the part before the dot."""
    preset = PRESETS["default"]
    found: dict[str, Mapping[str, Any]] = {name: p.terms for name, p in PRESETS.items()}
    found["preset"] = preset.numbers()
    for tactic in preset.make_tactics():
        found[tactic.name] = vars(sys.modules[type(tactic).__module__]) | tactic.settings()
    for term in preset.make_terms():
        found[term.name] = term.settings()
    return found | {"people_ahead": vars(people_ahead), "map": map_figures()}


def map_figures() -> dict[str, Any]:
    """Figures of the shipped map."""
    info = MobilityMap.load(None).info()
    build = info["build"]
    return {
        "people": len({clip["subject"] for clip in info["provenance"]}),
        "poses": build["poses"],
        "clusters": info["clusters"],
        "options": info["options"],
        "edited": f"{build['edits']['options'] / info['options']:.0%}".replace("%", " %"),
        "core": info["body"].get("core_radius_m", CORE_RADIUS),
    }


def shown(value: Any) -> str:
    """A number as a page shows it."""
    if isinstance(value, list):
        nested = any(isinstance(each, list) for each in value)
        return ("; " if nested else ", ").join(shown(each) for each in value)
    if isinstance(value, str):
        return value
    return f"{value:,}" if isinstance(value, int) else f"{value:g}"


def filled(text: str) -> str:
    """A table with its numbers; a term that a preset lacks has a dash."""
    known = names()

    def number(found: re.Match[str]) -> str:
        subject, _, member = found[1].partition(".")
        if subject in PRESETS:
            return shown(known[subject].get(member, "-"))
        return shown(known[subject][member])

    return re.sub(r"\{\{([\w.]+)\}\}", number, text)


def main() -> None:
    """Fill in all tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, help="folder for the blocks")
    given = parser.parse_args()
    for block, file in TABLES.items():
        text = (Path(__file__).parent / file).read_text(encoding="utf-8")
        give(given.out, block, filled(text).strip())


if __name__ == "__main__":
    main()
