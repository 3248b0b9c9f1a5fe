"""Columns of the data that a model collects, added while it runs."""

import pytest

from mesa_mobility import PedestrianModel
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import strider
from tests.fixtures.scenes import corridor, model_of, put


@pytest.fixture
def model():
    """Two people who walk at 1.25 m/s, after two steps of 0.1 s."""
    model = model_of(corridor(), strider(), frames_per_step=3)
    for x in (2.0, 5.0):
        put(model, x, 1.0, preferred_speeds=[1.25])
    model.step()
    model.step()
    return model


class Counts:
    def __call__(self, model):
        return model.inside * 10

    def inside(self, model):
        return model.inside * 100


def test_a_reporter_may_be_added_at_any_time(model):
    model.add_reporter("twice", lambda model: 2 * model.inside)
    model.add_reporter("frame", "frame")
    model.add_reporter("object", Counts())
    model.add_reporter("method", Counts().inside)
    model.step()
    rows = model.datacollector.get_model_vars_dataframe()
    assert rows["inside"].tolist() == [2, 2, 2]
    assert rows["twice"].isna().tolist() == [True, True, False]
    assert rows.iloc[2][["twice", "frame", "object", "method"]].tolist() == [4, 9, 20, 200]


def test_a_reporter_of_agents_may_be_added_at_any_time(model):
    model.add_agent_reporter("x", lambda agent: float(agent.position[0]))
    model.step()
    model.add_agent_reporter("speed", "preferred_speed")
    model.step()
    rows = model.datacollector.get_agent_vars_dataframe()
    second = rows["x"].tolist()[1::2]
    assert second == pytest.approx([5.375, 5.5])
    assert rows["speed"].isna().tolist() == [True, True, False, False]
    assert rows["speed"].tolist()[2:] == [1.25, 1.25]


def test_columns_that_were_added_go_on_after_a_checkpoint(model, tmp_path):
    model.add_reporter("twice", lambda model: 2 * model.inside)
    model.step()
    model.save(tmp_path / "model.zip")
    loaded = PedestrianModel.load(tmp_path / "model.zip", pedestrian_types=model.pedestrian_types)
    loaded.step()
    loaded.add_reporter("twice", lambda model: 2 * model.inside)
    loaded.step()
    column = loaded.datacollector.get_model_vars_dataframe()["twice"]
    assert column.isna().tolist() == [True, True, False, True, False]
    assert column[[2, 4]].tolist() == [4, 4]


@pytest.mark.parametrize("add", ["add_reporter", "add_agent_reporter"])
@pytest.mark.parametrize("wrong", [None, 3, ["inside"]])
def test_what_reports_nothing_is_refused(model, add, wrong):
    with pytest.raises(ModelError, match=r"reporter 'x'.*expected a function"):
        getattr(model, add)("x", wrong)


def test_two_reporters_of_agents_need_two_names(model):
    model.add_agent_reporter("x", "preferred_speed")
    with pytest.raises(ModelError, match="there is one"):
        model.add_agent_reporter("x", "preferred_speed")
