import numpy as np
from crowd_extras import Clinic, KeepAway, KeepLeft, Patient

from mesa_mobility import PedestrianModel


def test_the_infected_leave_by_the_doctors_door():
    model = Clinic(pedestrians=10, infected=0.5, keep_away=0.0, rng=1)
    for person in model.agents:
        assert isinstance(person, Patient)
        # A target lies at a door or beyond: the doctor's at x = 0, that of the street at x = 12.
        nearest_is_the_doctors = person.pos[0] < 6.0
        assert (person.target[0] < 6.0) == (person.infected or nearest_is_the_doctors)
    model.run(max_seconds=60)
    assert model.inside == 0


def test_what_the_compiled_term_costs():
    model = Clinic(pedestrians=20, infected=0.5, rng=2)
    options = model.candidates(model.rows)
    rows, neighbours = options.pairs()
    there = options.predicted(rows, neighbours)
    gap = np.maximum(1.5 - np.linalg.norm(there - options.points[rows], axis=1), 0.0)
    ours = options.fields["infected"][options.owner[rows]]
    theirs = options.neighbour_fields["infected"][neighbours]
    expected = np.bincount(rows, gap * ~ours * theirs, len(options))
    np.testing.assert_allclose(KeepAway().cost(options), expected, atol=1e-9)


def test_the_term_in_numpy_has_signs():
    model = Clinic(pedestrians=2, rng=3)
    options = model.candidates(model.rows)
    cost = KeepLeft().cost(options)
    assert cost.min() < 0.0 < cost.max()


def test_infections_spread_and_are_told(tmp_path):
    model = Clinic(pedestrians=30, infected=0.3, record=True, rng=4)
    before = sum(model.agents.get("infected"))
    model.run(max_seconds=3)
    caught = [person for person in model.agents if person.caught_at is not None]
    assert sum(model.agents.get("infected")) >= len(caught)
    assert model.crowd.fields["infected"].sum() == before + len(caught)
    model.save(tmp_path / "clinic.zip")
    again = PedestrianModel.load(tmp_path / "clinic.zip")
    assert isinstance(again, Clinic)
    for each in (model, again):
        each.run(max_seconds=5)
    assert model.summary() == again.summary()
