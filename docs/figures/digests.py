"""What figures depend on, as digests that change with settings, maps and behaviour alone.

| part | covers |
|---|---|
| `preset` | settings of the preset `default`, its terms and its tactics; reference runs with it |
| `paper` | the same of the preset `paper` |
| `map` | the able-bodied map, its body and its preferred speeds |
| `types` | all maps of types that ship likewise; a reference run of people of many types |
| `stairs` | the maps for stairs that ship |
| `version` | the version of the package, for times and memory |

Tactics may be rewritten without a change of their settings, so short runs with a fixed seed are
part of the digest. Positions are rounded to 1 cm: processors and versions of libraries may differ
in the last bit of a sine or an exponential.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any

import numpy as np
from shapely import box

from docs.figures.manifest import FiguresError
from mesa_mobility import (
    Exit,
    FloorPlan,
    MobilityMap,
    PedestrianModel,
    PedestrianType,
    __version__,
)
from mesa_mobility.crowd import PRESETS
from mesa_mobility.populations import presets as populations

DIGITS = 12
"""Hexadecimal digits of a digest in the manifest and in pages."""

LOOKS = (2.0, 5.0, 10.0, 15.0, 20.0)
"""Seconds after which the positions of a reference run are taken."""


def digest_of(depends: Iterable[str]) -> str:
    """The digest of a figure that depends on some parts, as the code is now.

    Raises:
        FiguresError: there is no such part.
    """
    return _sha([[name, part(name)] for name in sorted(depends)])[:DIGITS]


@cache
def part(name: str) -> str:
    """The digest of one part."""
    if name not in PARTS:
        raise FiguresError(f"part {name!r} is unknown, expected one of {', '.join(PARTS)}")
    return _sha(PARTS[name]())


def _preset() -> list[Any]:
    from mesa_mobility.models import Doorway

    return [settings_of("default"), positions(Doorway(rng=1)), positions(both_ways())]


def _paper() -> list[Any]:
    from mesa_mobility.models import Doorway

    return [settings_of("paper"), positions(Doorway(preset="paper", rng=1))]


def _map() -> list[Any]:
    kind = PedestrianType(mobility_map=MobilityMap.load(None), name="able_bodied")
    return _type(kind)


def _types() -> list[Any]:
    from mesa_mobility.models import MixedEvacuation

    names = sorted(populations()["every_type"].shares)
    kinds = [_type(PedestrianType.named(name)) for name in names]
    return [kinds, positions(MixedEvacuation(rng=1))]


def _stairs() -> list[Any]:
    return [MobilityMap.named(f"able_bodied_{way}").digest for way in ("up", "down")]


PARTS: dict[str, Callable[[], list[Any]]] = {
    "preset": _preset,
    "paper": _paper,
    "map": _map,
    "types": _types,
    "stairs": _stairs,
    "version": lambda: [__version__],
}


def settings_of(preset: str) -> list[Any]:
    """All that a preset says, and the settings of its terms and tactics."""
    chosen = PRESETS[preset]
    behaviours = [*chosen.make_terms(), *chosen.make_tactics(), *chosen.make_group_paces()]
    numbers = chosen.numbers()
    del numbers["settings"]  # those of the behaviours, which follow
    return [
        numbers,
        chosen.make_target_choice().settings(),
        [[each.name, each.settings()] for each in behaviours],
    ]


def both_ways() -> PedestrianModel:
    """Two groups of 25 people meet in a corridor 5 m wide.

    They start on a lattice, as random places depend on the version of shapely.
    """
    exits = [Exit("east", (24.0, 0.0), (24.0, 5.0)), Exit("west", (0.0, 0.0), (0.0, 5.0))]
    model = PedestrianModel(FloorPlan(box(0.0, 0.0, 24.0, 5.0), exits=exits), rng=1)
    for start, leaves in ((4.0, "east"), (16.0, "west")):
        places = [(start + k, 0.52 + j) for k in range(5) for j in range(5)]
        model.add_pedestrians(places, exits=[leaves])
    return model


def positions(model: PedestrianModel) -> list[Any]:
    """Who is inside at some times, and where to 1 cm."""
    found: list[Any] = []
    for look in LOOKS:
        model.run(max_seconds=look)
        rows = model.rows
        places = np.column_stack([model.crowd.x[rows], model.crowd.y[rows]])
        found.append([rows.tolist(), np.rint(100.0 * places).astype(int).tolist()])
    return found


def _type(kind: PedestrianType) -> list[Any]:
    return [kind.name, kind.mobility_map.digest, repr(kind.preferred_speed), repr(kind.core_radius)]


def _sha(value: list[Any]) -> str:
    text = json.dumps(value, sort_keys=True, default=repr)
    return hashlib.sha256(text.encode()).hexdigest()
