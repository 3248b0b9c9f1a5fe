"""The rows of the arrays that compiled cost terms read and write."""

from __future__ import annotations

# Ends (6, n) of options in world coordinates: position, unit vector of facing, duration in seconds,
# speed in m/s. Others (8 + fields, n), the neighbours of a pedestrian at its decision: position,
# velocity, unit vector to the target, metres by which their route is the shorter one, room for
# costs, and from row FIELDS on the fields that pair terms take.
END_X, END_Y, END_UX, END_UY, SECONDS, SPEED = range(6)


END_ROWS = 6


OTHER_X, OTHER_Y, OTHER_VX, OTHER_VY, OTHER_EX, OTHER_EY, LEAD, COST, FIELDS = range(9)

KERNEL_FIELDS = ("type", "group", "heading", "core")
"""What a kernel may take of people besides the fields that the model declares: index of the type,
number of the group (0 for none), heading in radians, core radius in metres."""
