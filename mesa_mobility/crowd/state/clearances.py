"""How far bodies, and the routes of bodies of each size, keep from walls."""

from mesa_mobility.floorplan.routing.route_nodes import NODE_SHARE

BERTH = 0.05
"""Metres by which routes keep clear of corners, in addition to the core radius."""

MARGIN = 1e-4
"""Metres added to every clearance, so that rounded results still keep it."""


def clearance_of(core: float) -> float:
    """Clearance in metres that routes of bodies with this core radius keep from walls.

    In narrow passages a route keeps ``NODE_SHARE`` of it, which must still hold the body.
    """
    return max(core + BERTH, (core + 2.0 * MARGIN) / NODE_SHARE)


def passing_of(core: float) -> float:
    """Half the width in metres of the narrowest gap that routes of such bodies lead through."""
    return NODE_SHARE * clearance_of(core)
