"""Weights of cost terms from the choices of measured people.

A pedestrian that ranks movement options by a sum of costs is a discrete choice model (Antonini,
Bierlaire and Weber, Transportation Research B 40 (2006) 667-687), so that what measured people
chose says how much each term counts.
"""

from __future__ import annotations

from mesa_mobility._lazy import names_of

# Type checkers take this for true. The module typing takes a while to import.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from mesa_mobility.estimation.choices.observations import Coverage as Coverage
    from mesa_mobility.estimation.choices.observations import Observations as Observations
    from mesa_mobility.estimation.choices.observing import observe as observe
    from mesa_mobility.estimation.choices.sampling import Sampling as Sampling
    from mesa_mobility.estimation.estimating import Estimate as Estimate
    from mesa_mobility.estimation.estimating import estimate as estimate
    from mesa_mobility.estimation.leaving_out import LeftOut as LeftOut
    from mesa_mobility.estimation.leaving_out import leave_out as leave_out
    from mesa_mobility.estimation.measures import Measures as Measures
    from mesa_mobility.estimation.profiles import Profile as Profile
    from mesa_mobility.estimation.profiles import profile as profile

__getattr__, __dir__ = names_of(__name__, __file__)
