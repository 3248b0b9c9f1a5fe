"""The people of a run that are shown, and when."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mesa_mobility.animation.aids import aid_of
from mesa_mobility.bodies import BodyMotion, PoseBank
from mesa_mobility.bodies.seated import seated_motion
from mesa_mobility.errors import ResultsError
from mesa_mobility.results import Trajectories
from mesa_mobility.results.bodies import track_of


@dataclass(frozen=True)
class Selection:
    """Whom to show of a run, and when.

    Attributes:
        people: numbers of people; everybody if None.
        start: seconds from which on.
        end: seconds until when; the end of the run if None.
    """

    people: tuple[int, ...] | None = None
    start: float = 0.0
    end: float | None = None

    def frames_of(self, trajectories: Trajectories) -> tuple[int, int]:
        """First and last frame shown.

        Raises:
            ResultsError: times outside the run, or in the wrong order.
        """
        end = trajectories.duration if self.end is None else self.end
        if not 0.0 <= self.start < end <= trajectories.duration + 1e-9:
            raise ResultsError(
                f"from {self.start:g} to {end:g} s: expected rising times within the run's "
                f"{trajectories.duration:g} s"
            )
        return round(self.start * trajectories.frame_rate), round(end * trajectories.frame_rate)

    def people_of(self, trajectories: Trajectories) -> list[int]:
        """Numbers of those shown who are there at that time.

        Raises:
            ResultsError: a number that the run does not have, or nobody is there.
        """
        if self.people is not None:
            known = np.unique(trajectories.person)
            absent = np.setdiff1d(self.people, known)
            if len(absent):
                raise ResultsError(f"person {absent[0]}: not among the run's {len(known)} people")
        first, last = self.frames_of(trajectories)
        there = (trajectories.frame >= first) & (trajectories.frame <= last)
        present = np.flatnonzero(np.bincount(trajectories.person[there]))
        shown = present if self.people is None else np.intersect1d(present, self.people)
        if not len(shown):
            raise ResultsError(f"nobody is there from frame {first} to {last}")
        return [int(each) for each in shown]


@dataclass(frozen=True)
class Walker:
    """One person and its body in those frames that are shown.

    Attributes:
        person: its number.
        first: first frame of ``motion``.
        motion: its body in successive frames.
        type_name: its pedestrian type, where the run tells it.
    """

    person: int
    first: int
    motion: BodyMotion
    type_name: str = ""

    @property
    def pelvis(self) -> NDArray[np.float64]:
        """(n, 3) positions of the pelvis, metres."""
        return self.motion.positions[:, 0]

    def turns(self) -> NDArray[np.float64]:
        """(n, 17, 4) turns of ``skeleton.TURNING`` against their parents, as quaternions.

        Of q and -q, the same rotation, it is the one nearer to the frame before: some viewers
        interpolate without looking.
        """
        matrices = self.motion.local()
        found = Rotation.from_matrix(matrices.reshape(-1, 3, 3)).as_quat()
        found = found.reshape(len(matrices), -1, 4)
        along = np.einsum("njk,njk->nj", found[1:], found[:-1])
        found[1:] *= np.cumprod(np.where(along < 0.0, -1.0, 1.0), axis=0)[..., None]
        return found


def walkers(
    trajectories: Trajectories, selection: Selection, bank: PoseBank | None = None
) -> Iterator[Walker]:
    """The people shown, one after the other; those in wheelchairs sit.

    Args:
        trajectories: a run with its decisions.
        selection: whom and when.
        bank: poses of their type; by default those that ship for its map.

    Raises:
        ResultsError: nobody to show, or no decisions.
        MapError: no poses of their map ship, or the bank is of another map.
    """
    first, last = selection.frames_of(trajectories)
    types = trajectories.person_data.get("type")
    for person in selection.people_of(trajectories):
        name = str(types[person]) if types is not None else ""
        if aid_of(name) == "wheelchair":
            motion = seated_motion(*track_of(trajectories, person))
        else:
            motion = trajectories.poses(person, bank=bank)
        there = np.flatnonzero((motion.frames >= first) & (motion.frames <= last))
        part = BodyMotion(
            frames=motion.frames[there],
            positions=motion.positions[there],
            rotations=motion.rotations[there],
            bearing=motion.bearing[there],
            scale=motion.scale,
        )
        yield Walker(person, int(part.frames[0]), part, name)
