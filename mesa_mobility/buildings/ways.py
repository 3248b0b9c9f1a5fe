"""The gates of ways that lead over stairs, ramps, escalators and lifts of given names."""

from collections.abc import Mapping, Sequence

from mesa_mobility.buildings.connections.escalator import DOWN, UP, Escalator
from mesa_mobility.buildings.connections.lift import Lift
from mesa_mobility.buildings.connections.ramp import Ramp
from mesa_mobility.buildings.connections.stairs import Stairs
from mesa_mobility.floorplan import Gate

_ENDS = 3, -4
"""Which gates of stairs are next to the upper and to the lower level: the last of the highest
flight, the first of the lowest."""


def gates_of_way(
    names: Sequence[str],
    level: int,
    climbs: bool,
    joints: Mapping[str, Stairs | Ramp | Escalator | Lift],
    gates: Mapping[str, Sequence[Gate]],
) -> tuple[str, ...]:
    """Names of the gates of a way; see `Building.way`.

    Args:
        names: stairs, ramps, escalators, lifts and gates in order.
        level: number of the level where the way begins.
        climbs: whether it is for people who use stairs.
        joints: what joins levels, by its name.
        gates: the gates of each in the plane, those of flights as `Seam.gates`, from the top.
    """
    owners = {gate.name: name for name, own in gates.items() for gate in own}
    here: int | None = level
    found: list[str] = []
    for k, name in enumerate(names):
        joint = joints.get(owners.get(name, name))
        if joint is not None and not _is_for(joint, climbs):
            continue
        if joint is None or name in owners:
            found.append(name)
        elif isinstance(joint, Lift):
            if here in joint.numbers:
                found.append(gates[name][joint.numbers.index(here)].name)
                rest = [joints[each] for each in names[k + 1 :] if each in joints]
                here = _stop_for(joint, here, rest)
        elif here in _starts(joint):
            down = here == joint.upper
            ends = [gates[name][k].name for k in _ENDS]
            found += ends if down else ends[::-1]
            here = joint.lower if down else joint.upper
    return tuple(found)


def _is_for(joint: Stairs | Ramp | Escalator | Lift, climbs: bool) -> bool:
    """Whether people who use stairs, or those who do not, use this."""
    if isinstance(joint, Lift):
        return joint.everybody or not climbs
    return climbs or isinstance(joint, Ramp)


def _starts(joint: Stairs | Ramp | Escalator) -> tuple[int, ...]:
    """Numbers of the levels from which this leads to the other."""
    if isinstance(joint, Escalator) and joint.speed:
        return {UP: (joint.lower,), DOWN: (joint.upper,)}[joint.direction]
    return joint.upper, joint.lower


def _stop_for(
    lift: Lift, here: int, rest: Sequence[Stairs | Ramp | Escalator | Lift]
) -> int | None:
    """The level of a lift at which what comes next on a way begins; None if nothing does."""
    for joint in rest:
        begins = joint.numbers if isinstance(joint, Lift) else _starts(joint)
        for number in begins:
            if number in lift.numbers and number != here:
                return number
    return None
