"""A run's people as moving figures in files: glTF, OpenUSD, BVH, films."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesa_mobility._lazy import names_of

if TYPE_CHECKING:
    from mesa_mobility.animation.bvh import write_bvh as write_bvh
    from mesa_mobility.animation.film import write_film as write_film
    from mesa_mobility.animation.gltf import write_glb as write_glb
    from mesa_mobility.animation.page import write_page as write_page
    from mesa_mobility.animation.people import walkers as walkers
    from mesa_mobility.animation.usd import write_usd as write_usd
    from mesa_mobility.results.excerpts import Selection as Selection

__getattr__, __dir__ = names_of(__name__, __file__)
