"""Data for the browser: numbers as base64 of float32, all else as JSON."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike

from mesa_mobility import Building, FloorPlan, PedestrianModel
from mesa_mobility.animation.floor import drawn_floor, drawn_opening, drawn_refuge, ring
from mesa_mobility.dashboard.session.bodies import Bodies
from mesa_mobility.dashboard.session.colouring import Colouring
from mesa_mobility.dashboard.session.observer import Observer
from mesa_mobility.dashboard.session.storeys import drawn_joints, own_openings, storeys


def packed(values: ArrayLike) -> str:
    """Numbers as base64 of little-endian float32, rows one after the other."""
    # Beyond 3e38, as a behaviour may charge for what nobody shall do, they are infinite.
    with np.errstate(over="ignore"):
        flat = np.ascontiguousarray(values, dtype="<f4")
    return base64.b64encode(flat.tobytes()).decode("ascii")


def frame(
    model: PedestrianModel,
    colouring: Colouring,
    observer: Observer,
    *,
    run: int,
    number: int,
    bodies: Bodies | None = None,
) -> dict[str, Any]:
    """The crowd as the canvas draws it.

    ``people`` holds six numbers each: row, x, y, heading, the value that gives the colour, and how
    far the car of a lift has carried the person from the floor on which it is drawn, metres.
    Float32 holds rows up to 16 million, and places on a plan 1 km wide to 0.1 mm. ``passed`` has
    name and net passages of each door and exit through which somebody has gone.

    Args:
        model: the model.
        colouring: what the value is.
        observer: what has been counted of the model.
        run: changes when time starts anew.
        number: of this frame.
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
    posed = {} if bodies is None else {"bodies": packed(bodies.now())}
    return {
        **posed,
        "run": run,
        "number": number,
        "elapsed": model.elapsed,
        "inside": model.inside,
        "people": packed(people),
        "legend": colouring.legend(model),
        "passed": observer.passed(),
    }


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
