"""What is wrong with tracks: rows that repeat a frame, gaps, jumps, people alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.human_limits import FASTEST_SPRINT
from mesa_mobility.results.reading.rows import ALONE, DUPLICATE, GAP, JUMP, Fault, Rows

JUMP_M = 0.25
"""How far a person may be from where they would be at their velocity, metres, and so much more as
``LARGEST_ACCELERATION`` explains. The largest such distance in five measured runs is 0.19 m."""
LARGEST_ACCELERATION = 10.0
"""m/s2: of a head, in a fall or a push."""


def sorted_once(rows: Rows) -> Rows:
    """The rows by (person, frame); of rows of one person and frame the first in the file."""
    order = np.lexsort((rows.frame, rows.person))
    person, frame = rows.person[order], rows.frame[order]
    again = np.zeros(len(order), dtype=np.bool_)
    again[1:] = (np.diff(person) == 0) & (np.diff(frame) == 0)
    faults = [
        Fault(
            DUPLICATE,
            f"person {person[row]} is twice in frame {frame[row]}: the first row counts",
            int(person[row]),
            int(frame[row]),
        )
        for row in np.flatnonzero(again)
    ]
    kept = order[~again]
    return replace(
        rows,
        person=rows.person[kept],
        frame=rows.frame[kept],
        x=rows.x[kept],
        y=rows.y[kept],
        heading=None if rows.heading is None else rows.heading[kept],
        z=None if rows.z is None else rows.z[kept],
        faults=(*rows.faults, *faults),
    )


def faults_of(rows: Rows, frame_rate: float) -> list[Fault]:
    """Gaps and jumps of rows in metres, sorted by (person, frame), and a person who is alone."""
    found = [*_gaps(rows), *_jumps(rows, frame_rate)]
    if rows.person[0] == rows.person[-1]:
        person, first, last = (int(n) for n in (rows.person[0], rows.frame[0], rows.frame[-1]))
        what = f"person {person} is the only one, in frames {first} to {last}"
        found.append(Fault(ALONE, what, person, first))
    return found


def _gaps(rows: Rows) -> list[Fault]:
    """Frames in which a person is missing between others."""
    steps = np.diff(rows.frame)
    same = np.diff(rows.person) == 0
    if not same.any():
        return []
    usual = np.median(steps[same])  # some files have every tenth frame alone
    return [
        Fault(
            GAP,
            f"person {rows.person[row]} is missing from frame {rows.frame[row] + 1} to "
            f"{rows.frame[row + 1] - 1}",
            int(rows.person[row]),
            int(rows.frame[row]),
        )
        for row in np.flatnonzero(same & (steps > usual))
    ]


def _jumps(rows: Rows, frame_rate: float) -> list[Fault]:
    """Steps that nobody takes."""
    return [
        Fault(
            JUMP,
            f"person {rows.person[row]} jumps by {length:.2f} m from frame {rows.frame[row]} to "
            f"{rows.frame[row + 1]}",
            int(rows.person[row]),
            int(rows.frame[row]),
        )
        for row, length in zip(*jumping(rows, frame_rate), strict=True)
    ]


def jumping(rows: Rows, frame_rate: float) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Rows after which a person jumps, and how far, metres.

    A step is a jump if it is faster than any sprint, or if it differs from both the step before and
    the step after by more than ``JUMP_M`` and ``LARGEST_ACCELERATION`` allow.
    """
    step = np.column_stack([np.diff(rows.x), np.diff(rows.y)])
    length = np.hypot(*step.T)
    same = np.diff(rows.person) == 0
    seconds = np.where(same, np.diff(rows.frame), 1) / frame_rate
    allowed = JUMP_M + LARGEST_ACCELERATION * seconds**2
    velocity = step / seconds[:, None]
    change = np.hypot(*np.diff(velocity, axis=0).T)
    # A step at an end of a track has one neighbour alone.
    before, after = np.full(len(step), np.inf), np.full(len(step), np.inf)
    joined = same[1:] & same[:-1]
    before[1:][joined] = change[joined]
    after[:-1][joined] = change[joined]
    odd = (before * seconds > allowed) & (after * seconds > allowed)
    odd &= np.isfinite(before) | np.isfinite(after)
    rows_found = np.flatnonzero(same & (odd | (length > FASTEST_SPRINT * seconds)))
    return rows_found, length[rows_found]
