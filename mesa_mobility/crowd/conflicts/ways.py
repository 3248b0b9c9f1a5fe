"""The ways of people who are to pass, as those see them who make way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.conflicts.places import AHEAD, Body, Way, distances_to_way
from mesa_mobility.crowd.tactics.deciding import Deciding
from mesa_mobility.floorplan.floor.seams import to_own_sheets

LEGS = 3
"""Most straight pieces of the way that is left free."""


def body_of(row: int, deciding: Deciding) -> Body:
    """Where somebody is, and how wide."""
    crowd = deciding.inside.crowd
    return Body(np.array([crowd.x[row], crowd.y[row]]), float(crowd.core[row]))


def way_of(row: int, deciding: Deciding) -> Way:
    """Somebody, and the next metres of their route."""
    body, left = body_of(row, deciding), AHEAD
    way = [body.place]
    destination = deciding.inside.crowd.destination[[row]].astype(np.int64)
    for _ in range(LEGS):
        own = way[-1][None] + to_own_sheets(way[-1][None], deciding.site.plan.seams)
        [step] = deciding.site.targets(own, destination).points - own
        length = float(np.hypot(*step))
        if length < 1e-6 or left <= 0.0:
            break
        way.append(way[-1] + step * min(1.0, left / length))
        left -= length
    return Way(body, np.array(way if len(way) > 1 else way * 2))


def seen_by(row: int, other: int, way: Way, deciding: Deciding) -> Way:
    """The way of somebody as a person sees it, who may be on another sheet."""
    [seen] = deciding.inside.seen_by(np.array([row]), np.array([other]))
    shift = seen - way.body.place
    return Way(way.body._replace(place=seen), way.points + shift) if shift.any() else way


def leads_across(path: NDArray[np.float64], core: float, way: Way) -> bool:
    """Whether a path (k, 2), metres, of somebody with this core radius leads across a way."""
    off, along = distances_to_way(path, way.points)
    return bool(((off < way.body.core + core) & (along > 0.0)).any())
