"""What `mesa-mobility explain` prints of a run, as a block for docs/how-to/results/bodies.md.

mesa-mobility run doorway --seed 1 --record decisions --out FOLDER/doorway
python benchmarks/pages/explained.py FOLDER/doorway --out FOLDER
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

from blocks import give

PERSON, TIME = 50, 4.5
WIDTH = 100
"""Characters of a line."""


def main() -> None:
    """Explain one decision."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", help="folder of a run with its decisions")
    parser.add_argument("--out", type=Path, help="folder for the block")
    given = parser.parse_args()
    words = ["explain", given.run, "--person", str(PERSON), "--time", str(TIME), "--no-progress"]
    command = [sys.executable, "-m", "mesa_mobility", *words]
    environment = {**os.environ, "COLUMNS": str(WIDTH)}
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment)
    lines = "\n".join(line.rstrip() for line in done.stdout.strip().splitlines())
    typed = f"mesa-mobility explain out/doorway --person {PERSON} --time {TIME}"
    give(given.out, "explain", f"```text\n$ {typed}\n{lines}\n```")


if __name__ == "__main__":
    main()
