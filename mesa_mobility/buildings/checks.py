"""Checks of the parts of a building: they have different names, and ways lead to an exit."""

from collections.abc import Sequence
from itertools import pairwise

from mesa_mobility.buildings.connections.escalator import DOWN, UP, Escalator
from mesa_mobility.buildings.connections.lift import Lift
from mesa_mobility.buildings.connections.ramp import Ramp
from mesa_mobility.buildings.connections.stairs import Stairs
from mesa_mobility.buildings.level import Level
from mesa_mobility.errors import FloorPlanError


def check_joined(
    levels: Sequence[Level], stairs: Sequence[Stairs | Ramp | Escalator], lifts: Sequence[Lift]
) -> None:
    """A way must lead from each level to one with an exit; FloorPlanError otherwise."""
    import networkx as nx

    graph = nx.DiGraph()
    graph.add_nodes_from(level.number for level in levels)
    for each in stairs:
        ways = {UP: (each.lower, each.upper), DOWN: (each.upper, each.lower)}
        if isinstance(each, Escalator) and each.speed:
            graph.add_edges_from([ways[each.direction]])
        else:
            graph.add_edges_from(ways.values())
    for one, other in (pair for each in lifts for pair in pairwise(each.numbers)):
        graph.add_edges_from([(one, other), (other, one)])
    leading_out = {level.number for level in levels if level.exits}
    for number in sorted(graph):
        if len(levels) > 1 and not leading_out & {number, *nx.descendants(graph, number)}:
            raise FloorPlanError(
                f"level {number}: no stairs, ramp, escalator or lift lead from there to a "
                "level with an exit"
            )


def check_names(
    levels: Sequence[Level], stairs: Sequence[Stairs | Ramp | Escalator], lifts: Sequence[Lift]
) -> None:
    """Levels, stairs and lifts must be that, and have different names; FloorPlanError otherwise."""
    if not levels:
        raise FloorPlanError("a building needs at least one level")
    for given, kinds in ((levels, (Level,)), (stairs, (Stairs, Ramp, Escalator)), (lifts, (Lift,))):
        for each in given:
            if not isinstance(each, kinds):
                expected = " or ".join(kind.__name__ for kind in kinds)
                raise FloorPlanError(
                    f"a building has {expected} objects, found {type(each).__name__}"
                )
    for what, names in (
        ("level", sorted(each.number for each in levels)),
        (
            "stairs, ramp, escalator or lift",
            sorted([each.name for each in stairs] + [each.name for each in lifts]),
        ),
        ("refuge", sorted(each.name for level in levels for each in level.refuges)),
    ):
        for one, other in pairwise(names):
            if one == other:
                raise FloorPlanError(f"{what} {one!r} is there twice")
    # Such a name stands for all gates of the stairs or the lift.
    taken = {each.name for each in (*stairs, *lifts)}
    for level in levels:
        for opening in (*level.gates, *level.exits):
            if opening.name in taken:
                raise FloorPlanError(
                    f"level {level.number}: {opening.kind} {opening.name!r} has the name of "
                    "stairs, a ramp, an escalator or a lift, expected another name"
                )
