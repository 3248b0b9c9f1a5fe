"""Report pages as PDF, printed by a browser on this machine."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing

BROWSER = "MESA_MOBILITY_BROWSER"
PROGRAMS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")

_LONGEST_S = 300.0


def browser_program(purpose: str = "write PDF") -> str:
    """Path of Chromium or Chrome: that of the variable ``MESA_MOBILITY_BROWSER``, or an installed
    one.

    Args:
        purpose: what it is needed for, in an error.

    Raises:
        ResultsError: there is none.
    """
    given = os.environ.get(BROWSER)
    found = shutil.which(given) if given else next(filter(None, map(shutil.which, PROGRAMS)), None)
    if found is None:
        raise ResultsError(
            f"no browser to {purpose}: {f'{BROWSER} is {given!r}' if given else 'none installed'}, "
            f"expected Chromium or Chrome (any browser opens the HTML page)"
        )
    return found


def write_pdf(page: str | os.PathLike[str], path: str | os.PathLike[str]) -> None:
    """Print a page of HTML on A4, as its style says, with its headings as bookmarks.

    Args:
        page: file of the page.
        path: PDF to write.

    Raises:
        ResultsError: there is no browser, it fails, or the file cannot be written.
    """
    program = browser_program()
    with (
        tempfile.TemporaryDirectory(prefix="mesa-mobility-print-") as profile,
        replacing(path, ResultsError) as temporary,
    ):
        command = [
            program,
            "--headless",
            "--disable-gpu",
            "--disable-background-networking",
            "--no-first-run",
            f"--user-data-dir={profile}",
            "--no-pdf-header-footer",
            "--generate-pdf-document-outline",
            f"--print-to-pdf={temporary.absolute()}",
            Path(page).absolute().as_uri(),
        ]
        # A browser of the superuser does not start with its sandbox.
        if getattr(os, "geteuid", lambda: 1)() == 0:
            command.insert(1, "--no-sandbox")
        try:
            ended = subprocess.run(command, capture_output=True, timeout=_LONGEST_S, check=False)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise ResultsError(f"{program}: cannot print {page}: {error}") from error
        if ended.returncode or not temporary.is_file():
            raise ResultsError(f"{program}: has not printed {page}, status {ended.returncode}")
