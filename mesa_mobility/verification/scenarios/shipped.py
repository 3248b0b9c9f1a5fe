"""The models that ship, as cases."""

from __future__ import annotations

from typing import Any

from mesa_mobility.plugins.registry import load_model
from mesa_mobility.verification.runs import evacuate

LIMIT_S = 900.0


def shipped(seed: int, *, model: str, **parameters: Any) -> dict[str, Any]:
    """Run a model that ships until everybody is out, with its own numbers except ``parameters``."""
    run = evacuate(load_model(model)(record=True, rng=seed, **parameters), LIMIT_S)
    return run.figures()
