"""Ways out of a building by the stairs, ramps, escalators and lifts by which people came in."""

from collections.abc import Mapping, Sequence

from mesa_mobility.buildings.connections.escalator import DOWN, UP, Escalator
from mesa_mobility.buildings.connections.lift import Lift
from mesa_mobility.buildings.connections.ramp import Ramp
from mesa_mobility.buildings.connections.stairs import Stairs
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Gate

Joint = Stairs | Ramp | Escalator | Lift
"""Stairs and the like: each joins levels."""

_UPPER, _LOWER = 3, -4
"""Which gates of stairs are next to the upper and to the lower level: the last of the highest
flight, the first of the lowest."""


def gates_of_way_out(
    came: Sequence[str],
    level: int,
    climbs: bool,
    joints: Mapping[str, Joint],
    gates: Mapping[str, Sequence[Gate]],
    exits: Mapping[str, int],
) -> tuple[str, ...]:
    """Names of the gates of a way out; see `Building.way_out`.

    Args:
        came: stairs, ramps, escalators, lifts and gates, from the exit on, which may come first.
        level: number of the level where people are.
        climbs: whether they use stairs.
        joints: what joins levels, by its name.
        gates: the gates of each in the plane, those of flights as `Seam.gates`, from the top.
        exits: the level of each exit, by its name.

    Raises:
        FloorPlanError: an exit behind the first name, or a way that may begin on several levels.
    """
    starts = set(exits.values())
    if len(came) and came[0] in exits:
        starts, came = {exits[came[0]]}, came[1:]
    if behind := [name for name in came if name in exits]:
        raise FloorPlanError(f"way in: exit {behind[0]!r}, expected an exit only as the first name")
    first = next((joints[name] for name in came if name in joints), None)
    if first is None:
        owners = {gate.name: joints[name] for name, own in gates.items() for gate in own}
        used = [name for name in came if name not in owners or _is_for(owners[name], climbs)]
        return tuple(used[::-1])
    found = sorted(starts.intersection(_levels(first)))
    if len(found) > 1:
        raise FloorPlanError(
            f"way in over {first.name!r}: levels {', '.join(map(str, found))} have exits, expected "
            "the exit by which people came in as the first name"
        )
    return _way_back(came, level, climbs, joints, gates, found[0]) if found else ()


def _way_back(
    came: Sequence[str],
    level: int,
    climbs: bool,
    joints: Mapping[str, Joint],
    gates: Mapping[str, Sequence[Gate]],
    start: int,
) -> tuple[str, ...]:
    """The gates from a level back to the one where the way in began; none if it passed by."""
    here, way, found = start, tuple[str, ...](), tuple[str, ...]()
    for k, name in enumerate(came):
        joint = joints.get(name)
        if joint is None:
            way = (name, *way)
            found = way if here == level else found
            continue
        rest = [joints[each] for each in came[k + 1 :] if each in joints]
        there = _far_end(joint, here, level, rest)
        if there is None or not _is_for(joint, climbs) or not _leads(joint, there):
            break
        if isinstance(joint, Lift):
            doors = {number: gates[name][joint.numbers.index(number)] for number in joint.numbers}
            if level in doors and level != here:
                found = (doors[level].name, *way)
            way = (doors[there].name, *way)
        else:
            ends = gates[name][_UPPER].name, gates[name][_LOWER].name
            way = (*(ends if there == joint.upper else ends[::-1]), *way)
        here = there
        found = way if here == level else found
    return found


def _far_end(joint: Joint, here: int, level: int, rest: Sequence[Joint]) -> int | None:
    """The level to which something led from another one, before the rest; None if it did not.

    A lift led to the level at which the next of the rest begins, otherwise to that of the people.
    """
    others = [number for number in _levels(joint) if number != here]
    if here not in _levels(joint):
        return None
    if not isinstance(joint, Lift):
        return others[0]
    following = _levels(rest[0]) if rest else (level,)
    return next((number for number in others if number in following), None)


def _levels(joint: Joint) -> tuple[int, ...]:
    """Numbers of the levels that something joins."""
    return joint.numbers if isinstance(joint, Lift) else (joint.upper, joint.lower)


def _is_for(joint: Joint, climbs: bool) -> bool:
    """Whether people who use stairs, or those who do not, use this."""
    if isinstance(joint, Lift):
        return joint.everybody or not climbs
    return climbs or isinstance(joint, Ramp)


def _leads(joint: Joint, start: int) -> bool:
    """Whether something leads away from a level: not if it is an escalator the other way."""
    if isinstance(joint, Escalator) and joint.speed:
        return start == {UP: joint.lower, DOWN: joint.upper}[joint.direction]
    return True
