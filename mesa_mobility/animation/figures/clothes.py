"""Clothes, and the colours of skin and hair: a few sober varieties."""

from __future__ import annotations

PARTS = ("top", "forearm", "trousers", "skin", "hair", "shoes", "aid")
"""Parts of a figure that have a colour each."""

_TOPS = (
    "#2f3e56", "#8a8d91", "#6d3540", "#59614a", "#d9d7d0", "#4f6d8f",
    "#3c4046", "#a98544", "#3d6b6b", "#b9b0a0", "#93563f", "#5d4661",
)  # fmt: skip
_TROUSERS = ("#2b2f38", "#3b4a63", "#5a5347", "#77716a", "#1f2226")
_SKIN = ("#ecc8a8", "#8d5d40", "#d9a681", "#5f3d29", "#c08a63")
_HAIR = ("#2a211c", "#15120f", "#5c422d", "#1b1613", "#8f8d8a", "#3d2b1f", "#a98555")
_SHOES = ("#23211f", "#3d3027", "#2c2f35")
_AID = "#42454a"

LOOKS = 24
"""How many people in turn look different."""


def look_of(person: int) -> dict[str, str]:
    """Colours of a person's parts as hexadecimal digits; that of sleeves may be the skin's."""
    number = person % LOOKS
    top, skin = _TOPS[number % len(_TOPS)], _SKIN[(3 * number) % len(_SKIN)]
    return {
        "top": top,
        "forearm": skin if number % 3 == 1 else top,
        "trousers": _TROUSERS[(2 * number + number // 12) % len(_TROUSERS)],
        "skin": skin,
        "hair": _HAIR[(5 * number) % len(_HAIR)],
        "shoes": _SHOES[number % len(_SHOES)],
        "aid": _AID,
    }


def looks() -> list[list[str]]:
    """Colours of all looks, each in the order of ``PARTS``."""
    return [[look_of(number)[part] for part in PARTS] for number in range(LOOKS)]
