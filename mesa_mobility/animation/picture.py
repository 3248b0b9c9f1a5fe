"""Stills of a run, seen from above."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.formats.output_format import OutputFormat

if TYPE_CHECKING:
    from mesa_mobility.results.excerpts import Excerpt


class Picture(OutputFormat):
    """Still from above, one panel for each time."""

    name = "picture"
    suffixes = (".png", ".pdf", ".svg")
    storeys = True

    def write(self, excerpt: Excerpt, path: Path, *, at: str | None = None) -> None:
        """Draw people as discs with a stroke for the facing; see ``plot_snapshots``.

        Args:
            excerpt: what to draw.
            path: the picture.
            at: seconds of the panels, separated by commas; by default the start of the excerpt.

        Raises:
            ResultsError: times that are no numbers or outside the run, or the file cannot be
                written.
        """
        # Matplotlib takes half a second to load.
        from mesa_mobility.results.plots import plot_snapshots

        try:
            times = [float(each) for each in (at or str(excerpt.selection.start)).split(",")]
        except ValueError:
            raise ResultsError(f"at: got {at!r}, expected numbers separated by commas") from None
        people = excerpt.selection.people
        shown = excerpt.trajectories if people is None else excerpt.trajectories.of_people(people)
        plot_snapshots(shown, excerpt.plan, path, times=times)
