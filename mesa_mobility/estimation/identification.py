"""What head tracks do not show, and how much of a term rests on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.estimation.problem import Problem

TURNED = np.deg2rad(20.0)
"""How far bodies may face away from where they were assumed to, radians."""

SWAY = 0.03
"""How far heads may be from the middle of the body, metres in each direction."""

ASSUMED = 0.25
"""Share of a term's spread from which on its weight reflects what was assumed."""

_SEED = 7


def unidentified(problem: Problem) -> NDArray[np.float64]:
    """(p,) how much of each term rests on what head tracks do not show.

    Bodies and ends of options are turned by 20 degrees, either way, and ends are shifted by the
    sway of heads. The figure is the root mean square of what that changes, over the spread of the
    term over the options of a choice.
    """
    observations = problem.observations
    rng = np.random.default_rng(_SEED)
    off = [_as_seen(batch.candidates, rng) for batch in observations.batches]
    batches = tuple(
        replace(batch, candidates=seen)
        for batch, seen in zip(observations.batches, off, strict=True)
    )
    other = Problem.of(problem.terms, replace(observations, batches=batches))
    changes = np.sqrt(np.mean((other.spreads - problem.spreads) ** 2, axis=0))
    spreads = np.sqrt(np.mean(problem.spreads**2, axis=0))
    return changes / np.maximum(spreads, 1e-12)


def _as_seen(candidates: Candidates, rng: np.random.Generator) -> Candidates:
    """The options if bodies faced elsewhere and heads swayed otherwise."""
    n, b = len(candidates), len(candidates.facings)
    points = candidates.points + SWAY * rng.standard_normal((n, 2))
    displacements = np.hypot(*(points - candidates.positions[candidates.owner]).T)
    return replace(
        candidates,
        points=points,
        displacements=displacements,
        speeds=displacements / candidates.durations,
        headings=candidates.headings + TURNED * rng.choice([-1.0, 1.0], n),
        facings=candidates.facings + TURNED * rng.choice([-1.0, 1.0], b),
    )
