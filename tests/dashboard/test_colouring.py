"""Values by which people are coloured, and what is counted."""

import math

import numpy as np
import pytest

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

from mesa_mobility.dashboard.session.colouring import COLOURINGS, colouring_named
from mesa_mobility.dashboard.session.observer import Observer, densities
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import strider
from tests.fixtures.scenes import advance, corridor, model_of, put, statues


def values(name, model, observer=None):
    return COLOURINGS[name].values(model, observer or Observer(model))


def test_densities_count_who_is_within_a_metre():
    model = model_of(corridor(), statues())
    model.add_pedestrians([(2.0, 1.0), (2.0, 1.9), (2.0, 2.8), (9.0, 1.0)], headings=0.0)
    assert densities(model) == pytest.approx(np.array([2, 3, 2, 1]) / math.pi)
    assert np.array_equal(values("density", model), densities(model))


def test_waiting_is_time_spent_slower_than_a_fifth_of_a_metre_a_second():
    model = model_of(corridor(), [strider(), statues()])
    put(model, 2.0, 1.0)
    put(model, 2.0, 3.0, type_index=1)
    observer = Observer(model)
    for _ in range(30):
        advance(model, 1)
        observer.after_step()
    assert values("waiting time", model, observer) == pytest.approx([0.0, 1.0])
    assert values("type", model).tolist() == [0.0, 1.0]
    assert values("speed", model) == pytest.approx([1.25, 0.0])


def test_people_are_coloured_by_their_fields():
    model = model_of(corridor(), statues(), fields={"infected": bool, "mood": float})
    model.add_pedestrians(
        [(2.0, 1.0), (2.0, 1.9), (2.0, 2.8)],
        fields={"infected": [False, True, True], "mood": [-2.0, 1.0, 6.0]},
    )
    observer = Observer(model)
    infected = colouring_named("infected", model)
    assert (infected.low, infected.high) == (0.0, 1.0)
    assert infected.values(model, observer).tolist() == [0.0, 1.0, 1.0]
    mood = colouring_named("mood", model)
    assert (mood.low, mood.high, mood.label) == (-2.0, 6.0, "mood")
    assert mood.values(model, observer).tolist() == [-2.0, 1.0, 6.0]


def test_an_unknown_colouring_is_refused():
    with pytest.raises(ModelError, match="colour_by: got 'mood', expected one of speed"):
        colouring_named("mood", model_of(corridor(), statues()))
