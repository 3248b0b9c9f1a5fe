"""Maps of one of an experiment's runs, where trajectories were kept."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mesa_mobility.experiments.observed import observed
from mesa_mobility.experiments.reporting.basis import model_again
from mesa_mobility.experiments.reporting.labels import labels_of
from mesa_mobility.experiments.storing.rows import TRAJECTORIES
from mesa_mobility.reports.run.service import add_service
from mesa_mobility.reports.words import words_of
from mesa_mobility.results import measure
from mesa_mobility.results.trajectories import read_parquet

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.experiments.store import Store
    from mesa_mobility.reports.html import Page
    from mesa_mobility.results import Trajectories

_MOST_TIMES = 120
"""Times at which densities are measured at most: each takes a tenth of a second for 750 people."""


def add_maps(page: Page, store: Store, frame: pd.DataFrame, figures: Sequence[str]) -> None:
    """Add levels of service, usage and speeds of the middle run of the first point."""
    experiment = store.experiment()
    chosen = _middle_run(frame, figures)
    model = model_again(experiment, frame) if "trajectories" in experiment.keep else None
    tracks = None if model is None or chosen is None else _read(store, chosen)
    if model is None or tracks is None:
        page.section("Level of service", "level-of-service")
        page.text(
            "The runs have not kept their trajectories, from which maps are made. An experiment "
            "keeps them if it asks so."
        )
        return
    plan = getattr(model, "building", None) or model.floor_plan
    every = max(1.0, np.ceil(tracks.duration / _MOST_TIMES))
    add_service(
        page,
        measure(tracks, plan, every=float(every)),
        "These maps are those of a single run at the first point of the design, the one with the "
        f"median of “{words_of(figures[0], labels_of(experiment))}”. Its name in the store is "
        f"{chosen}.",
    )


def _middle_run(frame: pd.DataFrame, figures: Sequence[str]) -> str | None:
    """Name of the run of the first point that has the median of the first figure."""
    own = frame[frame["point"] == frame["point"].iloc[0]]
    if not figures:
        return None
    values = observed(own, figures[0])
    known = np.flatnonzero(np.isfinite(values))
    if not len(known):
        return None
    order = known[np.argsort(values[known], kind="stable")]
    return str(own["run"].iloc[order[(len(order) - 1) // 2]])


def _read(store: Store, run: str) -> Trajectories | None:
    """Trajectories of a run; None where they were not written."""
    name = f"{TRAJECTORIES}/{run}.parquet"
    if not store.folder.exists(name):
        return None
    if store.folder.local:
        return read_parquet(store.folder.path(name))
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "trajectories.parquet"
        path.write_bytes(store.folder.read_bytes(name))
        return read_parquet(path)
