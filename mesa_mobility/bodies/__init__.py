"""Bodies: the full-body poses behind movement options, and people who move through them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesa_mobility._lazy import names_of

if TYPE_CHECKING:
    from mesa_mobility.bodies.bank import PoseBank as PoseBank
    from mesa_mobility.bodies.building import build_bank as build_bank
    from mesa_mobility.bodies.joining import bank_of_maps as bank_of_maps
    from mesa_mobility.bodies.motion import BodyMotion as BodyMotion
    from mesa_mobility.bodies.motion import body_motion as body_motion
    from mesa_mobility.bodies.quality import BodyQuality as BodyQuality
    from mesa_mobility.bodies.quality import quality as quality
    from mesa_mobility.bodies.sequence import Movements as Movements

__getattr__, __dir__ = names_of(__name__, __file__)
