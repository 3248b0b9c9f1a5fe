"""Leaving by the nearest exit."""

from mesa_mobility import Deciding, TargetChoice, Targets


class NearestExit(TargetChoice):
    """Everybody heads for the nearest exit that they may leave by, along the shortest route."""

    name = "nearest_exit"

    def targets(self, deciding: Deciding) -> Targets:
        """The next door or corner on the way, or a point beyond the exit once it is in view."""
        return deciding.site.targets(deciding.positions, deciding.destinations)
