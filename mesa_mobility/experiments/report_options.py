"""What somebody wants an experiment's report to show."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from mesa_mobility.errors import ModelError


@dataclass(frozen=True)
class ReportOptions:
    """Figures of the report, and their names.

    Args:
        figures: columns of the runs, such as "door.east.flow_per_s" or a figure of the model's own
            summary; by default the time to leave, the flow and the speed.
        labels: words for columns, with units, such as ``{"y": "yield (kg)"}``.

    Raises:
        ModelError: no lists of texts.
    """

    figures: tuple[str, ...] = ()
    labels: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if isinstance(self.figures, str) or not _are_texts(self.figures):
            raise ModelError(f"report: figures is {self.figures!r}, expected a list of columns")
        object.__setattr__(self, "figures", tuple(self.figures))
        if not isinstance(self.labels, Mapping) or not _are_texts(self.labels.values()):
            raise ModelError(f"report: labels is {self.labels!r}, expected words by column")
        object.__setattr__(self, "labels", dict(self.labels))

    def definition(self) -> dict[str, Any]:
        """What a file says of it."""
        return {"figures": list(self.figures), "labels": dict(self.labels)}


def _are_texts(values: Any) -> bool:
    try:
        return all(isinstance(each, str) and each for each in values)
    except TypeError:
        return False
