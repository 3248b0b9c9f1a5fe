"""Tables of presets, their calibration and the shipped map, with numbers taken from the code.

python benchmarks/pages/settings_tables.py [--out FOLDER]

The tables are the files of `TABLES` beside this one. In them {{default.headway}} is a weight,
{{headway.time}} a setting of a term or tactic, {{anticipation.HORIZON}} a constant of the module of
a tactic, `people_ahead` or `places`, {{preset.durations}} a member of the preset `default`, and
{{map.options}} a figure of the map. {{bounds.headway.time}} is where the calibration searches for a
number, {{goals.meeting}} the range of a goal and {{outside.meeting}} how far outside of it counts
as 1, {{tolerances.flow}} a tolerance, {{weights.goals}} the weight of all goals, and
{{published.IN_LINE}} a constant of the scenes with published figures.
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

from benchmarks.default_preset import goals, measured, published
from benchmarks.default_preset.__main__ import BOUNDS, scenarios
from mesa_mobility import MobilityMap
from mesa_mobility.crowd import PRESETS
from mesa_mobility.crowd.conflicts import places
from mesa_mobility.mobility.map_data import CORE_RADIUS

TABLES = {
    "cost-terms": "cost_terms.md",
    "default-numbers": "default_numbers.md",
    "calibration-data": "calibration_data.md",
    "calibration-goals": "calibration_goals.md",
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
    modules = {each.__name__.rpartition(".")[2]: vars(each) for each in (people_ahead, places)}
    return found | modules | {"map": map_figures()} | calibration()


def calibration() -> dict[str, Mapping[str, Any]]:
    """What the calibration of the default preset searches and wants."""
    _, _, distances = scenarios(Path(), None)
    of_goals = sum(distances[name][0].weight for name in goals.GOALS)
    return {
        "bounds": {name: f"{low:g} to {high:g}" for name, (low, high) in BOUNDS.items()},
        "goals": {
            name: f"{low:g}" if low == high else f"{low:g} to {high:g}"
            for name, (low, high, _) in goals.GOALS.items()
        },
        "outside": {name: each for name, (_, _, each) in goals.GOALS.items()},
        "tolerances": {
            name: f"{each:.0%}".replace("%", " %") for name, each in measured.TOLERANCES.items()
        },
        "weights": {"goals": of_goals},
        "published": {"NECKS": list(published.NECKS), "IN_LINE": list(published.IN_LINE)},
    }


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
