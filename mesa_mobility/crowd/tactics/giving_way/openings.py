"""Openings that wide people are about to enter, and where they wait, turn in or go back."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

REACH = 4.0
"""Metres before an opening at which wide people heed it: the longest movement, 3 m, and room to
stop."""

BESIDE_JAMB = 0.35
"""Metres by which the way of a person going by an opening may miss it: half a wide body."""

AT_JAMB = 0.05
"""Metres from a jamb within which somebody is up against it."""

SECONDS_TO_STOP = 1.5
"""Time in which those who wait come to a halt: the longest movement."""

BACKING = 0.8
"""Highest speed of those who make room, m/s."""

NOBODY = -1


def middles(mouths: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m, 2) points in the middle of mouths, metres."""
    found: NDArray[np.float64] = (mouths[:, :2] + mouths[:, 2:4]) / 2.0
    return found


def widths(mouths: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m,) widths of mouths, metres."""
    found: NDArray[np.float64] = np.hypot(mouths[:, 2] - mouths[:, 0], mouths[:, 3] - mouths[:, 1])
    return found


def mouths_ahead(
    mouths: NDArray[np.float64],
    places: NDArray[np.float64],
    points: NDArray[np.float64],
    radii: NDArray[np.float64],
) -> NDArray[np.int64]:
    """(n,) the nearest mouth within reach that each is about to enter, or -1.

    Its straight way to its target leads through the mouth, or ends right before it: there routes
    bend into an opening.

    Args:
        mouths: (m, 6) as ``narrow_mouths`` gives them.
        places: (n, 2) where they are, metres.
        points: (n, 2) their targets, metres.
        radii: (n,) of the circles that hold their bodies, metres.
    """
    start, inward = mouths[:, :2], mouths[:, 4:]
    width = widths(mouths)
    along = (mouths[:, 2:4] - start) / width[:, None]
    off = ((places[:, None] - start) * inward).sum(axis=2)
    off_target = ((points[:, None] - start) * inward).sum(axis=2)
    outside = off < 0.0
    through = outside & (off_target > 0.0)
    share = off / np.where(through, off - off_target, 1.0)
    crossing = places[:, None] + np.where(through, share, 0.0)[:, :, None] * (
        points[:, None] - places[:, None]
    )
    lateral = ((crossing - start) * along).sum(axis=2)
    through &= (lateral >= -BESIDE_JAMB) & (lateral <= width + BESIDE_JAMB)
    middle = middles(mouths)
    before = np.hypot(*(points[:, None] - middle).transpose(2, 0, 1))
    stays = (points == places).all(axis=1)
    before_it = (before < clear_of(width, radii[:, None])) & outside & ~stays[:, None]
    way = np.hypot(*(places[:, None] - middle).transpose(2, 0, 1))
    way = np.where(through | before_it, way, np.inf)
    nearest = way.argmin(axis=1)
    found: NDArray[np.int64] = np.where(
        way[np.arange(len(places)), nearest] <= REACH, nearest, NOBODY
    )
    return found


def clear_of(width: NDArray[np.float64], radii: NDArray[np.float64]) -> NDArray[np.float64]:
    """Metres from the middle of a mouth that a body's width beside it reaches to."""
    return width / 2.0 + 2.0 * radii


def at_a_jamb(
    mouths: NDArray[np.float64], places: NDArray[np.float64], cores: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(n,) whether each is up against a jamb of the mouth that it is at, and cannot go on."""
    lines = mouths[:, :4].reshape(-1, 2, 2)
    to_jamb = np.hypot(*(lines - places[:, None]).transpose(2, 0, 1)).min(axis=1)
    width = widths(mouths)
    aside = ((places - middles(mouths)) * (lines[:, 1] - lines[:, 0])).sum(axis=1) / width
    against: NDArray[np.bool_] = (to_jamb < cores + AT_JAMB) & (abs(aside) > width / 2.0 - cores)
    return against


def axis_points(mouths: NDArray[np.float64], radii: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 2) where people may turn into the mouth that each is at: a body before its middle."""
    points: NDArray[np.float64] = middles(mouths) - 2.0 * radii[:, None] * mouths[:, 4:]
    return points


def wait_clear(
    mouths: NDArray[np.float64],
    places: NDArray[np.float64],
    radii: NDArray[np.float64],
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Targets and speeds of people who keep a body's width clear of the mouth that each is at.

    Those who are nearer go away from it. The others stop half a body before, so that those who go
    away have room.
    """
    from_mouth = places - middles(mouths)
    way = np.hypot(from_mouth[:, 0], from_mouth[:, 1])
    free = way - clear_of(widths(mouths), radii)
    away = from_mouth / np.maximum(way, 1e-9)[:, None]
    left = np.maximum(free - radii, 0.0)
    on = points - places
    on *= np.minimum(1.0, left / np.maximum(np.hypot(on[:, 0], on[:, 1]), 1e-9))[:, None]
    too_near = free < 0.0
    return (
        places + np.where(too_near[:, None], 2.0 * away, on),
        np.where(too_near, np.minimum(speeds, BACKING), np.minimum(speeds, left / SECONDS_TO_STOP)),
    )
