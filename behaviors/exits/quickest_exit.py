"""Leaving by the exit with the shortest expected time."""

from typing import Annotated

import numpy as np
from mesa_mobility.behaviors.exits.exit_choice import Choosing, ExitChoice
from numpy.typing import ArrayLike, NDArray

from mesa_mobility import Range


def people_a_second(width: ArrayLike) -> NDArray[np.float64]:
    """The flow through openings of these widths, metres: 2.23 w - 0.155, 0.5 at least.

    The fit to published bottleneck experiments of 0.7 to 3 m.
    """
    return np.maximum(2.23 * np.asarray(width, dtype=np.float64) - 0.155, 0.5)


class QuickestExit(ExitChoice):
    """Everybody heads for the exit through which they expect to get soonest.

    The time expected is that of the walk, at one's own speed, plus that of the people who pass
    before: the number of those who head for the exit and are nearer to it, over the flow through it
    (Ehtamo, Heliovaara, Korhonen and Hostikka 2010, Advances in Complex Systems 13: 113-134).
    People change their mind for a gain of more than ``patience`` of the time that they expect to
    need in all, counted from when they first chose an exit: somebody who has queued for a minute
    does not leave the queue for a second. They think again every ``interval`` seconds on average.

    The flow is 2.23 w - 0.155 people a second through a width of w metres, the fit to published
    bottleneck experiments of 0.7 to 3 m, and 0.5 at least.

    Args:
        interval: mean seconds between two choices.
        patience: least gain for which people turn round, as a share of the time expected in all.

    Raises:
        ModelError: a parameter out of range.
    """

    name = "quickest_exit"

    def __init__(
        self, interval: float = 2.0, patience: Annotated[float, Range(0.0, 1.0, below=True)] = 0.1
    ) -> None:
        super().__init__(interval)
        self.patience = patience

    def choose(self, choosing: Choosing) -> NDArray[np.int64]:
        """(k,) number of the exit with the least expected time, or the current one."""
        times = self.expected_times(choosing)
        best = times.argmin(axis=1)
        everyone = np.arange(len(best))
        has = choosing.current >= 0
        now = np.where(has, times[everyone, choosing.current], np.inf)
        # The gain against the least, so arranged that an exit out of reach is infinitely far.
        worth = (1.0 - self.patience) * now - self.patience * choosing.under_way
        return np.where((times[everyone, best] < worth) | ~has, best, choosing.current)

    def expected_times(self, choosing: Choosing) -> NDArray[np.float64]:
        """(k, e) seconds that each expects to take to pass each exit."""
        inside = choosing.deciding.inside
        to_go = inside.distances
        at = inside.places(choosing.pedestrians)
        times = choosing.distances / choosing.preferred_speeds[:, None]
        for number, exit_ in enumerate(choosing.deciding.site.plan.exits):
            flow = people_a_second(exit_.length)
            headed = choosing.heading == number
            nearer = np.searchsorted(np.sort(to_go[headed]), choosing.distances[:, number])
            oneself = headed[at] & (to_go[at] < choosing.distances[:, number])
            times[:, number] += (nearer - oneself) / flow
        return times
