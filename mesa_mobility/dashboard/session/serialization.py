"""Data for the browser: numbers as base64, mostly of float32, all else as JSON."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from mesa_mobility import Building, FloorPlan, PedestrianModel
from mesa_mobility.animation.floor import drawn_floor, drawn_opening, drawn_refuge, ring
from mesa_mobility.crowd.lifts.rides import Rides
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.running.trace import Places, Traced
from mesa_mobility.dashboard.session.bodies import Bodies
from mesa_mobility.dashboard.session.colouring import Colouring
from mesa_mobility.dashboard.session.observer import Observer
from mesa_mobility.dashboard.session.storeys import drawn_joints, own_openings, storeys

LEAST_STEP = 0.001
"""Metres to which places between two frames are told, on plans up to 65 m wide."""


def packed(values: ArrayLike) -> str:
    """Numbers as base64 of little-endian float32, rows one after the other."""
    # Beyond 3e38, as a behaviour may charge for what nobody shall do, they are infinite.
    with np.errstate(over="ignore"):
        flat = np.ascontiguousarray(values, dtype="<f4")
    return _base64(flat)


def _base64(flat: NDArray[Any]) -> str:
    return base64.b64encode(flat.tobytes()).decode("ascii")


def frame(
    model: PedestrianModel,
    colouring: Colouring,
    observer: Observer,
    *,
    run: int,
    number: int,
    since: int = -1,
    bodies: Bodies | None = None,
) -> dict[str, Any]:
    """The crowd as the canvas draws it.

    ``people`` holds six numbers each: row, x, y, heading, the value that gives the colour, and how
    far the car of a lift has carried the person from the floor on which it is drawn, metres.
    Float32 holds rows up to 16 million, and places on a plan 1 km wide to 0.1 mm. ``passed`` has
    what ``Observer.passed`` tells, and ``between`` what ``steps_between`` makes of the time after
    the frame ``since``.

    Args:
        model: the model.
        colouring: what the value is.
        observer: what has been counted of the model.
        run: changes when time starts anew.
        number: of this frame.
        since: last frame of the model that the page has got, or -1. The trace forgets the places
            until then.
        bodies: adds ``bodies``, the poses in the three-dimensional view.
    """
    rows, crowd = model.rows, model.crowd
    people = np.empty((len(rows), 6), dtype="<f4")
    people[:, 0] = rows
    people[:, 1] = crowd.x[rows]
    people[:, 2] = crowd.y[rows]
    # Within one round: a heading that has wound up keeps its precision.
    people[:, 3] = np.remainder(crowd.heading[rows], 2.0 * np.pi)
    people[:, 4] = colouring.values(model, observer)
    points = np.column_stack([crowd.x[rows], crowd.y[rows]])
    people[:, 5] = model.lifts.log.risen(np.full(len(rows), model.frame), points)
    observer.trace.drop(since)
    posed = {} if bodies is None else {"bodies": packed(bodies.now())}
    return {
        **posed,
        "run": run,
        "number": number,
        "elapsed": model.elapsed,
        "inside": model.inside,
        "people": packed(people),
        "legend": colouring.legend(model),
        "passed": observer.passed((since + 0.5) * FRAME_SECONDS),
        "between": steps_between(observer.trace.until(model.frame), model.lifts.log),
    }


def steps_between(traced: Traced, rides: Rides) -> dict[str, Any]:
    """Where people have been between two frames, compactly.

    ``frames`` and ``counts`` are lists with the frame of each sample and the number of people in
    it. ``rows`` has the row of each (int32), and ``places`` three numbers (uint16) each: x and y in
    steps of ``step`` metres from ``origin``, and the heading in 65536ths of a round. A step is 1 mm
    on plans up to 65 m wide, and 15 mm on 1 km. ``risen`` has the metres by which lifts have
    carried them (float32), and is empty where none has. ``came`` and ``left`` hold six numbers
    (float32) for everybody who has come or left: row, frame, x, y, heading and the metres carried.
    """
    inside, risen = traced.inside, _risen(traced.inside, rides)
    # Column by column, which is many times as fast as along the axis of an array.
    origin = [float(each.min()) if len(inside) else 0.0 for each in (inside.x, inside.y)]
    extent = max(float(np.ptp(each)) if len(inside) else 0.0 for each in (inside.x, inside.y))
    step = max(LEAST_STEP, extent / 65535)
    places = np.empty((len(inside), 3), dtype="<u2")
    for k, each in enumerate((inside.x, inside.y)):
        places[:, k] = np.rint((each - origin[k]) / step)
    places[:, 2] = np.rint(inside.heading * (65536 / (2.0 * np.pi))).astype(np.int64) & 0xFFFF
    return {
        "frames": traced.frames,
        "counts": traced.counts,
        "rows": _base64(inside.person.astype("<i4")),
        "places": _base64(places),
        "risen": packed(risen) if risen.any() else "",
        "origin": origin,
        "step": step,
        "came": packed(_passages(traced.came, rides)),
        "left": packed(_passages(traced.left, rides)),
    }


def _risen(places: Places, rides: Rides) -> NDArray[np.float64]:
    return rides.risen(places.frame, np.column_stack([places.x, places.y]))


def _passages(places: Places, rides: Rides) -> NDArray[np.float64]:
    """(n, 6)"""
    turned = np.remainder(places.heading, 2.0 * np.pi)
    columns = (places.person, places.frame, places.x, places.y, turned, _risen(places, rides))
    return np.column_stack(columns)


def floor(
    plan: FloorPlan,
    obstacles: Sequence[tuple[shapely.Polygon, bool]] = (),
    building: Building | None = None,
) -> dict[str, Any]:
    """A floor plan as the canvas draws it: rings and lines, metres.

    Args:
        plan: the plan.
        obstacles: those that a click takes away or brings back, and whether each is there now.
        building: adds its ``storeys`` and ``refuges``. Its stairs and lifts are openings, with
            their own names.
    """
    several: dict[str, Any] = {}
    if building is not None:
        several["storeys"] = storeys(building)
        own = own_openings(plan, building)
        several["openings"] = [drawn_opening(each, plan.is_open(each.name)) for each in own]
        several["openings"] += drawn_joints(building)
        several["refuges"] = [drawn_refuge(refuge) for refuge in building.refuges]
    return {
        **drawn_floor(plan),
        **several,
        "obstacles": [
            {"number": number, "ring": ring(polygon.exterior), "there": there}
            for number, (polygon, there) in enumerate(obstacles)
        ],
    }
