"""Tracks: everybody's position frame by frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.columns import (
    COLUMNS,
    checked_columns,
    checked_person_data,
    last_frame_of,
    radii_of,
    remaining_of,
)

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.results.decisions import Decisions
    from mesa_mobility.results.reading.rows import Reading

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Tracks:
    """What trajectories hold; see `Trajectories`."""

    frame: IntArray
    person: IntArray
    x: FloatArray
    y: FloatArray
    heading: FloatArray
    frame_rate: float = 30.0
    core_radius: FloatArray | float = 0.15
    last_frame: int | None = None
    inside_at_end: IntArray | None = None
    person_data: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    fields: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    decisions: Decisions | None = None
    reading: Reading | None = None

    def __post_init__(self) -> None:
        columns = checked_columns({name: getattr(self, name) for name in COLUMNS}, self.fields)
        own = {name: columns[name] for name in self.fields}
        object.__setattr__(self, "fields", own)
        for name in COLUMNS:
            object.__setattr__(self, name, columns[name])
        if not (np.isfinite(self.frame_rate) and self.frame_rate > 0):
            raise ResultsError(
                f"trajectories: frame_rate is {self.frame_rate}, expected a positive number"
            )
        object.__setattr__(self, "core_radius", radii_of(self.core_radius, columns["person"]))
        object.__setattr__(
            self, "person_data", checked_person_data(self.person_data, columns["person"], own)
        )
        last = last_frame_of(self.last_frame, columns["frame"])
        object.__setattr__(self, "last_frame", last)
        present = self.person[self.frame == last]
        object.__setattr__(self, "inside_at_end", remaining_of(self.inside_at_end, present, last))

    @property
    def z(self) -> FloatArray:
        """(n,) float64, metres: elevation; 0 where the people walked on a floor plan."""
        return self.fields.get("z", np.zeros(len(self)))

    @property
    def level(self) -> NDArray[np.int16]:
        """(n,) int16: number of the level; `ON_STAIRS` of ``mesa_mobility.buildings`` for places on
        flights and landings, 0 where the people walked on a floor plan."""
        return self.fields.get("level", np.zeros(len(self), dtype=np.int16))

    def on(self, *, level: int) -> Self:
        """The rows of people on one level alone, in the same frames.

        A person's last row on the level is the last before they take the stairs or leave. People on
        flights and landings are on no level.

        Args:
            level: its number.
        """
        return self.only(self.level == level)

    def only(self, rows: NDArray[np.bool_]) -> Self:
        """The rows of a mask (n,) alone, in the same frames, without decisions."""
        now = self.person[rows & (self.frame == self.last_frame)]
        return replace(
            self,
            **{name: getattr(self, name)[rows] for name in COLUMNS},
            fields={name: values[rows] for name, values in self.fields.items()},
            inside_at_end=np.intersect1d(self.remaining, now),
            decisions=None,
        )

    def __len__(self) -> int:
        return len(self.frame)

    @cached_property
    def people(self) -> int:
        """How many different people appear."""
        return len(np.unique(self.person))

    @property
    def frames(self) -> int:
        """How many frames were simulated, the first included."""
        return self._last_frame + 1

    @property
    def duration(self) -> float:
        """Simulated time from the first to the last frame, seconds."""
        return self._last_frame / self.frame_rate

    @cached_property
    def frame_offsets(self) -> NDArray[np.int64]:
        """(frames + 1,) int64: frame f has the rows ``frame_offsets[f]:frame_offsets[f + 1]``."""
        return np.searchsorted(self.frame, np.arange(self.frames + 1)).astype(np.int64)

    @cached_property
    def by_person(self) -> NDArray[np.int64]:
        """(n,) int64: the rows ordered by (person, frame)."""
        return np.argsort(self.person, kind="stable").astype(np.int64)

    @property
    def radii(self) -> FloatArray:
        """(m,) float64, metres: core radius by person, always an array."""
        assert isinstance(self.core_radius, np.ndarray)
        return self.core_radius

    @property
    def remaining(self) -> IntArray:
        """(k,) int32: the people still inside in the last frame, always an array."""
        assert self.inside_at_end is not None
        return self.inside_at_end

    @cached_property
    def exit_frames(self) -> NDArray[np.int64]:
        """(m,) int64: frame in which person p was found outside; -1 if inside at the end."""
        frames = np.full(int(self.person.max(initial=-1)) + 1, -1, dtype=np.int64)
        # Rows come in order of frames: each person's last row is the one that stays.
        frames[self.person] = self.frame
        frames[self.remaining] = -1
        return frames

    def inside(self) -> NDArray[np.int64]:
        """(frames,) int64: how many people were inside in each frame."""
        left = self.exit_frames[self.exit_frames >= 0]
        rows = np.diff(self.frame_offsets)
        return rows - np.bincount(left, minlength=self.frames)

    @property
    def _last_frame(self) -> int:
        assert self.last_frame is not None
        return self.last_frame

    def steps(self, frames: int = 1) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Pairs of rows of one person exactly `frames` frames apart, by person, then frame.

        Returns:
            (k,) rows, and the (k,) rows of the same people `frames` frames later.
        """
        start, end = self.by_person[:-frames], self.by_person[frames:]
        same = (self.person[start] == self.person[end]) & (
            self.frame[end] - self.frame[start] == frames
        )
        return start[same], end[same]

    def rows_of(self, person: int) -> NDArray[np.int64]:
        """(k,) rows of one person, in the order of time; none if they do not appear."""
        ordered = self.person[self.by_person]
        first, last = np.searchsorted(ordered, [person, person + 1])
        return self.by_person[first:last]

    def of_people(self, people: ArrayLike) -> Self:
        """The rows of some people alone, in the same frames.

        Args:
            people: their numbers, or for each person whether they are one of them.
        """
        chosen = np.asarray(people)
        kept = np.zeros(len(self.radii), dtype=np.bool_)
        kept[: len(chosen)] = chosen if chosen.dtype == np.bool_ else False
        if chosen.dtype != np.bool_:
            kept[chosen.astype(np.int64)] = True
        rows = kept[self.person]
        return replace(
            self,
            **{name: getattr(self, name)[rows] for name in COLUMNS},
            fields={name: values[rows] for name, values in self.fields.items()},
            inside_at_end=self.remaining[kept[self.remaining]],
        )

    def to_pandas(self) -> pd.DataFrame:
        """A row for each person and frame: frame, person, x and y (m), heading (rad), fields and
        person_data.

        Texts, such as the type, are categories.
        """
        import pandas as pd

        columns: dict[str, Any] = {name: getattr(self, name) for name in COLUMNS}
        columns |= self.fields
        for name, values in self.person_data.items():
            if values.dtype.kind == "U":
                texts, codes = np.unique(values, return_inverse=True)
                columns[name] = pd.Categorical.from_codes(
                    codes[self.person], categories=pd.Index(texts.tolist())
                )
            else:
                columns[name] = values[self.person]
        return pd.DataFrame(columns)
