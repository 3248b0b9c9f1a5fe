"""The rows of the arrays that compiled cost terms read and write."""

from __future__ import annotations

# Ends (6, n) of options in world coordinates: position, unit vector of facing, duration in seconds,
# speed in m/s. Others (8, n), the neighbours of a pedestrian at its decision: position, velocity,
# unit vector to the target, metres by which their route is the shorter one, and room for costs.
END_X, END_Y, END_UX, END_UY, SECONDS, SPEED = range(6)


END_ROWS = 6


OTHER_X, OTHER_Y, OTHER_VX, OTHER_VY, OTHER_EX, OTHER_EY, LEAD, COST = range(8)
