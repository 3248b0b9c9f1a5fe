"""Models in which no behaviour counts say so."""

import warnings

import pytest
from mesa_mobility.behaviors import Displacement, TargetDistance

from mesa_mobility import cli
from mesa_mobility.experiments.workers import one_run
from tests.fixtures.scenes import advance, corridor, model_of, put, statues

TEXT = r"no behaviour has a weight above 0 \(of target_distance, displacement\)"


def model(*weights):
    terms = [TargetDistance(weights[0]), Displacement(weights[1])]
    made = model_of(corridor(), statues(), behaviors=terms)
    put(made, 2.0, 2.0)
    return made


@pytest.mark.parametrize("weights", [(0.0, 0.0), (-1.0, -1.0), (0.0, -1.0)])
def test_a_model_without_any_weight_above_0_warns_once(weights):
    made = model(*weights)
    assert one_run._warning(made, ()).startswith("no behaviour has a weight above 0")
    with pytest.warns(UserWarning, match=TEXT) as said:
        advance(made, 3)
    assert len(said) == 1


def test_one_weight_above_0_is_enough():
    by_type = model(0.0, 0.0)
    by_type.terms[0].weight_by_type = {by_type.pedestrian_types[0].name: 0.5}
    for made in (model(0.1, -1.0), by_type):
        assert one_run._warning(made, ()) is None
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            advance(made, 2)


def test_commands_print_a_warning_on_one_line(capsys):
    warn = cli._warner()
    for _ in range(2):  # the second time it is not said again
        warn(UserWarning("two\nlines"), UserWarning, "file.py", 3)
    assert capsys.readouterr().err == "warning: two lines\n"
