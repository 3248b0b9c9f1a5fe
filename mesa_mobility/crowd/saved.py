"""Parts of a model that a checkpoint holds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from mesa_mobility.schema import Kind


class Saved:
    """A part of a model that goes into a checkpoint.

    Attributes:
        saved: the attributes that change while a model runs, and what each of them is.
    """

    saved: ClassVar[Mapping[str, Kind]] = {}

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are; a checkpoint with others is refused.

        Names of sizes are those of ``mesa_mobility.crowd.checkpoint.checking``.
        """
        return self.saved

    def state(self) -> dict[str, Any]:
        """All that changes while a model runs."""
        return {name: getattr(self, name) for name in self.saved}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given, in this process or another."""
        for name in self.saved:
            setattr(self, name, state[name])
