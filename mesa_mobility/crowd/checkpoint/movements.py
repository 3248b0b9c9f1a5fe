"""Whether the movements in a checkpoint are ones that this model could have committed.

A record holds a movement more than once: its option, both ends, duration, bounding box and speed.
The engine trusts that they agree.  Here each follows from the others, computed apart from the
kernels that wrote it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mesa_mobility.crowd.options.repertoire import within_maps
from mesa_mobility.crowd.options.table import FRAME_SECONDS, SAMPLE_FRAMES
from mesa_mobility.crowd.planning.fallback import FALLBACK_FRAMES
from mesa_mobility.crowd.scene import Scene
from mesa_mobility.crowd.state.advance import LONG_AFTER
from mesa_mobility.crowd.state.departed import WALKS_ON
from mesa_mobility.crowd.state.records import FALLBACK, NO_OPTION
from mesa_mobility.errors import ContentError

_ROUNDING = 1e-5
"""Metres, radians and m/s by which numbers that are computed twice may differ."""

_TOUCHING = 1e-3
"""Metres by which bodies may overlap: collisions are tested at samples of paths."""

_OFF = 0.02
"""Metres off the edge of the floor at which people may cross an exit."""

Records = NDArray[np.void]


def check_movements(
    scene: Scene, inside: NDArray[np.int64], state: Mapping[str, Any], frame: int
) -> None:
    """Check what all people do and where those inside are.

    Args:
        scene: the floor and what people can do on it, with the records.
        inside: rows of those inside, ascending.
        state: the state of the population.
        frame: now.

    Raises:
        ContentError: naming the first person and the field that does not agree with the others.
    """
    people = np.asarray(scene.crowd.records[: state["count"]])
    departed = state["departed"]["rows"]
    if not (
        np.array_equal(np.flatnonzero(people["active"]), inside)
        and np.array_equal(state["rows"], inside)
    ):
        raise ContentError("population, present: expected all who are active, and nobody else")
    if people["active"][departed].any():
        raise ContentError("population, departed: expected people who have left")
    _check_options(people, scene)
    _check_ends(people, scene)
    _check_times(people, frame)
    path = _waypoints(people, scene)
    _check_path(people, path)
    under_way = np.concatenate([inside, _walked_on(people, departed)])
    _check_now(people[under_way], under_way, path[under_way], frame)
    _check_floor(people[inside], inside, path[inside], scene, frame)
    if scene.rules.hard_bodies:
        _check_room(people[inside], inside)


def check_next(scene: Scene, inside: NDArray[np.int64], frame: int, following: int) -> None:
    """Raise ContentError if a movement of those inside ends before the next event."""
    people = scene.crowd.records[inside]
    ends = np.where(people["gone"] > frame, people["gone"], people["end"]).astype(np.int64)
    if following > ends.min(initial=LONG_AFTER):
        raise ContentError(f"dynamics, next: got {following}, expected at most {ends.min()}")


def check_choices(types: NDArray[np.integer], options: NDArray[np.integer], scene: Scene) -> None:
    """Raise ContentError unless options are of maps of the people's types, or none."""
    own = (options < 0) | _of_types(types, options, scene.repertoire.first_option, scene)
    _check(own, np.arange(len(own)), "option", options, "one of the type of the person")


def _of_types(
    types: NDArray[np.integer],
    numbers: NDArray[np.integer],
    firsts: NDArray[np.integer],
    scene: Scene,
) -> NDArray[np.bool_]:
    """(n,) whether (n,) numbers of options or clusters are of maps of the people's types."""
    found: NDArray[np.bool_] = (
        scene.grounds.known.first_rows[types, within_maps(numbers, firsts)[0]] >= 0
    )
    return found


def _check_options(people: Records, scene: Scene) -> None:
    kinds, rows = people["type_index"], np.arange(len(people))
    check_choices(kinds, people["option"], scene)
    own = _of_types(kinds, people["cluster"], scene.repertoire.first_cluster, scene)
    _check(own, rows, "cluster", people["cluster"], "one of the type of the person")
    bodies = scene.environment.bodies
    body = np.array([scene.environment.body(k) for k in range(len(scene.types))])
    fits = people["destination"] % bodies == body[kinds]
    _check(fits, rows, "destination", people["destination"], "one for the width of the person")
    least = np.array([kind.least_core for kind in scene.types])[kinds]
    most = np.array([kind.half_width for kind in scene.types])[kinds]
    fits = (people["core"] >= least - 1e-9) & (people["core"] <= most + 1e-9)
    _check(fits, rows, "core", people["core"], "a radius of the type of the person")


