"""The outcome of one test of a map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Finding:
    """What one test has measured.

    Attributes:
        test: its name, such as "door".
        what: what people did.
        measured: figures by name, ready for JSON; metres, seconds.
        expected: the threshold.
        passed: whether it was met.
        helps: what to record if the threshold was not met.
    """

    test: str
    what: str
    measured: dict[str, Any]
    expected: str
    passed: bool
    helps: str

    @property
    def warning(self) -> str:
        """One line that says what failed and what helps."""
        figures = ", ".join(
            f"{name.replace('_', ' ')} {'none' if value is None else f'{value:g}'}"
            for name, value in self.measured.items()
        )
        return f"{self.test}: {self.what}: {figures}; expected {self.expected}; {self.helps}"

    def answer(self) -> dict[str, Any]:
        """All but the name, ready for JSON."""
        said = {
            "what": self.what,
            **self.measured,
            "expected": self.expected,
            "passed": self.passed,
        }
        return said if self.passed else {**said, "helps": self.helps}
