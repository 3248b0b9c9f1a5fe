import os
from pathlib import Path

import pytest

VARIABLE = "MESA_MOBILITY_CAPTURES"
SHARED = Path(__file__).resolve().parents[2] / "shared"


def _captures(folder: Path) -> Path:
    if not (folder / "manifest.tsv").is_file():
        pytest.skip(
            f"no real recordings: {folder} has no manifest.tsv ({VARIABLE} can name a folder)"
        )
    return folder


@pytest.fixture(scope="session")
def captures_dir() -> Path:
    """Folder of the real recordings that may be shipped from."""
    return _captures(Path(os.environ.get(VARIABLE) or SHARED / "captures"))


@pytest.fixture(scope="session")
def captures_noncommercial_dir() -> Path:
    """Folder of the recordings for research use only."""
    captures = Path(os.environ.get(VARIABLE) or SHARED / "captures")
    return _captures(captures.parent / "captures_noncommercial")
