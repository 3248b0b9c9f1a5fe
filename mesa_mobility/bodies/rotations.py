"""Rotations of many vectors at once, and of many joints."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

TINY = 1e-9


def unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 3) vectors of length 1; those without a length stay as they are."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), TINY)


def shortest_turn(start: NDArray[np.float64], end: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 3, 3) rotation matrices that turn unit vectors ``start`` the shortest way to ``end``.

    Opposite vectors are turned about some axis at right angles to them.
    """
    start, end = np.broadcast_arrays(start, end)
    axis = np.cross(start, end)
    cosine = np.einsum("...i,...i->...", start, end)
    # Half-angle form of the quaternion: (axis, 1 + cosine), not yet of unit length.
    quaternion = np.concatenate([axis, 1.0 + cosine[..., None]], axis=-1)
    opposite = cosine < -1.0 + 1e-12
    if opposite.any():
        least = np.eye(3)[np.argmin(np.abs(start[opposite]), axis=-1)]
        quaternion[opposite, :3] = unit(np.cross(start[opposite], least))
        quaternion[opposite, 3] = 0.0
    return matrices(quaternion)


def axes(y: NDArray[np.float64], z: NDArray[np.float64], *, first: str) -> NDArray[np.float64]:
    """(..., 3, 3) orientations with two axes near given directions, the ``first`` one exactly."""
    if first == "y":
        y = unit(y)
        x = unit(np.cross(y, z))
        z = np.cross(x, y)
    else:
        z = unit(z)
        x = unit(np.cross(y, z))
        y = np.cross(z, x)
    return np.stack([x, y, z], axis=-1)


def matrices(quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 3, 3) matrices of (..., 4) quaternions (x, y, z, w) of any length but zero."""
    shape = quaternions.shape[:-1]
    return Rotation.from_quat(quaternions.reshape(-1, 4)).as_matrix().reshape(*shape, 3, 3)


def quaternions(turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 4) unit quaternions (x, y, z, w) of (..., 3, 3) matrices."""
    shape = turns.shape[:-2]
    return Rotation.from_matrix(turns.reshape(-1, 3, 3)).as_quat().reshape(*shape, 4)


def rotation_vectors(turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 3) axis times angle of (..., 3, 3) matrices, radians."""
    shape = turns.shape[:-2]
    return Rotation.from_matrix(turns.reshape(-1, 3, 3)).as_rotvec().reshape(*shape, 3)


def from_vectors(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 3, 3) matrices of (..., 3) rotation vectors, radians."""
    shape = vectors.shape[:-1]
    return Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(*shape, 3, 3)


def angles(turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """(...) angles of (..., 3, 3) matrices, radians."""
    trace = np.trace(turns, axis1=-2, axis2=-1)
    return np.arccos(np.clip((trace - 1.0) / 2.0, -1.0, 1.0))


def about_z(angle: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 3, 3) turns about the vertical by (n,) radians."""
    c, s = np.cos(angle), np.sin(angle)
    turns = np.zeros((*np.shape(angle), 3, 3))
    turns[..., 0, 0] = turns[..., 1, 1] = c
    turns[..., 0, 1], turns[..., 1, 0], turns[..., 2, 2] = -s, s, 1.0
    return turns
