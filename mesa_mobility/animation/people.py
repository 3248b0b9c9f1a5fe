"""The people of a run, and their bodies in the frames that are shown."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mesa_mobility.animation.figures.aids import aid_of
from mesa_mobility.bodies import BodyMotion, PoseBank
from mesa_mobility.bodies.seated import seated_motion
from mesa_mobility.results.bodies import body_of, elevation_of, track_of
from mesa_mobility.results.excerpts import Selection
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building


@dataclass(frozen=True)
class Walker:
    """One person and their body in those frames that are shown.

    Attributes:
        person: number of the person.
        first: first frame of ``motion``.
        motion: the person's body in successive frames.
        type_name: the person's pedestrian type; empty if the run does not tell it.
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
    trajectories: Tracks,
    selection: Selection,
    bank: PoseBank | None = None,
    building: Building | None = None,
) -> Iterator[Walker]:
    """The people shown, one after the other; those in wheelchairs sit.

    Args:
        trajectories: a run with its decisions.
        selection: whom and when.
        bank: poses of their type; by default those that ship for the map.
        building: where the run was, to put feet on the treads of its stairs.

    Raises:
        ResultsError: nobody to show, or no decisions.
        MapError: no poses of their map ship, or the bank is of another map.
    """
    first, last = selection.frames_of(trajectories)
    types = trajectories.person_data.get("type")
    for person in selection.people_of(trajectories):
        name = str(types[person]) if types is not None else ""
        if aid_of(name) == "wheelchair":
            elevation = None if building is None else elevation_of(trajectories, person)
            motion = seated_motion(*track_of(trajectories, person), elevation)
        else:
            motion = body_of(trajectories, person, bank=bank, building=building)
        there = np.flatnonzero((motion.frames >= first) & (motion.frames <= last))
        part = BodyMotion(
            frames=motion.frames[there],
            positions=motion.positions[there],
            rotations=motion.rotations[there],
            bearing=motion.bearing[there],
            scale=motion.scale,
        )
        yield Walker(person, int(part.frames[0]), part, name)
