"""Examples in docstrings run and give what they say."""

import doctest
from importlib import import_module
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "mesa_mobility"
WITH_EXAMPLES = sorted(
    ".".join(("mesa_mobility", *file.relative_to(PACKAGE).with_suffix("").parts))
    for file in PACKAGE.rglob("*.py")
    if ">>> " in file.read_text(encoding="utf-8")
)


def test_the_main_classes_have_examples() -> None:
    assert {
        "mesa_mobility.crowd.costs.terms",
        "mesa_mobility.crowd.pedestrian_model",
        "mesa_mobility.distributions.base",
        "mesa_mobility.floorplan.plan",
        "mesa_mobility.mobility.map",
    } <= set(WITH_EXAMPLES)


@pytest.mark.parametrize("module", WITH_EXAMPLES)
def test_examples_in_docstrings(module: str) -> None:
    result = doctest.testmod(import_module(module))

    assert result.attempted > 0
    assert result.failed == 0
