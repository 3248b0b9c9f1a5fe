"""The figures and pictures of docs/validation.md.

python benchmarks/pages/validation_page.py verify --seeds 10 --out FOLDER
python benchmarks/pages/validation_page.py validate --seeds 5 --out FOLDER

Either takes some ten minutes on two cores. `python -m docs.figures` puts what they write into the
pages.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from blocks import give, table

WORDS = {"pass": "pass", "fail": "**fail**", "cap": "cap exceeded"}


def main() -> None:
    """Run one of the commands and write its blocks."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", choices=("verify", "validate"))
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--out", type=Path, help="folder for blocks and pictures")
    given = parser.parse_args()
    if given.part == "verify":
        found = answer("verify", given.seeds)
        give(given.out, "verify", verify_table(found, given.seeds))
        give(given.out, "verdicts", verdicts(found))
        return
    more = [] if given.out is None else ["--out", str(given.out)]
    found = answer("validate", given.seeds, *more)
    give(given.out, "validate", validate_table(found, given.seeds))
    give(given.out, "outside", outside(found))


def answer(command: str, seeds: int, *more: str) -> dict[str, Any]:
    """The JSON output of a command, whether or not a test fails."""
    line = [sys.executable, "-m", "mesa_mobility", command, "--seeds", str(seeds), "--json", *more]
    done = subprocess.run(line, stdout=subprocess.PIPE, text=True)
    if done.returncode > 1:
        sys.exit(done.returncode)
    return dict(json.loads(done.stdout.splitlines()[-1]))


def verify_table(found: dict[str, Any], seeds: int) -> str:
    """One line a test."""
    rows = []
    for name, each in found.items():
        figures = ", ".join(
            f"{figure} {value:.4g}"
            for figure, value in each["measured"].items()
            if isinstance(value, int | float) and figure not in each["safety"]
        )
        verdict = WORDS[each["verdict"]]
        if each["failed"]:
            verdict += ": " + "; ".join(each["failed"][:2])
        rows.append((name, each["what"], figures, verdict))
    safety = [each["safety"] for each in found.values()]
    overlaps, crossings = (
        sum(each[name] for each in safety) for name in ("overlaps", "wall_crossings")
    )
    return (
        f"{seeds} seeds each; medians.\n\n"
        + table(("test", "what", "simulated", "verdict"), rows)
        + f"\n\nOverlaps {overlaps}, wall crossings {crossings}."
    )


def verdicts(found: dict[str, Any]) -> str:
    """How many tests pass, and those that do not."""
    passed = sum(each["verdict"] == "pass" for each in found.values())
    rows = [("pass", f"{passed} of {len(found)}")]
    for word in ("cap", "fail"):
        rows += [
            (WORDS[word], f"{name}: {each['what']}")
            for name, each in found.items()
            if each["verdict"] == word
        ]
    return table(("verdict", "tests"), rows)


def validate_table(found: dict[str, Any], seeds: int) -> str:
    """One line a figure with its bound, and a picture for each experiment."""
    parts = [f"{seeds} seeds each; medians unless said otherwise."]
    for name, each in found.items():
        rows = [
            (figure, _number(each["measured"][figure]), wanted, _verdict(each, figure))
            for figure, wanted in each["criterion"].items()
        ]
        rows += [
            (figure, _number(value), "", "")
            for figure, value in each["measured"].items()
            if isinstance(value, int | float) and figure not in each["criterion"]
        ]
        parts += [
            f"### {name}: {each['what']}",
            f"Measured: {each['source']}.",
            table(("figure", "simulated", "wanted", ""), rows),
            f"![{each['what']}](images/validation/{name}.png)",
        ]
    return "\n\n".join(parts)


def outside(found: dict[str, Any]) -> str:
    """The experiments, with their figures outside of the range."""
    rows = []
    for name, each in found.items():
        judged = [figure for figure in each["criterion"] if figure not in each["reported"]]
        rows.append((f"`{name}`", len(judged), "; ".join(each["failed"]) or "none"))
    return table(("experiment", "figures judged", "figures outside"), rows)


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _verdict(each: dict[str, Any], figure: str) -> str:
    if figure in each["reported"]:
        return "reported"
    return "**fail**" if figure in each["failed"] else "pass"


if __name__ == "__main__":
    main()
