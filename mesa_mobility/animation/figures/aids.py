"""What people hold or sit in: rigid parts that one joint of the neutral skeleton carries."""

from __future__ import annotations

from mesa_mobility.animation.figures.figure import Figure, Tube, human_figure, joined
from mesa_mobility.bodies.seated import SEATED_PELVIS
from mesa_mobility.bodies.skeleton import ANKLE_HEIGHT, LEG_LENGTH
from mesa_mobility.mobility import WHEELCHAIRS

FLOOR = -(LEG_LENGTH + ANKLE_HEIGHT)
"""Metres from the pelvis of somebody who stands upright down to the floor."""

_CLEAR = 0.03
"""Metres by which sticks end above the floor: the pelvis sinks a little in each step."""

_HAND = -0.17
"""Metres from the pelvis down to the hand of an arm that hangs."""

_HAND_ASIDE = 0.185


def aid_of(type_name: str) -> str:
    """What somebody of a type holds or sits in; nothing for most types."""
    if type_name in WHEELCHAIRS:
        return "wheelchair"
    return type_name if type_name in _AIDS else ""


def aid_figure(aid: str, around: int) -> Figure:
    """An aid alone, as its user's joints carry it, with so many vertices round each bar."""
    return joined(_AIDS[aid], around)


def figure_with(aid: str) -> Figure:
    """The figure of an adult with what ``aid_of`` names.

    A stick goes with the forearm; a frame and a chair go with the pelvis.
    """
    return human_figure(more=_AIDS[aid]) if aid else human_figure()


def _bar(
    start: tuple[float, float, float],
    end: tuple[float, float, float],
    radii: tuple[float, float],
    joint: str,
) -> Tube:
    """A bar along an axis; radii along the first and the second of the axes across it."""
    axis = next(k for k in range(3) if start[k] != end[k])
    if axis == 0:
        radii = radii[::-1]  # tubes along x have the radius along z first
    rings = [(place, *radii, {joint: 1.0}) for place in (start, end)]
    return rings, axis, "aid"


def _stick(side: str) -> Tube:
    y = _HAND_ASIDE if side == "left" else -_HAND_ASIDE
    return _bar((0.03, y, FLOOR + _CLEAR), (0.03, y, _HAND), (0.012, 0.012), f"{side}_elbow")


def _frame() -> list[Tube]:
    bars, low = [], FLOOR + _CLEAR
    for y in (-0.28, 0.28):
        for x in (0.10, 0.55):
            bars.append(_bar((x, y, low), (x, y, -0.05), (0.014, 0.014), "pelvis"))
        bars.append(_bar((0.05, y, -0.05), (0.57, y, -0.05), (0.016, 0.016), "pelvis"))
    bars.append(_bar((0.55, -0.28, -0.3), (0.55, 0.28, -0.3), (0.014, 0.014), "pelvis"))
    return bars


def _wheelchair() -> list[Tube]:
    low, parts = -SEATED_PELVIS, []
    for side in (-1.0, 1.0):
        for x, radius, inner in ((-0.10, 0.30, 0.27), (0.35, 0.09, 0.20)):
            hub = low + radius
            ends = ((x, side * inner, hub), (x, side * (inner + 0.03), hub))
            parts.append(_bar(*ends, (radius, radius), "pelvis"))
        rest = ((-0.20, side * 0.25, 0.16), (0.20, side * 0.25, 0.16))
        parts.append(_bar(*rest, (0.025, 0.02), "pelvis"))
    parts.append(_bar((-0.24, 0.0, -0.12), (0.22, 0.0, -0.12), (0.22, 0.03), "pelvis"))
    parts.append(_bar((-0.25, 0.0, -0.12), (-0.25, 0.0, 0.40), (0.03, 0.21), "pelvis"))
    parts.append(_bar((0.38, 0.0, low + 0.04), (0.62, 0.0, low + 0.04), (0.18, 0.015), "pelvis"))
    return parts


_AIDS: dict[str, list[Tube]] = {
    # Held in the hand away from the leg that limps, the right one.
    "cane": [_stick("left")],
    "crutches": [_stick("left"), _stick("right")],
    "walking_frame": _frame(),
    "wheelchair": _wheelchair(),
}
