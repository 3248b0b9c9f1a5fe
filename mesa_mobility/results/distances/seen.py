"""A run as a view sees it; what several figures need is measured once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.results.distances import samples, with_pedpy
from mesa_mobility.results.distances.view import View
from mesa_mobility.results.measures.motion import Selection, Steps, steps_between
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Seen:
    """A run as a ``View`` sees it: the part of a run that a comparison measures.

    Attributes:
        tracks: the rows that count.
        view: where and when people count.
    """

    tracks: Tracks
    view: View

    @classmethod
    def of(cls, tracks: Tracks, view: View) -> Seen:
        """A run in a view.

        Raises:
            ResultsError: nobody is in the view.
        """
        return cls(view.of(tracks), view)

    @property
    def selection(self) -> Selection:
        """The area, for measures of motion."""
        return Selection(self.view.area)

    @cached_property
    def passing_times(self) -> FloatArray:
        """(k,) seconds since ``start`` at which people first crossed the line, in rising order.

        The view must have a line.
        """
        return self._passing_times - self.start

    @property
    def start(self) -> float:
        """Seconds of the tracks at which the time of passages begins."""
        if self.view.since_first and len(self._passing_times):
            return float(self._passing_times[0])
        return self.view.after

    @property
    def duration(self) -> float:
        """Seconds from ``start`` to the end."""
        return float(self.tracks.frame[-1] / self.tracks.frame_rate - self.start)

    @cached_property
    def _passing_times(self) -> FloatArray:
        return with_pedpy.passing_times(self.tracks, self.view)

    @cached_property
    def moving(self) -> pd.DataFrame:
        """One row for each second and person in the area, standing people included.

        Columns are ``id``, ``frame``, ``x``, ``y``, ``speed`` and ``density``; see
        ``with_pedpy.speeds_and_densities``. The view must have a direction, an area and a floor.

        Raises:
            ResultsError: PedPy is not installed.
        """
        return with_pedpy.speeds_and_densities(self.tracks, self.view)

    @cached_property
    def profiles(self) -> tuple[FloatArray, FloatArray]:
        """Mean density and speed in each cell of the area; see ``with_pedpy.profiles``."""
        return with_pedpy.profiles(self.moving, self.tracks, self.view)

    @cached_property
    def moments(self) -> list[samples.Moment]:
        """Where people are, once a second; see ``samples.moments``."""
        return samples.moments(self.tracks, self.view)

    @cached_property
    def steps(self) -> Steps:
        """Steps of 1.5 s in the area. The view must have a direction."""
        assert self.view.direction is not None
        return steps_between(self.tracks, self.view.direction, selection=self.selection)