def _along_option(people: Records) -> NDArray[np.bool_]:
    """(n,) who moves along an option; the others stand or go straight."""
    return (people["option"] >= 0) & (people["spacing"] == SAMPLE_FRAMES)


def _walked_on(people: Records, departed: NDArray[np.int64]) -> NDArray[np.int64]:
    """Rows of the people who have left and have a movement beyond the exit."""
    return departed[people["spacing"][departed] == WALKS_ON]


def _check_ends(people: Records, scene: Scene) -> None:
    """Where and in which pose movements along options end."""
    rows = np.flatnonzero(_along_option(people))
    own, table = people[rows], scene.repertoire.table
    kinds = table.options[own["option"]]
    pieces = kinds["frames"].astype(np.int64) // SAMPLE_FRAMES
    _check(own["knots"] == pieces + 1, rows, "knots", own["knots"], "those of the option")
    _check(own["cluster"] == kinds["cluster"], rows, "cluster", own["cluster"], "the option's")
    x, y, turn = table.path[own["option"], :, pieces].T
    c, s = own["from_c"], own["from_s"]
    for name, value in (
        ("from_c", np.cos(own["from_heading"])),
        ("from_s", np.sin(own["from_heading"])),
        ("to_x", own["from_x"] + c * x - s * y),
        ("to_y", own["from_y"] + s * x + c * y),
        ("to_heading", own["from_heading"] + turn),
    ):
        _check_near(own[name], value, rows, name)
    rest = ~_along_option(people)
    there = people["active"] & (people["option"] >= 0)
    everybody = np.arange(len(people))
    _check(~(rest & there), everybody, "spacing", people["spacing"], f"{SAMPLE_FRAMES}")
    _check(~rest | (people["knots"] <= 2), everybody, "knots", people["knots"], "1 or 2")
    falls = people["active"] & (people["option"] == FALLBACK)
    fits = ~falls | (people["spacing"] == FALLBACK_FRAMES)
    _check(fits, everybody, "spacing", people["spacing"], f"{FALLBACK_FRAMES}")


def _check_times(people: Records, frame: int) -> None:
    rows, here = np.arange(len(people)), people["active"]
    end = people["start"] + (people["knots"].astype(np.int64) - 1) * people["spacing"]
    _check(people["end"] == end, rows, "end", people["end"], "start and duration together")
    _check(~here | (people["start"] <= frame), rows, "start", people["start"], "no later than now")
    _check(~here | (people["end"] >= frame), rows, "end", people["end"], "no earlier than now")
    gone = people["gone"]
    leaves = (gone > frame) & (gone <= people["end"])
    _check(~here | (gone == -1) | leaves, rows, "gone", gone, "-1, or later, before the end")


def _waypoints(people: Records, scene: Scene) -> NDArray[np.float64]:
    """(n, 16, 3) x, y, heading at the knots of movements; the end is repeated."""
    along = _along_option(people)
    own = scene.repertoire.table.path[np.where(along, people["option"], 0)].astype(np.float64)
    own[~along] = 0.0
    c, s = people["from_c"][:, None], people["from_s"][:, None]
    path = np.stack(
        [
            people["from_x"][:, None] + c * own[:, 0] - s * own[:, 1],
            people["from_y"][:, None] + s * own[:, 0] + c * own[:, 1],
            people["from_heading"][:, None] + own[:, 2],
        ],
        axis=2,
    )
    over = np.arange(path.shape[1]) >= people["knots"][:, None] - 1
    ends = np.column_stack([people["to_x"], people["to_y"], people["to_heading"]])
    return np.where(over[:, :, None], ends[:, None], path)


