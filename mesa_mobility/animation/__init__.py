"""A run's people as moving figures in files: glTF, OpenUSD, BVH, films."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesa_mobility._lazy import names_of

if TYPE_CHECKING:
    from mesa_mobility.animation.bvh import write_bvh
    from mesa_mobility.animation.film import write_film
    from mesa_mobility.animation.gltf import write_glb
    from mesa_mobility.animation.page import write_page
    from mesa_mobility.animation.people import walkers
    from mesa_mobility.animation.usd import write_usd
    from mesa_mobility.results.excerpts import Selection

_MODULES = {
    "Selection": "people",
    "walkers": "people",
    "write_bvh": "bvh",
    "write_film": "film",
    "write_glb": "gltf",
    "write_page": "page",
    "write_usd": "usd",
}

__all__ = [
    "Selection",
    "walkers",
    "write_bvh",
    "write_film",
    "write_glb",
    "write_page",
    "write_usd",
]

__getattr__, __dir__ = names_of(__name__, _MODULES)
