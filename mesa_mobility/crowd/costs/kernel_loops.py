"""Python source of the loops that kernels are compiled with.

A loop gets an array of several rows as a pointer to its first number, and the length of a row. What
does not change in a loop is read before the loop: a compiler does not know that results are written
elsewhere.
"""

from __future__ import annotations

from collections.abc import Sequence

from mesa_mobility.crowd.costs.layout import KERNEL_FIELDS

OPTION_LOOP = """
def {name}(n, ends, width, own, at, numbers, weight, out):
    me, p = {me}, {p}
    for k in range(n):
        option = {option}
        out[k] += weight * each({arguments})
"""

BOUND_LOOP = """
def {name}(n, ends, width, groups, row, own, at, numbers, weight, out):
    me, p = {me}, {p}
    for k in range(n):
        options = Options(
            ends[k], ends[width + k], groups[2 * row + k], ends[2 * width + k], ends[3 * width + k],
            groups[5 * row + k], groups[6 * row + k], groups[7 * row + k], groups[8 * row + k]
        )
        out[k] += weight * each({arguments})
"""

PAIR_LOOP = """
def {name}(n, ends, width, others, row, own, at, numbers, out):
    k = 0
    me, p, option, rows = {me}, {p}, {option}, {rows}
    for a in range(n):
        other = {other}
        out[a] = each({arguments})
"""

PAIRS_LOOP = """
def {name}(m, which, n, ends, width, others, row, own, at, numbers, weight, out):
    me, p, rows = {me}, {p}, {rows}
    for b in range(m):
        a = which[b]
        other = {other}
        for k in range(n):
            option = {option}
            out[k] += weight * each({arguments})
"""

WALL_LOOP = """
def {name}(n, ends, width, walls, row, own, at, numbers):
    k = 0
    me, p, option = {me}, {p}, {option}
    worst = 0.0
    for a in range(n):
        wall = Wall(walls[row * a], walls[row * a + 1], walls[row * a + 2], walls[row * a + 3])
        cost = each({arguments})
        # A cost that is not a number stays the worst.
        worst = cost if worst == worst and not cost <= worst else worst
    return worst
"""

OPTION = "Option({})".format(", ".join(f"ends[{row} * width + k]" for row in range(6)))
"""Python source of the expression that makes the ``Option`` number ``k`` in a loop."""


def me_of(fields: Sequence[str], declared: Sequence[str]) -> str:
    """Python source of the expression that makes the ``Me`` of the pedestrian in a loop.

    Args:
        fields: names of the fields that are laid out for the kernel.
        declared: names of those among them that the model declares.
    """
    known = [f"own[{row}]" for row in range(9)]
    more = [_laid(name, fields, "own[at[{}]]") for name in (*KERNEL_FIELDS[1:], *declared)]
    return f"Me({', '.join([*known, *more])})"


def other_of(fields: Sequence[str], declared: Sequence[str], of_others: Sequence[str]) -> str:
    """Python source of the expression that makes the ``Other`` of neighbour number ``a`` in a loop.

    Args:
        fields: as for ``me_of``.
        declared: as for ``me_of``.
        of_others: names of the fields that are laid out for neighbours.
    """
    known = [f"others[{row} * row + a]" for row in range(7)]
    more = [
        _laid(name, fields if name in of_others else (), "others[rows[{}] * row + a]")
        for name in (*KERNEL_FIELDS, *declared)
    ]
    return f"Other({', '.join([*known, *more])})"


def rows_of(fields: Sequence[str]) -> str:
    """Python source of the expression for the rows of ``others`` that hold these fields."""
    given = "".join(f"at[{k}], " for k in range(len(fields)))
    return f"({given})"


def numbers_of(names: Sequence[str]) -> str:
    """Python source of the expression that makes the term's ``Numbers`` in a loop.

    It is 0 for a kernel that reads no numbers.
    """
    given = ", ".join(f"numbers[{k}]" for k in range(len(names)))
    return f"Numbers({given})" if names else "0.0"


def _laid(name: str, fields: Sequence[str], place: str) -> str:
    return place.format(fields.index(name)) if name in fields else "0.0"
