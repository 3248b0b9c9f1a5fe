"""Checks of the columns of trajectories."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.errors import ResultsError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int32]

COLUMNS = ("frame", "person", "x", "y", "heading")


def checked_columns(
    given: Mapping[str, ArrayLike], fields: Mapping[str, ArrayLike]
) -> dict[str, NDArray[Any]]:
    """The columns and the fields of trajectories, sorted by (frame, person) and read-only.

    Args:
        given: (n,) values of each of ``COLUMNS``.
        fields: (n,) values of each field.

    Raises:
        ResultsError: values that are no column, a field named as a column is, columns of unequal
            length, or a person twice in a frame.
    """
    columns: dict[str, NDArray[Any]] = {
        **{name: whole_numbers(name, given[name]) for name in COLUMNS[:2]},
        **{name: real_numbers(name, given[name]) for name in COLUMNS[2:]},
    }
    own = {name: one_dimensional(name, values) for name, values in fields.items()}
    taken = columns.keys() & own.keys()
    if taken:
        raise ResultsError(f"trajectories: a field is named {min(taken)!r}, as a column is")
    columns |= own
    lengths = {name: len(values) for name, values in columns.items()}
    if len(set(lengths.values())) != 1:
        raise ResultsError(f"trajectories: columns of unequal length: {lengths}")
    return {name: read_only(values) for name, values in in_order(columns).items()}


def whole_numbers(name: str, values: ArrayLike) -> NDArray[np.int32]:
    """(n,) whole numbers, 0 or more.

    Raises:
        ResultsError: another shape, other numbers, or larger ones than 32 bits hold.
    """
    array = one_dimensional(name, values)
    if array.size and not np.issubdtype(array.dtype, np.integer):
        raise ResultsError(f"trajectories: {name} holds {array.dtype}, expected whole numbers")
    if array.size and (array.min() < 0 or array.max() > np.iinfo(np.int32).max):
        raise ResultsError(
            f"trajectories: {name} runs from {array.min()} to {array.max()}, expected 0 or more"
        )
    return np.ascontiguousarray(array, dtype=np.int32)


def real_numbers(name: str, values: ArrayLike) -> FloatArray:
    """(n,) finite numbers.

    Raises:
        ResultsError: another shape, or a number that is not finite.
    """
    array = np.ascontiguousarray(one_dimensional(name, values), dtype=np.float64)
    wrong = np.flatnonzero(~np.isfinite(array))
    if len(wrong):
        raise ResultsError(
            f"trajectories: {name} of row {wrong[0]} is {array[wrong[0]]}, expected a number"
        )
    return array


def one_dimensional(name: str, values: ArrayLike) -> NDArray[Any]:
    """(n,) values of any type.

    Raises:
        ResultsError: another shape.
    """
    array = np.asarray(values)
    if array.ndim != 1:
        raise ResultsError(f"trajectories: {name} has shape {array.shape}, expected (n,)")
    return array


def in_order(columns: dict[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """The columns, their rows sorted by (frame, person).

    Raises:
        ResultsError: a person is twice in a frame.
    """
    # One 64-bit key for a row makes both the check and the sort a single pass.
    key = (columns["frame"].astype(np.int64) << 32) | columns["person"]
    if np.any(np.diff(key) <= 0):
        order = np.argsort(key, kind="stable")
        columns = {name: values[order] for name, values in columns.items()}
        twice = np.flatnonzero(np.diff(key[order]) == 0)
        if len(twice):
            row = int(twice[0])
            raise ResultsError(
                f"trajectories: person {columns['person'][row]} is twice in frame "
                f"{columns['frame'][row]}"
            )
    return columns


def radii_of(value: ArrayLike, person: IntArray) -> FloatArray:
    """(m,) core radius by person, metres, of one for everybody or one for each.

    Raises:
        ResultsError: too few of them, or one that is not positive.
    """
    people = int(person.max()) + 1 if len(person) else 0
    radii = np.asarray(value, dtype=np.float64)
    if radii.ndim == 0:
        radii = np.full(people, float(radii))
    if radii.ndim != 1 or len(radii) < people:
        raise ResultsError(
            f"trajectories: core_radius has shape {radii.shape}, expected one for each of "
            f"{people} people"
        )
    if not np.all((radii > 0) & np.isfinite(radii)):
        raise ResultsError("trajectories: core_radius must be positive for everybody")
    return read_only(radii)


def last_frame_of(given: int | None, frame: IntArray) -> int:
    """The last frame that was simulated; that of the last row where none is given.

    Raises:
        ResultsError: the frame given is before the last row, or more than 32 bits hold.
    """
    last = int(frame[-1]) if len(frame) else 0
    if given is None:
        return last
    if given < last:
        raise ResultsError(
            f"trajectories: last_frame is {given}, but there are rows of frame {last}"
        )
    if given > np.iinfo(np.int32).max:
        raise ResultsError(
            f"trajectories: last_frame is {given}, expected at most {np.iinfo(np.int32).max}"
        )
    return given


def remaining_of(given: ArrayLike | None, present: IntArray, last_frame: int) -> IntArray:
    """The people still inside in the last frame; all who have a row in it where none are given.

    Args:
        given: (k,) their numbers, or None.
        present: those who have a row in the last frame.
        last_frame: its number.

    Raises:
        ResultsError: somebody without a row in it.
    """
    inside = np.unique(whole_numbers("inside_at_end", present if given is None else given))
    absent = np.setdiff1d(inside, present)
    if len(absent):
        raise ResultsError(
            f"trajectories: person {absent[0]} is said to be inside at the end, but has no "
            f"row in frame {last_frame}"
        )
    return read_only(inside)


DATA_KINDS = "Uifb"
"""What data of people may be: texts, whole numbers, numbers, and whether something is so."""


def checked_person_data(
    data: Mapping[str, ArrayLike], person: IntArray, fields: Collection[str] = ()
) -> Mapping[str, NDArray[Any]]:
    """Data of people as read-only arrays, with an entry for each person.

    Raises:
        ResultsError: a name that is a column already, too few entries, or neither texts nor
            numbers.
    """
    people = int(person.max()) + 1 if len(person) else 0
    found = {}
    for name, values in data.items():
        array = np.asarray(values)
        if name in COLUMNS or name in fields or not name.isidentifier():
            raise ResultsError(f"trajectories: person_data {name!r}, expected a name of its own")
        if array.ndim != 1 or len(array) < people or array.dtype.kind not in DATA_KINDS:
            raise ResultsError(
                f"trajectories: person_data {name!r} has {array.dtype} in shape {array.shape}, "
                f"expected texts or numbers for each of {people} people"
            )
        found[name] = read_only(array)
    return found


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    """The array, not to be changed through what is returned."""
    # A view, so that the caller's own array stays writable.
    view = array.view()
    view.flags.writeable = False
    return view
