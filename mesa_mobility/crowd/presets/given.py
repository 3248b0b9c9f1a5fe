"""Rules that a block of code, or a command, gives to all models that are made meanwhile."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any

from mesa_mobility.crowd.presets.naming import CODE
from mesa_mobility.crowd.presets.preset import Preset
from mesa_mobility.crowd.presets.shipped import DEFAULT, preset_of
from mesa_mobility.errors import ModelError


@dataclass(frozen=True)
class Given:
    """Rules for models; other processes get them as they are.

    Attributes:
        preset: takes the place of the preset "default"; None for that one.
        values: of numbers, by name; a text stands for a number, as with `--set`.
        source: of these values.
    """

    preset: Preset | None = None
    values: Mapping[str, Any] = field(default_factory=dict)
    source: str = CODE

    def check(self) -> None:
        """Raise ModelError unless the preset has all these numbers, and takes the values."""
        self.base(DEFAULT).with_parameters(self.values)

    @property
    def preset_name(self) -> str:
        """The name of the preset of models that ask for no other."""
        return self.base(DEFAULT).name

    def used(self) -> dict[str, str]:
        """The preset with its digest, and the numbers given, as inputs of a run."""
        found = {"preset": self.base(DEFAULT).inputs_text}
        if self.values:
            numbers = "; ".join(f"{name} = {value}" for name, value in self.values.items())
            found["changed numbers"] = f"{numbers} ({self.source})"
        return found

    def base(self, asked: str | os.PathLike[str] | Preset) -> Preset:
        """The preset of a model that has asked for one."""
        if asked == DEFAULT and self.preset is not None:
            return self.preset
        return preset_of(asked)

    def changes(self, preset: Preset) -> dict[str, Any]:
        """The values for behaviours that a preset has; the others are for those of a model."""
        labels = {name.partition(".")[0] for name in preset.parameters()} if self.values else set()
        return {
            name: value for name, value in self.values.items() if name.partition(".")[0] in labels
        }

    @contextmanager
    def followed(self) -> Iterator[None]:
        """Let the models that are made in this block follow the rules."""
        token = _NOW.set(self)
        try:
            yield
        finally:
            _NOW.reset(token)


_NOW: ContextVar[Given | None] = ContextVar("rules given to models", default=None)


def now() -> Given:
    """The rules for a model that is being made."""
    return _NOW.get() or Given()


@contextmanager
def model_rules(
    preset: str | os.PathLike[str] | Preset | None = None,
    parameters: Mapping[str, Any] | None = None,
) -> Iterator[None]:
    """Let the models that are made in this block follow other rules.

    It serves functions that make models by themselves: scenarios of verification and validation,
    and those of one's own that are calibrated.

    Args:
        preset: takes the place of the preset "default": a name, a file or a ``Preset``.
        parameters: numbers by name, such as ``{"headway.time": 0.6}``.

    Raises:
        ModelError: an unknown preset or number, or a value out of range.

    Examples:
        >>> from mesa_mobility.crowd import model_rules
        >>> from mesa_mobility.models import Doorway
        >>> with model_rules(parameters={"headway.time": 0.6}):
        ...     model = Doorway(pedestrians=2, rng=1)
        >>> print(model.parameters()["headway.time"])
        headway.time = 0.6 s (code)
    """
    if parameters is not None and not isinstance(parameters, Mapping):
        raise ModelError(f"parameters: got {parameters!r:.60}, expected values by name")
    given = Given(None if preset is None else preset_of(preset), dict(parameters or {}))
    given.check()
    with given.followed():
        yield
