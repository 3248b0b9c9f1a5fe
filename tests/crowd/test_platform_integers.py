"""NumPy 1 has integers of 32 bits by default on Windows: compiled functions get 64 all the same."""

import numpy as np
import pytest
from mesa_mobility.models import Doorway

from mesa_mobility.crowd.planning.decision import decide
from mesa_mobility.crowd.state.people_grid import build_grid
from mesa_mobility.floorplan.routing import target_points, target_search

MAKERS = ("arange", "array", "cumsum", "full", "ones", "zeros")


def as_on_windows(make):
    """As ``make``, but what would be integers of 64 bits by default are of 32."""

    def made(*args, dtype=None, **options):
        plain = dtype is None and not any(isinstance(each, type | np.dtype) for each in args)
        given = make(*args, **options) if dtype is None else make(*args, dtype=dtype, **options)
        of_64 = isinstance(given, np.ndarray) and given.dtype == np.int64
        from_64 = any(isinstance(each, np.ndarray | np.int64) for each in args)
        return given.astype(np.int32) if plain and of_64 and not from_64 else given

    return made


def walk():
    model = Doorway(pedestrians=6, rng=3)
    for _ in range(3):
        model.step()
    n = model.population.count
    return model.crowd.x[:n].copy(), model.crowd.y[:n].copy()


@pytest.fixture
def counted():
    """How many combinations of types functions of the hot path are compiled for."""
    functions = (decide, build_grid, *vars(target_search).values(), *vars(target_points).values())
    compiled = [each for each in functions if hasattr(each, "signatures")]

    def count():
        return [len(each.signatures) for each in compiled]

    return count


def test_default_integers_of_32_bits_reach_no_compiled_function(monkeypatch, counted):
    expected = walk()
    before = counted()
    for name in MAKERS:
        monkeypatch.setattr(np, name, as_on_windows(getattr(np, name)))
    assert np.arange(3).dtype == np.int32
    found = walk()
    monkeypatch.undo()
    assert counted() == before
    assert all((one == other).all() for one, other in zip(found, expected, strict=True))
