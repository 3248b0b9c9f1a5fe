"""How a model is made."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from mesa_mobility import PedestrianModel

_one_at_a_time = threading.Lock()


@dataclass(frozen=True)
class Recipe:
    """How to make a model.

    Attributes:
        kind: its class.
        keywords: what its constructor gets.
    """

    kind: type[PedestrianModel]
    keywords: Mapping[str, Any] = field(default_factory=dict)

    def make(self) -> PedestrianModel:
        """The model."""
        # Models share maps and kernels: two made at once would both load them.
        with _one_at_a_time:
            return self.kind(**self.keywords)
