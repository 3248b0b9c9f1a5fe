"""A checkpoint has the rules of its model, whatever becomes of their file or block."""

from dataclasses import replace

import pytest

from mesa_mobility import PedestrianModel
from mesa_mobility.crowd import Provenance, model_rules, write_preset
from tests.fixtures.engine import ENGINE
from tests.fixtures.maps import wanderer
from tests.fixtures.scenes import advance, corridor


def made(**keywords):
    model = PedestrianModel(corridor(), mobility_map=wanderer(5, options=30), rng=1, **keywords)
    model.add_pedestrians([(1.0, 1.0), (2.0, 2.0), (3.0, 3.0)])
    return model


def places(model):
    return [(each.position[0], each.position[1]) for each in model.agents]


@pytest.mark.parametrize("how", ["file", "block"])
def test_rules_of_a_file_and_of_a_block_are_saved(how, tmp_path):
    noted = replace(ENGINE, name="mine", durations=(12, 24), most_acceleration=None)
    rules = replace(noted, provenance=Provenance(date="2026-11-26", figures={"flow": 1.5}))
    file = tmp_path / "mine.toml"
    write_preset(rules.with_parameters({"headway.time": 0.5}), file)
    if how == "file":
        model = made(preset=file)
    else:
        with model_rules(file, {"sideways.weight": 3.0}):
            model = made()
    file.unlink()
    advance(model, 20)
    model.save(tmp_path / "model.zip")
    loaded = PedestrianModel.load(tmp_path / "model.zip", mobility_map=wanderer(5, options=30))
    assert loaded.rules == model.rules
    assert loaded.rules.provenance == rules.provenance
    values = {name: each.value for name, each in model.parameters().items()}
    assert {name: each.value for name, each in loaded.parameters().items()} == values
    assert (values["headway.time"], loaded.rules.durations) == (0.5, (12, 24))
    assert values["sideways.weight"] == (2.2 if how == "file" else 3.0)
    for each in (model, loaded):
        advance(each, 30)
    assert places(loaded) == places(model)
