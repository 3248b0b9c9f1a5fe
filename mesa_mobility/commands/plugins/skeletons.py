"""What `mesa-mobility new` writes; ``@name@``, ``@class@`` and ``@module@`` are placeholders."""

BEHAVIOR = '''"""A cost term: people keep to the right of their way."""

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Candidates, CostTerm, Range


class @class@(CostTerm):
    """Options that lead to the left of the way to the target cost more.

    Metres beyond ``free`` to the left of the straight way, 0 to its right. Change this to what you
    study.

    Args:
        weight: factor in the sum.
        free: metres to the left that cost nothing.
    """

    name = "@name@"
    default_weight = 0.5

    def __init__(
        self, weight: float | None = None, free: Annotated[float, Range(0.0, 2.0, "m")] = 0.0
    ) -> None:
        super().__init__(weight)
        self.free = free  # checked against its range whenever it is set

    def cost(self, candidates: Candidates) -> NDArray[np.float64]:
        """(n,) metres beyond ``free`` by which each option ends to the left, at least 0."""
        way = candidates.targets - candidates.positions
        way = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-9)
        step = candidates.points - candidates.positions[candidates.owner]
        ahead = way[candidates.owner]
        left = ahead[:, 0] * step[:, 1] - ahead[:, 1] * step[:, 0]
        return np.maximum(left - self.free, 0.0)
'''

BEHAVIOR_TEST = '''import numpy as np
import pytest

from @module@ import @class@
from mesa_mobility import Exit, FloorPlan, MobilityError, PedestrianModel


def corridor(weight):
    """One person 6 m from its exit, whose way leads along y = 2."""
    plan = FloorPlan(
        "POLYGON ((0 0, 8 0, 8 4, 0 4, 0 0))", exits=[Exit("east", (8, 1.5), (8, 2.5))]
    )
    model = PedestrianModel(plan, rng=1)
    model.terms.append(@class@(weight=weight))
    model.add_pedestrians([(2.0, 2.0)])
    return model


def test_what_options_cost():
    model = corridor(1.0)
    options = model.candidates(model.rows)
    cost = @class@().cost(options)
    # The way leads along +x: left of it is a larger y.
    left = options.points[:, 1] - 2.0
    np.testing.assert_allclose(cost, np.maximum(left, 0.0), atol=0.05 * np.abs(left).max())


def test_settings_are_checked():
    with pytest.raises(MobilityError, match="free -1.0, expected 0 to 2 m"):
        @class@(free=-1.0)
    with pytest.raises(MobilityError, match="did you mean 'free'"):
        @class@().fre = 1.0


def test_people_still_get_out():
    model = corridor(0.5)
    model.run(max_seconds=60)
    assert model.inside == 0
'''

MODEL = '''"""A model: a room with a door."""

from typing import Annotated

import numpy as np

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Range


class @class@(PedestrianModel):
    """People leave a room of 10 m x 8 m by a door.

    Args:
        pedestrians: how many.
        door: its width, metres.
        preset: rules by which they move.
        record: keep every frame.
        rng: seed or NumPy generator.
    """

    def __init__(
        self,
        pedestrians: Annotated[int, Range(1, 100)] = 20,
        door: Annotated[float, Range(0.8, 3.0)] = 1.2,
        preset: str = "default",
        mobility_map: str | None = None,
        record: bool = False,
        rng: int | np.random.Generator | None = None,
    ) -> None:
        plan = FloorPlan(
            "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))",
            exits=[Exit("door", (10.0, 4.0 - door / 2), (10.0, 4.0 + door / 2))],
        )
        super().__init__(plan, preset=preset, mobility_map=mobility_map, record=record, rng=rng)
        places = plan.random_points(pedestrians, self.rng, spacing=0.5, clearance=0.3)
        self.add_pedestrians(places)
'''

MODEL_TEST = """from @module@ import @class@


def test_everybody_gets_out():
    model = @class@(pedestrians=10, rng=1)
    model.run(max_seconds=120)
    assert model.inside == 0
    assert model.summary()["egress_s"] > 1.0


def test_the_same_seed_gives_the_same_run():
    first, second = (@class@(pedestrians=5, rng=3) for _ in range(2))
    for model in (first, second):
        model.run(max_seconds=5)
    assert first.summary() == second.summary()
"""

PROJECT = """[build-system]
requires = ["setuptools>=77"]
build-backend = "setuptools.build_meta"

[project]
name = "@name@"
version = "0.1.0"
description = "Behaviours and models for mesa-mobility"
requires-python = ">=3.11"
dependencies = ["mesa-mobility"]

# mesa-mobility finds behaviours and models by these entries.
[project.entry-points."mesa_mobility.behaviors"]
@name@_term = "@name@:@class@Term"

[project.entry-points."mesa_mobility.models"]
@name@_room = "@name@:@class@Room"

[tool.setuptools]
packages = ["@name@"]
"""

PACKAGE = '''"""Behaviours and models for mesa-mobility."""

from @name@.@name@_room import @class@Room
from @name@.@name@_term import @class@Term

__all__ = ["@class@Room", "@class@Term"]
'''

README = """# @name@

    pip install -e .
    pytest
    mesa-mobility behaviors
    mesa-mobility run @name@_room --behavior @name@_term=1.0
"""
