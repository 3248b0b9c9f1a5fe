"""Trajectories: everybody's position frame by frame, the input of all measures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.columns import COLUMNS
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import os

    import pedpy

    from mesa_mobility.bodies import BodyMotion, PoseBank
    from mesa_mobility.buildings import Building


@dataclass(frozen=True, eq=False)
class Trajectories(Tracks):
    """One row for each person in each frame that the person spent inside.

    A person who leaves has one more row, in the first frame beyond the exit, so that
    the step across the exit is part of the track. Rows are sorted by (frame, person); unsorted
    input is sorted. The arrays are read-only.

    Attributes:
        frame: (n,) int32, frame number, 0 at the start of the run.
        person: (n,) int32, number of the person, 0 or more, the same in all of their frames.
        x: (n,) float64, metres.
        y: (n,) float64, metres, growing upwards in the plan.
        heading: (n,) float64, radians, facing direction, 0 = +x, counter-clockwise.
        frame_rate: frames a second.
        core_radius: (m,) float64, metres: ``core_radius[p]`` is the radius of the hard body core of
            person p. m is greater than each person's number. A single number applies to everybody.
        last_frame: last frame that was simulated. It is later than the frame of the last row if the
            floor was empty before the end. None means the frame of the last row.
        inside_at_end: (k,) int32, the people still inside in the last frame; None means
            everybody who has a row in it.
        person_data: further data of people, texts or numbers, by name. ``person_data[name]`` is
            (m,); its entry p belongs to person p. A model gives ``type`` and ``group``. The group
            is an empty text for people without one.
        fields: (n,) values of each field that the model declares for its people, by name.
            Trajectories from a building also have the fields ``z`` and ``level`` (see
            ``Building.true_places``). ``z`` of people in a lift is that of the floor of the car.
            Their ``level`` is that on which they got in, until the doors are open at another.
        decisions: the movement option that each person took in each decision; None if not
            recorded. The animation shows bodies in the recorded poses of these options.
        reading: how the source file was read, and what is wrong with it; None if these
            trajectories come from no file.

    Raises:
        ResultsError: columns of unequal length, values that are not finite, a person twice in
            one frame, a negative frame or person, a radius that is missing or not positive,
            a person inside at the end without a row in the last frame; a frame rate that is not
            positive, a last frame before the last row; person data with too few entries, with a
            name that is taken or no identifier, or that are neither texts nor numbers.
    """

    @classmethod
    def of(cls, model: Any) -> Self:
        """The trajectories that a model has recorded so far.

        Args:
            model: anything with ``recorder.arrays()`` (a dict of frame, person, x, y, heading,
                and of fields, if any), ``frame_rate`` (1/s), ``core_radii`` ((people,) metres),
                ``elapsed`` (s) and ``rows`` (the people inside now). It may also have
                ``person_data()`` and, for several levels, a ``building`` with ``true_places`` and
                ``lifts`` with a ``log`` of rides. If it has recorded ``decisions``, the
                trajectories have them, too.

        Raises:
            ResultsError: the model was not recording, or has taken no step.
        """
        recorder = getattr(model, "recorder", None)
        if recorder is None:
            raise ResultsError("the model has recorded nothing: create it with record=True")
        arrays = recorder.arrays()
        rows = {name: arrays.pop(name) for name in COLUMNS}
        if len(model.rows) and not len(rows["frame"]):
            raise ResultsError("the model has recorded nothing: expected a step before")
        if getattr(model, "building", None) is not None:
            points = np.column_stack([rows["x"], rows["y"]])
            places, levels = model.building.true_places(points)
            if hasattr(model, "lifts"):
                places[:, 2] += model.lifts.log.risen(rows["frame"], points)
            rows["x"], rows["y"], arrays["z"] = places.T
            arrays["level"] = levels
        decisions = None
        if getattr(model, "decisions", None):
            from mesa_mobility.results.decisions import Decisions

            decisions = Decisions.of(model)
        return cls(
            **rows,
            frame_rate=float(model.frame_rate),
            core_radius=np.asarray(model.core_radii, dtype=np.float64),
            last_frame=round(model.elapsed * model.frame_rate),
            inside_at_end=model.rows,
            person_data=model.person_data() if hasattr(model, "person_data") else {},
            fields=arrays,
            decisions=decisions,
        )

    @classmethod
    def read(
        cls,
        path: str | os.PathLike[str],
        unit: str | None = None,
        frame_rate: float | None = None,
    ) -> Self:
        """Tracks from a file, measured or simulated.

        Reads text of the Juelich data archive (``.txt``), JuPedSim's databases (``.sqlite``), our
        own Parquet, formats of plug-ins, and through PedPy the archive's HDF5 (``.h5``) and files
        of Vadere, Viswalk, Pathfinder and crowd:it. Headings are the direction of travel over the
        last 0.8 s if the file has none; see ``mesa_mobility.bodies.velocities``.

        Warnings of one line say that unit or frame rate were guessed, which rows cannot be read or
        repeat a frame (they are left out), and where people are missing or jump (rows stay).
        ``reading`` keeps all of it.

        Args:
            path: the file.
            unit: of the coordinates: ``"m"``, ``"cm"`` or ``"mm"``. By default the unit that the
                file names, otherwise the one in which spacing and speeds are most like people's.
            frame_rate: frames a second, if the file does not say so. By default it is guessed from
                the gait of people who walk: the usual rate, such as 16 or 25, that fits their
                steps best.

        Raises:
            ResultsError: no such file, of no known format, or damaged; no frame rate or unit, and
                too little in the tracks to guess it; a unit or frame rate other than the file's; a
                unit in which people would be faster than any sprint or their heads less than 0.1 m
                apart.
        """
        from mesa_mobility.results.read import read_columns

        return cls(**read_columns(path, unit, frame_rate))

    def poses(
        self,
        person: int,
        frames: ArrayLike | None = None,
        *,
        bank: PoseBank | None = None,
        building: Building | None = None,
    ) -> BodyMotion:
        """The body of one person: see :func:`mesa_mobility.results.bodies.body_of`."""
        from mesa_mobility.results.bodies import body_of

        return body_of(self, person, frames, bank=bank, building=building)

    def to_parquet(self, path: str | os.PathLike[str]) -> None:
        """Write a Parquet file: see :func:`mesa_mobility.results.write_parquet`."""
        from mesa_mobility.results.formats.parquet import write_parquet

        write_parquet(self, path)

    def to_pedpy(self) -> pedpy.TrajectoryData:
        """As PedPy's trajectory data: see :func:`mesa_mobility.results.to_pedpy`."""
        from mesa_mobility.results.formats.export import to_pedpy

        return to_pedpy(self)


def read_parquet(path: str | os.PathLike[str]) -> Trajectories:
    """Read a file that ``Trajectories.to_parquet`` wrote.

    Raises:
        ResultsError: no such file, not a Parquet file, any byte of it changed, columns or
            metadata missing, or rows that are not trajectories.
    """
    from mesa_mobility.results.formats.parquet import read_columns

    fields = read_columns(path)
    try:
        return Trajectories(**fields)
    except ResultsError as error:
        raise ResultsError(f"{path}: {error}") from error
