"""The records that a kernel may take.

Lengths are in metres, durations in seconds, speeds in m/s and angles in radians. All fields are
floats. A record costs nothing in compiled code: a field that a kernel does not read is not loaded.
"""

from __future__ import annotations

from typing import NamedTuple


class Option(NamedTuple):
    """One movement option.

    Attributes:
        x: where it ends.
        y: where it ends.
        facing_x: unit vector of facing there.
        facing_y: unit vector of facing there.
        duration: how long it takes.
        speed: speed; ``speed * duration`` is the displacement.
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
        x: centre of their ends.
        y: centre of their ends.
        radius: no option ends farther from the centre.
        facing_x: unit vector of their mean facing.
        facing_y: unit vector of their mean facing.
        turn: no option faces farther from it, radians.
        duration: how long each of them takes.
        slowest: the least of their speeds.
        fastest: the greatest of their speeds.
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
        x: position.
        y: position.
        target_x: target.
        target_y: target.
        preferred_speed: preferred speed; 0 for somebody without a route.
        vx: mean velocity of the movement that has just ended.
        vy: mean velocity of the movement that has just ended.
        core: core radius.
        ahead: distance to the nearest neighbour on the side of the target, infinite without any.
        heading: facing, counter-clockwise from +x.
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
        x: position.
        y: position.
        vx: mean velocity of the movement under way.
        vy: mean velocity of the movement under way.
        way_x: unit vector to the neighbour's target; 0 at the target.
        way_y: unit vector to the neighbour's target; 0 at the target.
        lead: by how much the neighbour's route is shorter than the pedestrian's.
        core: core radius.
        heading: facing, counter-clockwise from +x.
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
        x1: one end.
        y1: one end.
        x2: the other end.
        y2: the other end.
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