def _check_path(people: Records, path: NDArray[np.float64]) -> None:
    """What is kept of the whole path: its box, longest step and mean velocity."""
    rows = np.arange(len(people))
    stands = (people["knots"] == 1) | (people["active"] & (people["option"] == NO_OPTION))
    from_ = np.column_stack([people["from_x"], people["from_y"]])
    to = np.column_stack([people["to_x"], people["to_y"]])
    moved = np.abs(to - from_).max(axis=1, initial=0.0)
    _check(~stands | (moved <= _ROUNDING), rows, "to_x", people["to_x"], "from_x")
    ground = np.concatenate([from_[:, None], path[:, 1:, :2]], axis=1)
    box = np.concatenate([ground.min(axis=1), ground.max(axis=1)], axis=1)
    for side in range(4):
        _check_near(people["box"][:, side], box[:, side], rows, f"box[{side}]")
    seconds = np.maximum(people["knots"] - 1.0, 1.0) * people["spacing"] * FRAME_SECONDS
    # Those who came in moving have a velocity before their first movement.
    came = (people["knots"] == 1) & (people["start"] == people["end"])
    for axis, name in enumerate(("vx", "vy")):
        moved = (to - from_)[:, axis] / seconds
        _check_near(people[name], np.where(came, people[name], moved), rows, name)
    step = np.linalg.norm(np.diff(ground, axis=1), axis=2).max(axis=1, initial=0.0)
    stride = step * SAMPLE_FRAMES / people["spacing"]
    _check_near(people["stride"], stride, rows, "stride")


def _poses(people: Records, path: NDArray[np.float64], frame: Any) -> NDArray[np.float64]:
    """(n, 3) x, y, heading at a frame, or at (n,) frames."""
    last = people["knots"] - 1
    u = (frame - people["start"]) / people["spacing"]
    k = np.clip(u.astype(np.int64), 0, np.maximum(last - 1, 0))
    rows, share = np.arange(len(people)), np.clip(u - k, 0.0, 1.0)[:, None]
    return path[rows, k] * (1.0 - share) + path[rows, np.minimum(k + 1, last)] * share


def _check_now(
    people: Records, rows: NDArray[np.int64], path: NDArray[np.float64], frame: int
) -> None:
    now = _poses(people, path, frame)
    names = ("x", "y", "heading")
    for axis, name in enumerate(names):
        checked = people["active"] | (name != "heading")
        _check_near(np.where(checked, people[name], now[:, axis]), now[:, axis], rows, name)


def _check_floor(
    people: Records, rows: NDArray[np.int64], path: NDArray[np.float64], scene: Scene, frame: int
) -> None:
    """Where people are now and will be, until they leave."""
    last = np.where(people["gone"] >= 0, people["gone"] - 1, people["end"])
    moves = (people["vx"] != 0.0) | (people["vy"] != 0.0) | (people["stride"] > 0.0)
    area, k = scene.plan.free, 0
    while True:
        at = np.flatnonzero((last >= frame + k) & (moves | (k == 0)))
        if not len(at):
            return
        places = _poses(people[at], path[at], frame + k)[:, :2]
        off = ~scene.plan.contains(places)
        if off.any():
            away = shapely.distance(area, shapely.points(places[off]))
            if away.max() > _OFF:
                person = int(rows[at[np.flatnonzero(off)[np.argmax(away)]]])
                raise ContentError(
                    f"population, pedestrian {person}: is off the floor at frame {frame + k}, "
                    "expected a place on it"
                )
        k += 1


def _check_room(people: Records, rows: NDArray[np.int64]) -> None:
    """Bodies do not overlap now."""
    places, radii = np.column_stack([people["x"], people["y"]]), people["core"]
    if len(people) < 2:
        return
    pairs = cKDTree(places).query_pairs(2.0 * radii.max(), output_type="ndarray")
    one, other = pairs.T
    gap = np.linalg.norm(places[one] - places[other], axis=1) - radii[one] - radii[other]
    hit = gap < -_TOUCHING
    if hit.any():
        k = int(np.argmax(hit))
        raise ContentError(
            f"population, pedestrians {rows[one[k]]} and {rows[other[k]]}: overlap by "
            f"{-gap[k]:.3f} m, expected room for both bodies"
        )


def _check_near(found: Any, expected: Any, rows: NDArray[np.int64], name: str) -> None:
    with np.errstate(invalid="ignore"):
        near = np.abs(found - expected) <= _ROUNDING * (1.0 + np.abs(expected) * 1e-6)
    _check(near, rows, name, found, "what its movement says")


def _check(
    fits: NDArray[np.bool_], rows: NDArray[np.int64], name: str, found: Any, expected: str
) -> None:
    if not fits.all():
        k = int(np.argmin(fits))
        raise ContentError(
            f"population, pedestrian {rows[k]}: {name} is {found[k]}, expected {expected}"
        )
