"""Seeds in the forms that a model accepts."""

from __future__ import annotations

from typing import Any

from mesa_mobility.errors import ModelError


def seed_of(value: Any) -> Any:
    """A seed as NumPy takes it; a page may give it as text or as a whole float.

    Args:
        value: a whole number from 0 on, the text of one, no text or None for a seed drawn at
            random, or anything else that NumPy takes.

    Raises:
        ModelError: a number or a text that is not a seed.
    """
    seed = value
    if isinstance(value, str):
        text = value.strip()
        if text.lower() in ("", "none"):
            return None
        seed = int(text) if text.isascii() and text.isdigit() else -1
    elif isinstance(value, float):
        seed = int(value) if value.is_integer() else -1
    if isinstance(seed, int) and seed < 0:
        shown = repr(value)
        raise ModelError(
            f"rng: got {shown if len(shown) <= 40 else shown[:40] + '...'}, "
            "expected a whole number from 0 on"
        )
    return seed
