"""Modules that are run in processes of their own, since what they read may crash compiled code."""

import os
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

FOLDER = Path(__file__).parents[2]
"""Where the package is found."""


def output_of(
    module: str, words: Sequence[str], seconds: float, given: bytes | None = None
) -> tuple[bytes, int]:
    """Output of a module of this package that runs in another process, and its exit status.

    Args:
        module: its name. It should import little, so that it starts at once.
        words: its arguments.
        seconds: for which it may run.
        given: what it reads from its standard input.

    Raises:
        TimeoutError: it takes longer.
    """
    # -P: modules in the working directory are not looked for.
    command = [sys.executable, "-P", "-m", module, *words]
    few = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    folders = [str(FOLDER), *filter(None, [os.environ.get("PYTHONPATH")])]
    process = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL if given is None else subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=os.environ | few | {"PYTHONPATH": os.pathsep.join(folders)},
    )
    try:
        output, _ = process.communicate(given, timeout=seconds)
    except subprocess.TimeoutExpired:
        raise TimeoutError(f"longer than {seconds:g} s") from None
    finally:
        # Also where somebody interrupts.
        with suppress(OSError):
            process.kill()
        process.wait()
    return output, process.returncode
