"""The records that a kernel may take.

Lengths are in metres, durations in seconds, speeds in m/s and angles in radians. All fields are
floats. A record costs nothing in compiled code: a field that a kernel does not read is not loaded.
"""

from __future__ import annotations

from typing import NamedTuple


class Option(NamedTuple):
    """One movement option.

    Attributes:
        x: x of the end, metres.
        y: y of the end, metres.
        facing_x: x of the unit vector of facing at the end.
        facing_y: y of the unit vector of facing at the end.
        duration: seconds that the option takes.
        speed: m/s; ``speed * duration`` is the displacement.
    """

    x: float
    y: float
    facing_x: float
    facing_y: float
    duration: float
    speed: float


class Options(NamedTuple):
    """A group of similar movement options, for a lower bound of their costs.

    Attributes:
        x: x of a centre of the ends, metres.
        y: y of a centre of the ends, metres.
        radius: metres from the centre within which all options end.
        facing_x: x of the unit vector of a mean facing at the ends.
        facing_y: y of the unit vector of a mean facing at the ends.
        turn: radians from this facing within which all options face.
        duration: seconds that each option takes.
        slowest: least speed of the options, m/s.
        fastest: greatest speed of the options, m/s.
    """

    x: float
    y: float
    radius: float
    facing_x: float
    facing_y: float
    turn: float
    duration: float
    slowest: float
    fastest: float


class Me(NamedTuple):
    """The pedestrian who decides.

    Attributes:
        x: x of the position, metres.
        y: y of the position, metres.
        target_x: x of the target, metres.
        target_y: y of the target, metres.
        preferred_speed: m/s; 0 for somebody without a route.
        vx: x of the mean velocity of the movement that has just ended, m/s.
        vy: y of the mean velocity of the movement that has just ended, m/s.
        core: core radius, metres.
        ahead: metres to the nearest neighbour on the side of the target, infinite without any.
        heading: facing, radians, counter-clockwise from +x.
        type: index of the pedestrian type.
        group: number of the group, 0 for none.
    """

    x: float
    y: float
    target_x: float
    target_y: float
    preferred_speed: float
    vx: float
    vy: float
    core: float
    ahead: float
    heading: float
    type: float
    group: float


class Other(NamedTuple):
    """A neighbour of the pedestrian, at the moment of the decision.

    Attributes:
        x: x of the position, metres.
        y: y of the position, metres.
        vx: x of the mean velocity of the movement under way, m/s.
        vy: y of the mean velocity of the movement under way, m/s.
        way_x: x of the unit vector to the neighbour's target; 0 at the target.
        way_y: y of the unit vector to the neighbour's target; 0 at the target.
        lead: metres by which the neighbour's route is shorter than the pedestrian's.
        core: core radius, metres.
        heading: facing, radians, counter-clockwise from +x.
        type: index of the pedestrian type.
        group: number of the group, 0 for none.
    """

    x: float
    y: float
    vx: float
    vy: float
    way_x: float
    way_y: float
    lead: float
    core: float
    heading: float
    type: float
    group: float


class Wall(NamedTuple):
    """A wall or a closed exit: a straight line between two points.

    Attributes:
        x1: x of one end, metres.
        y1: y of one end, metres.
        x2: x of the other end, metres.
        y2: y of the other end, metres.
    """

    x1: float
    y1: float
    x2: float
    y2: float


RECORDS: dict[str, type[Option | Options | Me | Other | Wall]] = {
    "option": Option,
    "options": Options,
    "me": Me,
    "other": Other,
    "wall": Wall,
}
"""The records by the names under which kernels ask for them."""
