"""Public names: one that is misspelt is answered with the nearest."""

import ast
import importlib
from pathlib import Path

import pytest

import mesa_mobility
import mesa_mobility.experiments

HINT = r"did you mean 'PedestrianModel'\?$"


def test_a_misspelt_name_is_answered_with_the_nearest():
    with pytest.raises(AttributeError, match=HINT):
        _ = mesa_mobility.PedestrianMdel
    with pytest.raises(ImportError, match=HINT):
        from mesa_mobility import PedestrianMdel  # noqa: F401
    with pytest.raises(ImportError, match="did you mean 'Experiment'"):
        from mesa_mobility.experiments import Experimnt  # noqa: F401


def test_names_like_no_other_are_just_unknown():
    assert not hasattr(mesa_mobility, "PedestrianMdel")
    assert getattr(mesa_mobility, "__wrapped__", None) is None
    with pytest.raises(AttributeError, match=r"has no attribute 'zzzzzz'$"):
        _ = mesa_mobility.zzzzzz


@pytest.mark.parametrize(
    "name", ["", ".animation", ".bodies", ".crowd", ".dashboard", ".experiments", ".mobility"]
)
def test_every_name_stands_once_and_is_found(name):
    package = importlib.import_module("mesa_mobility" + name)
    tree = ast.parse(Path(package.__file__).read_text())
    (block,) = (each for each in tree.body if isinstance(each, ast.If))
    names = package.__all__
    assert names == [each.asname for line in block.body for each in line.names]
    for each in names:
        assert getattr(package, each) is not None
        assert each in dir(package)
