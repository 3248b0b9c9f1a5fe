"""The terms together: equation (1), and what makes each of them a plug-in like any other."""

import ast
import math
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import mesa_mobility.behaviors as behaviors
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesa_mobility.behaviors import (
    Displacement,
    FacingDeviation,
    Headway,
    Interference,
    PreferredSpeed,
    PreferredVelocity,
    RightOfWay,
    RoomAhead,
    Sideways,
    Stepping,
    TargetDistance,
    VelocityChange,
)

from mesa_mobility import CostTerm
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.registry import load_behavior
from tests.fixtures.options import Ending, crowded, one_option

TERMS = [
    TargetDistance,
    FacingDeviation,
    Displacement,
    Interference,
    PreferredSpeed,
    PreferredVelocity,
    Headway,
    RightOfWay,
    RoomAhead,
    Stepping,
    VelocityChange,
    Sideways,
]


def test_equation_one_by_hand():
    # 1.5 m ahead in 1.5 s, facing 30 degrees left; target 3 m ahead of the mobility point;
    # one neighbour 0.18 m ahead of it, one 0.09 m behind.
    options = one_option(
        Ending(point=(1.5, 0.0), heading=math.pi / 6, displacement=1.5, duration=1.5),
        target=(4.5, 0.0),
        neighbours=[((1.68, 0.0), (0.0, 0.0)), ((1.41, 0.0), (0.0, 0.0))],
    )
    terms = [TargetDistance(2.0), FacingDeviation(3.0), Displacement(4.0), Interference(5.0)]
    total = sum(term.weight * term.cost(options)[0] for term in terms)
    # 2 x 3 + 3 x 0.5235988 - 4 x 1.5 + 5 x 1.4210205
    assert total == pytest.approx(8.6758987, abs=1e-6)


@pytest.mark.parametrize("term", TERMS)
def test_one_cost_for_each_option(term):
    options = one_option(Ending())
    cost = term().cost(options)
    assert cost.shape == (1,)
    assert np.isfinite(cost).all()


@pytest.mark.parametrize("term", TERMS)
def test_weight_is_not_part_of_the_cost(term):
    options = one_option(
        Ending(displacement=0.7, duration=0.4, heading=0.3),
        target=(2.0, 1.0),
        neighbours=[((0.1, 0.0), (0.0, 0.0))],
        walls=[(0.4, -1.0, 0.4, 1.0)],
    )
    assert term(7.0).cost(options).tolist() == term(1.0).cost(options).tolist()
    assert term(7.0).weight == 7.0


@pytest.mark.parametrize("term", TERMS)
@pytest.mark.parametrize("weight", [math.nan, math.inf, -math.inf])
def test_weights_that_are_not_numbers_are_refused(term, weight):
    with pytest.raises(ModelError, match=term.name) as refused:
        term(weight)
    assert "\n" not in str(refused.value)
    changed = term()
    with pytest.raises(ModelError, match=term.name):
        changed.weight = weight
    assert math.isfinite(changed.weight)


@given(crowded, st.sampled_from(TERMS))
@settings(deadline=None)
def test_costs_of_a_batch_are_those_of_its_people_one_by_one(options, term):
    together = term().cost(options)
    assert together.shape == (len(options),)
    for k in range(len(options.pedestrians)):
        alone = term().cost(_only(options, k))
        mine = together[options.offsets[k] : options.offsets[k + 1]]
        np.testing.assert_allclose(alone, mine, rtol=1e-12)


@pytest.mark.parametrize("term", TERMS)
def test_registered_under_its_name(term):
    assert issubclass(term, CostTerm)
    assert load_behavior(term.name) is term


def test_nearest_exit_is_a_behaviour_like_any_other():
    from mesa_mobility.plugins.registry import behaviors as registered

    assert [name for name in registered() if "exit" in name]


def test_behaviours_use_public_names_only():
    for path in Path(behaviors.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if not isinstance(node, ast.ImportFrom) or not node.module:
                continue
            parts = node.module.split(".")
            if parts[0] != "mesa_mobility" or parts[1:2] == ["behaviors"]:
                continue
            assert len(parts) <= 2, f"{path.name} imports from {node.module}"
            public = import_module(node.module)
            for name in node.names:
                assert node.module == "mesa_mobility.errors" or name.name in public.__all__


def _only(options, k: int):
    """The part of a batch that belongs to person k."""
    rows = slice(options.offsets[k], options.offsets[k + 1])
    near = slice(options.neighbour_offsets[k], options.neighbour_offsets[k + 1])
    fields = {
        name: getattr(options, name)[rows]
        for name in ("points", "headings", "displacements", "durations", "speeds", "options")
    }
    fields |= {
        name: getattr(options, name)[k : k + 1]
        for name in (
            "places",
            "facings",
            "targets",
            "preferred_speeds",
            "cores",
            "types",
            "groups",
        )
    }
    fields |= {
        name: getattr(options, name)[near]
        for name in (
            "neighbour_places",
            "neighbour_facings",
            "neighbour_cores",
            "neighbour_types",
            "neighbour_groups",
        )
    }
    walls = options.walls[options.wall_offsets[k] : options.wall_offsets[k + 1]]
    n, q = rows.stop - rows.start, near.stop - near.start
    return replace(
        options,
        owner=np.zeros(n, dtype=np.int64),
        offsets=np.array([0, n]),
        neighbour_offsets=np.array([0, q]),
        wall_offsets=np.array([0, len(walls)]),
        walls=walls,
        fields={name: values[k : k + 1] for name, values in options.fields.items()},
        neighbour_fields={name: values[near] for name, values in options.neighbour_fields.items()},
        **fields,
    )
