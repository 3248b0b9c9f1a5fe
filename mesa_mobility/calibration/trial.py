"""One run of a scenario with one set of numbers, as experiments run models."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

from mesa_mobility._numbers import is_number
from mesa_mobility.calibration.names import called, measured
from mesa_mobility.crowd.model_files import find_model
from mesa_mobility.crowd.pedestrian_model import PedestrianModel
from mesa_mobility.crowd.presets.files import parse_preset
from mesa_mobility.crowd.presets.given import now
from mesa_mobility.errors import ModelError
from mesa_mobility.results import Trajectories


class Trial:
    """Simulates one scenario, and measures how far it is from what was measured.

    The numbers of behaviours are those that are given to models just now.

    Args:
        scenario: its name, for errors.
        simulates: text of the function or model.
        measures: text of the measured data.
        distances: JSON of the text of each distance's function by the distance's name.
        scenario_seed: of the scenario; that of the experiment differs from numbers to numbers, and
            is not used.
        rules: the preset, as TOML.
        longest_s: simulated seconds at most, of a model; 0 for no limit.
        rng: not used.
    """

    makes_models = True
    """Whether numbers of behaviours are for models that this makes."""

    def __init__(
        self,
        scenario: str,
        simulates: str,
        measures: str,
        distances: str,
        scenario_seed: int,
        rules: str,
        longest_s: float = 0.0,
        rng: Any = None,
    ) -> None:
        self.running = True
        self._scenario, self._seed, self._longest_s = scenario, scenario_seed, longest_s
        self._simulates, self._measures = simulates, measures
        self._functions: dict[str, str] = json.loads(distances)
        self._preset = parse_preset(rules, "rules of a calibration", "calibration")
        self._values: dict[str, float] = {}

    def step(self) -> None:
        """Simulate, and measure all distances."""
        given = replace(now(), preset=self._preset)
        with given.followed():
            simulated = self._simulated()
        known = measured(self._measures)
        for name, function in self._functions.items():
            value = called(function)(simulated, known)
            value = value.item() if hasattr(value, "item") else value
            if not (is_number(value) and 0.0 <= value < math.inf):
                raise ModelError(
                    f"scenario {self._scenario}: distance {name} is {value!r:.60}, expected a "
                    "finite number, 0 or more"
                )
            self._values[name] = float(value)
        self.running = False

    def summary(self) -> dict[str, float]:
        """The distances, by their columns."""
        return {column_of(name): value for name, value in self._values.items()}

    def rules_used(self) -> dict[str, str]:
        """The preset with its digest, and the numbers that are tried, as inputs of a run."""
        return replace(now(), preset=self._preset).used()

    def _simulated(self) -> Any:
        if self._simulates.startswith("model "):
            made = find_model(self._simulates.removeprefix("model "))(rng=self._seed)
        else:
            made = called(self._simulates)(self._seed)
        if not isinstance(made, PedestrianModel):
            return made
        made.set_parameters(now().values)
        if made.frame == 0:
            if made.recorder is None:
                made.start_recording()
            made.run(max_seconds=self._longest_s or None)
        return Trajectories.of(made)


def column_of(distance: str) -> str:
    """The column of a store that has a distance."""
    return f"distance {distance}"
