"""Measured tracks beside a replay of them: the same people, in the same windows of time and place.

``setting_of`` finds where and when people are measured, as far as it is not given, and
``experiment`` makes a comparison of it that runs, is judged and drawn as every other.
"""

from mesa_mobility.validation.tracks.experiment import experiment
from mesa_mobility.validation.tracks.setting import Setting, setting_of

__all__ = ["Setting", "experiment", "setting_of"]
