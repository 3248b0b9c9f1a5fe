"""Calibration: numbers of behaviours for which simulated crowds come near to measured ones.

Names are imported when they are first used: a command that runs one model needs none of them.
"""

from __future__ import annotations

from mesa_mobility._lazy import names_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mesa_mobility.calibration.calibrate import calibrate as calibrate
    from mesa_mobility.calibration.outcome import Calibrated as Calibrated
    from mesa_mobility.calibration.outcome import Figure as Figure
    from mesa_mobility.calibration.outcome import Generation as Generation
    from mesa_mobility.calibration.settings import Distance as Distance
    from mesa_mobility.calibration.settings import Free as Free
    from mesa_mobility.calibration.settings import HeldOut as HeldOut
    from mesa_mobility.calibration.settings import Search as Search
    from mesa_mobility.calibration.settings import Seeds as Seeds

__getattr__, __dir__ = names_of(__name__, __file__)
