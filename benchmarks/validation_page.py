"""Compute the figures and pictures of docs/validation.md again and insert them.

python benchmarks/validation_page.py verify --seeds 10
python benchmarks/validation_page.py validate --seeds 5
python benchmarks/validation_page.py campaign --file campaign.jsonl

The first takes some ten minutes on two cores, the second as long; the third reads what
benchmarks/campaign.py has written.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import campaign

PAGE = Path(__file__).parents[1] / "docs" / "validation.md"
PICTURES = PAGE.parent / "images" / "validation"
WORDS = {"pass": "pass", "fail": "**fail**", "cap": "cap exceeded"}


def main() -> None:
    """Fill in one part of the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", choices=("verify", "validate", "campaign"))
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--file", type=Path, default=Path("campaign.jsonl"))
    given = parser.parse_args()
    if given.part == "campaign":
        text = campaign_table(given.file)
    elif given.part == "verify":
        text = verify_table(answer("verify", given.seeds), given.seeds)
    else:
        PICTURES.mkdir(parents=True, exist_ok=True)
        found = answer("validate", given.seeds, "--out", str(PICTURES))
        (PICTURES / "validation.json").unlink()
        text = validate_table(found, given.seeds)
    put(given.part, text)


def answer(command: str, seeds: int, *more: str) -> dict[str, Any]:
    """The JSON output of a command, whether or not a test fails."""
    line = [sys.executable, "-m", "mesa_mobility", command, "--seeds", str(seeds), "--json", *more]
    done = subprocess.run(line, stdout=subprocess.PIPE, text=True)
    if done.returncode > 1:
        sys.exit(done.returncode)
    return dict(json.loads(done.stdout.splitlines()[-1]))


def verify_table(found: dict[str, Any], seeds: int) -> str:
    """One line a test."""
    lines = [f"{seeds} seeds each; medians.", "", "| test | what | simulated | verdict |",
             "|---|---|---|---|"]  # fmt: skip
    for name, each in found.items():
        figures = ", ".join(
            f"{figure} {value:.4g}"
            for figure, value in each["measured"].items()
            if isinstance(value, int | float) and figure not in each["safety"]
        )
        verdict = WORDS[each["verdict"]]
        if each["failed"]:
            verdict += ": " + "; ".join(each["failed"][:2])
        lines.append(f"| {name} | {each['what']} | {figures} | {verdict} |")
    safety = [each["safety"] for each in found.values()]
    words = [each["verdict"] for each in found.values()]
    passed, failed, capped = (words.count(word) for word in WORDS)
    lines += [
        "",
        f"{passed} pass, {failed} fail, {capped} exceed a design cap only. Overlaps "
        f"{sum(s['overlaps'] for s in safety)}, wall crossings "
        f"{sum(s['wall_crossings'] for s in safety)}.",
    ]
    return "\n".join(lines)


def validate_table(found: dict[str, Any], seeds: int) -> str:
    """One line a figure with its bound, and a picture for each experiment."""
    lines = [f"{seeds} seeds each; medians unless said otherwise."]
    for name, each in found.items():
        lines += ["", f"### {name}: {each['what']}", "", f"Measured: {each['source']}.", ""]
        lines += ["| figure | simulated | wanted | |", "|---|---|---|---|"]
        for figure, wanted in each["criterion"].items():
            value = each["measured"][figure]
            shown = "-" if value is None else f"{value:.4g}"
            word = "**fail**" if figure in each["failed"] else "pass"
            if figure in each["reported"]:
                word = "reported"
            lines.append(f"| {figure} | {shown} | {wanted} | {word} |")
        for figure, value in each["measured"].items():
            if isinstance(value, int | float) and figure not in each["criterion"]:
                lines.append(f"| {figure} | {value:.4g} | | |")
        if (PICTURES / f"{name}.png").exists():
            lines += ["", f"![{each['what']}](images/validation/{name}.png)"]
    return "\n".join(lines)


def campaign_table(file: Path) -> str:
    """The table that benchmarks/campaign.py prints."""
    rows = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
    with contextlib.redirect_stdout(io.StringIO()) as out:
        campaign.report(sorted(rows, key=lambda row: row["seed"]))
    return out.getvalue().strip()


def put(part: str, text: str) -> None:
    """Replace the text between the page's two marks of a part."""
    page = PAGE.read_text(encoding="utf-8")
    begin, end = f"<!-- {part} -->\n", f"<!-- end of {part} -->"
    head, found, rest = page.partition(begin)
    _, closed, tail = rest.partition(end)
    if not (found and closed):
        sys.exit(f"{PAGE}: no marks for {part}")
    PAGE.write_text(f"{head}{begin}\n{text}\n\n{end}{tail}", encoding="utf-8")


if __name__ == "__main__":
    main()
