"""The arrays that compiled cost terms read and write."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

# Ends (6, n) of options in world coordinates, as the fields of the record Option.
END_X, END_Y, END_UX, END_UY, SECONDS, SPEED = range(6)


END_ROWS = 6


# Others (9 + fields, n), the neighbours of a pedestrian: the first fields of the record Other, room
# for costs, workspace, and from row FIELDS on the fields that terms take of neighbours.
OTHER_X, OTHER_Y, OTHER_VX, OTHER_VY, OTHER_EX, OTHER_EY, LEAD, COST, AWAY, FIELDS = range(10)

# The pedestrian (9 + fields,): the first fields of the record Me, and from FIELDS on the fields
# that terms take.
ME_X, ME_Y, ME_TARGET_X, ME_TARGET_Y, ME_PREFERRED, ME_VX, ME_VY, ME_CORE, ME_AHEAD = range(9)

KERNEL_FIELDS = ("core", "heading", "type", "group")
"""Fields that are laid out for the terms that read them, besides those that the model declares."""


class KernelTable(NamedTuple):
    """Kernels of one kind, of n terms.

    Attributes:
        address: (n,) of the machine code; 0 for none.
        weight: (types, n) by pedestrian type.
        numbers: (n, most) what each kernel reads as ``p``.
        fields: (n, most) the rows at which it finds fields.
    """

    address: NDArray[np.int64]
    weight: NDArray[np.float64]
    numbers: NDArray[np.float64]
    fields: NDArray[np.int64]


class Terms(NamedTuple):
    """The compiled cost terms of a model.

    Attributes:
        option: kernels over options.
        bound: their lower bounds, in the same order.
        pair: kernels over options and neighbours, by the loop over neighbours of one option.
        pairs_address: of the same kernels, by the loop over some neighbours and many options.
        wall: kernels over options and walls.
        fields: (people, fields) the values that any of the terms takes.
        of_others: number of those fields, the first ones, that terms read of neighbours.
    """

    option: KernelTable
    bound: KernelTable
    pair: KernelTable
    pairs_address: NDArray[np.int64]
    wall: KernelTable
    fields: NDArray[np.float64]
    of_others: int
