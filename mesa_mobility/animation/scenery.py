"""Floor and walls as meshes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from mesa_mobility.animation.buildings.storeys import storey_surfaces
from mesa_mobility.animation.meshes import FLOOR, SQUARE, Surface
from mesa_mobility.animation.solids import solid_surfaces, solids_of
from mesa_mobility.floorplan import FloorPlan

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building

MARGIN = 0.5
"""Metres by which the floor reaches beyond the walls."""


def surfaces(plan: FloorPlan | Building, most_vertices: int | None = None) -> Iterator[Surface]:
    """The floor, walls and seats; of a building, each level, the stairs and the lifts.

    Args:
        plan: floor and walls, or a building.
        most_vertices: of a mesh of walls, seats or handrails, which are divided among as many
            meshes as that takes; all of a kind are in one mesh if None.
    """
    if not isinstance(plan, FloorPlan):
        yield from storey_surfaces(plan, most_vertices)
        return
    x0, y0, x1, y1 = plan.bounds
    x0, y0, x1, y1 = x0 - MARGIN, y0 - MARGIN, x1 + MARGIN, y1 + MARGIN
    floor = np.array([[x0, y0, 0], [x1, y0, 0], [x1, y1, 0], [x0, y1, 0]], dtype=np.float32)
    up = np.tile(np.array([0, 0, 1], dtype=np.float32), (4, 1))
    yield Surface("floor", floor, up, SQUARE, FLOOR, False)
    yield from solid_surfaces("", solids_of(plan), 0.0, most_vertices)


def linear(colour: str) -> list[float]:
    """Red, green and blue without gamma, as renderers take them, of hexadecimal digits."""
    channels = [int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    values = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return [round(value, 5) for value in values]
