"""Recording of positions and headings, frame by frame, and of decisions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.repertoire import within_maps
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.scene import Scene
from mesa_mobility.crowd.state.records import FARTHEST, LAST_FRAME, Crowd
from mesa_mobility.schema import Array, Each, Either, Kind


class Recorder(Saved):
    """Keeps position and heading of everybody inside, one block of arrays a frame.

    Args:
        fields: types of the fields that the model declares for its people.
    """

    def __init__(self, fields: Mapping[str, np.dtype[Any]] | None = None) -> None:
        self._blocks: list[tuple[NDArray[np.generic], ...]] = []
        self._fields = dict(fields or {})

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {
            "frame": Array("i4", ("rows",), 0, LAST_FRAME),
            "person": Array("i4", ("rows",), 0, below="people"),
            **dict.fromkeys(("x", "y", "heading"), Array("f8", ("rows",), -FARTHEST, FARTHEST)),
            **{
                name: Array(kind.str, ("rows",), infinite=True, missing=True)
                for name, kind in self._fields.items()
            },
        }

    def state(self) -> dict[str, Any]:
        """All that has been recorded."""
        return self.arrays()

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        self._blocks = _by_frame(state[name] for name in self.members())

    def add(self, frame: int, rows: NDArray[np.int64], state: Crowd) -> None:
        """Keep the people in ``rows`` at ``frame``."""
        self._blocks.append(
            (
                np.full(len(rows), frame, dtype=np.int32),
                rows.astype(np.int32),
                state.x[rows],
                state.y[rows],
                state.heading[rows],
                *(values[rows] for values in state.fields.values()),
            )
        )

    def arrays(self, since: int = 0) -> dict[str, NDArray[np.generic]]:
        """What was recorded from frame ``since`` on, in order of time.

        Returns:
            Arrays (n,) with an entry for each person and frame: ``frame``; ``person``; ``x`` and
            ``y``, metres; ``heading``, radians; and each field that the model declares for its
            people.
        """
        names = ("frame", "person", "x", "y", "heading", *self._fields)
        blocks = _since(self._blocks, since)
        if not blocks:
            kinds: list[Any] = [np.int32, np.int32, *[np.float64] * 3, *self._fields.values()]
            return {name: np.empty(0, kind) for name, kind in zip(names, kinds, strict=True)}
        columns = zip(*blocks, strict=True)
        return {name: np.concatenate(c) for name, c in zip(names, columns, strict=True)}


class DecisionRecorder(Saved):
    """Keeps who has taken which option, one block of arrays for each frame with decisions."""

    def __init__(self) -> None:
        self._blocks: list[tuple[NDArray[Any], ...]] = []

    def state(self) -> dict[str, Any]:
        """All that has been recorded."""
        columns = [np.concatenate(each) for each in zip(*self._blocks, strict=True)]
        return {"columns": columns}

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        numbers = [("people", 0), ("types", 0), ("options", -2)]
        columns = [Array("i4", ("rows",), low, below=size) for size, low in numbers]
        frames = Array("i4", ("rows",), 0, LAST_FRAME)
        return {"columns": Either(Each(of=list), Each(frames, *columns, of=list))}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        self._blocks = _by_frame(state["columns"]) if state["columns"] else []

    def add(self, frame: int, rows: NDArray[np.int64], state: Crowd) -> None:
        """Keep what the people in ``rows``, who have decided at ``frame``, are doing now."""
        self._blocks.append(
            (
                np.full(len(rows), frame, dtype=np.int32),
                rows.astype(np.int32),
                state.type_index[rows].astype(np.int32),
                state.option[rows],
            )
        )

    def arrays(self, scene: Scene, since: int = 0) -> dict[str, NDArray[np.generic]]:
        """What was decided from frame ``since`` on, in order of time.

        Args:
            scene: the model's, with the options from which people chose.
            since: first frame.

        Returns:
            Arrays (n,) with an entry for each of n decisions: ``frame``; ``person``;
            ``type_index`` of the person's type; ``option``, a row of the type's maps, one after the
            other, or -2 for the fallback; ``share``, the part of the option's length that is
            walked, 0 to 1; less than 1 for shortened options.
        """
        names = ("frame", "person", "type_index", "option")
        columns = [np.concatenate(each) for each in zip(*_since(self._blocks, since), strict=True)]
        found = dict(zip(names, columns or [np.empty(0, np.int32)] * 4, strict=True))
        return _in_maps(found, scene)


def movements_under_way(
    crowd: Crowd, rows: NDArray[np.int64], scene: Scene
) -> dict[str, NDArray[np.generic]]:
    """What the people in ``rows`` are doing now, as arrays like ``DecisionRecorder.arrays``.

    ``frame`` is when each movement began.
    """
    found = {
        "frame": crowd.start[rows],
        "person": rows.astype(np.int32),
        "type_index": crowd.type_index[rows].astype(np.int32),
        "option": crowd.option[rows],
    }
    return _in_maps(found, scene)


def _in_maps(found: dict[str, NDArray[Any]], scene: Scene) -> dict[str, NDArray[np.generic]]:
    """These arrays with rows of the types' maps as options, and with the ``share`` of each."""
    option, share = found["option"].copy(), np.ones(len(found["option"]), dtype=np.float32)
    chosen = np.flatnonzero(option >= 0)
    numbers, rows = within_maps(option[chosen], scene.repertoire.first_option)
    for number, capability in enumerate(scene.repertoire.capabilities):
        own, parts = chosen[numbers == number], capability.parts
        firsts = scene.grounds.known.first_rows[found["type_index"][own], number]
        option[own] = firsts + parts.rows[rows[numbers == number]]
        share[own] = parts.share[rows[numbers == number]]
    return {**found, "option": option, "share": share}


def _by_frame(columns: Iterable[NDArray[Any]]) -> list[tuple[NDArray[Any], ...]]:
    """Columns as a block for each frame; the first column holds the frames, in order of time."""
    frames, *others = columns
    ends = np.flatnonzero(np.diff(frames)) + 1
    return list(zip(*(np.split(each, ends) for each in (frames, *others)), strict=True))


def _since(blocks: list[tuple[NDArray[Any], ...]], frame: int) -> list[tuple[NDArray[Any], ...]]:
    """The blocks that begin in ``frame`` or later; ``blocks`` are in order of time."""
    first = len(blocks)
    while first > 0 and (not len(blocks[first - 1][0]) or blocks[first - 1][0][0] >= frame):
        first -= 1
    return blocks[first:]
