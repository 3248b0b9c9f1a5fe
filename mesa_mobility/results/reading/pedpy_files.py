"""Files of tracks that PedPy reads."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.reading.rows import Rows

ARCHIVE = "ped_data_archive_hdf5"
READERS = {
    ".h5": (ARCHIVE,),
    ".hdf5": (ARCHIVE,),
    ".traj": ("vadere",),
    ".pp": ("viswalk",),
    ".json": ("pathfinder_json",),
    ".csv": ("pathfinder_csv", "crowdit", "viswalk"),
    ".gz": ("crowdit",),
}
"""PedPy's readers to try, by the suffix of a file."""


def read_with_pedpy(path: Path) -> Rows:
    """Read a file with the first of PedPy's readers that takes it.

    Raises:
        ResultsError: PedPy is not installed, or no reader takes the file.
    """
    names = READERS[path.suffix.lower()]
    try:
        import pedpy
    except ImportError as error:
        said = f"{path}: PedPy reads such files, but is not installed: pip install pedpy"
        raise ResultsError(said) from error
    refused = ""
    for name in names:
        load = getattr(pedpy, f"load_trajectory_from_{name}", None)
        if load is None:  # this version of PedPy does not have it yet
            refused = refused or f"PedPy {pedpy.__version__} has no reader of {name} files"
            continue
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                found = load(trajectory_file=path)
        # Readers of text raise what pandas, h5py or json do.
        except Exception as error:
            refused = refused or " ".join(str(error).split()) or type(error).__name__
            continue
        data = found.data
        person, frame, x, y = (np.asarray(data[name]) for name in ("id", "frame", "x", "y"))
        # All but the archive's files are in metres by definition.
        unit = None if name == ARCHIVE else "m"
        return Rows(person, frame, x, y, unit=unit, frame_rate=float(found.frame_rate))
    raise ResultsError(f"{path}: PedPy cannot read it: {refused}")
