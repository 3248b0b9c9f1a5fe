"""People who make no progress look for a way round."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.tactics.impatience import (
    ANOTHER_WAY,
    GETTING_NEARER,
    LOOKS,
    MOST,
    PATIENCE,
    RATE,
    perturb_targets,
)
from tests.fixtures.maps import make_map, straight, strider
from tests.fixtures.scenes import advance, corridor, model_of, put, statues


def people(n: int = 1, *, route: float = 10.0) -> Crowd:
    """A crowd just placed, each with a target 3 m up and 4 m to the right."""
    crowd = Crowd(n)
    crowd.x[:], crowd.y[:] = np.arange(n), 2.0
    crowd.route[:] = route
    crowd.agenda["nearest"] = math.inf
    return crowd


def look(crowd: Crowd, elapsed: float, rng: np.random.Generator, rows=None):
    """(n,) angles by which targets have been turned."""
    rows = np.arange(len(crowd.x)) if rows is None else np.asarray(rows)
    # The choice of targets gives them anew at each decision.
    crowd.target_x[:], crowd.target_y[:] = crowd.x + 4.0, crowd.y + 3.0
    perturb_targets(rows, crowd, elapsed, rng)
    dx, dy = crowd.target_x - crowd.x, crowd.target_y - crowd.y
    np.testing.assert_allclose(np.hypot(dx, dy), 5.0)
    return np.arctan2(4.0 * dy - 3.0 * dx, 4.0 * dx + 3.0 * dy)


def untouched(crowd: Crowd, elapsed: float, rows=None) -> bool:
    """Whether nobody is impatient: nothing is drawn, and nobody turned."""
    rng = np.random.default_rng(1)
    angles = look(crowd, elapsed, rng, rows)
    same = rng.bit_generator.state == np.random.default_rng(1).bit_generator.state
    exact = (crowd.target_x == crowd.x + 4.0).all() and (crowd.target_y == crowd.y + 3.0).all()
    assert exact == bool((angles == 0.0).all())
    assert exact or not same
    return same


def test_nobody_is_turned_before_patience_ends():
    crowd = people(3)
    for elapsed in np.linspace(0.0, PATIENCE, 21):
        assert untouched(crowd, elapsed)
    assert not untouched(crowd, PATIENCE + 0.1)


def test_patience_counts_from_the_first_target():
    crowd = people()
    assert untouched(crowd, 100.0)
    assert untouched(crowd, 100.0 + PATIENCE)
    assert not untouched(crowd, 100.1 + PATIENCE)


def test_slow_people_stay_patient_while_they_get_on_as_fast_as_they_want():
    # At 0.02 m/s, 0.25 m take 12.5 s.
    crowd = people()
    crowd.agenda["desired_speed"] = 0.02
    assert untouched(crowd, 0.0)
    assert untouched(crowd, 2.0 * 12.5)
    assert not untouched(crowd, 2.0 * 12.5 + 0.1)


def spread(impatient: float, n: int = 100_000) -> float:
    """Standard deviation of the angle after seconds of impatience, from the mean of its cosine."""
    rng = np.random.default_rng(7)
    crowd = people(n)
    look(crowd, 0.0, rng)
    angles = look(crowd, PATIENCE + impatient, rng)
    angles = angles[angles != 0.0]
    # Those who look for a way round; the others wait. Five standard errors.
    error = math.sqrt(LOOKS * (1.0 - LOOKS) / n)
    assert len(angles) / n == pytest.approx(LOOKS, abs=5.0 * error)
    # A normal angle has mean sine 0 and mean cosine exp(-s^2 / 2), wrapped or not.
    assert np.sin(angles).mean() == pytest.approx(0.0, abs=0.02)
    return math.sqrt(-2.0 * math.log(np.cos(angles).mean()))


def test_the_spread_grows_with_the_wait():
    until_most = MOST / RATE
    for share in (0.1, 0.3, 0.6, 1.0):
        assert spread(share * until_most) == pytest.approx(share * MOST, rel=0.05)


def test_the_spread_is_capped():
    most = spread(MOST / RATE)
    assert spread(10.0 * MOST / RATE) == most
    assert spread(1e6) == most


@settings(deadline=None)
@given(
    place=st.tuples(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3)),
    target=st.tuples(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3)),
    impatient=st.floats(0.01, 1e4),
    seed=st.integers(0, 2**16),
)
def test_the_distance_to_the_target_is_kept(place, target, impatient, seed):
    rng = np.random.default_rng(seed)
    crowd = people()
    look(crowd, 0.0, rng)
    (crowd.x[0], crowd.y[0]), (crowd.target_x[0], crowd.target_y[0]) = place, target
    perturb_targets(np.array([0]), crowd, PATIENCE + impatient, rng)
    turned = crowd.target_x[0], crowd.target_y[0]
    assert all(map(math.isfinite, turned))
    assert math.dist(turned, place) == pytest.approx(math.dist(target, place), abs=1e-9)


@pytest.mark.parametrize(
    ("by", "resets"),
    [
        (-1.01 * GETTING_NEARER, True),
        (-0.99 * GETTING_NEARER, False),
        (0.0, False),
        (0.99 * ANOTHER_WAY, False),  # pushed back
        (1.01 * ANOTHER_WAY, True),  # the way to another exit
        (math.inf, True),  # no way at all: nothing to be impatient about
    ],
)
def test_getting_nearer_or_another_way_starts_patience_anew(by, resets):
    crowd = people()
    assert untouched(crowd, 0.0)
    assert not untouched(crowd, 2.0 * PATIENCE)
    crowd.route[0] += by
    assert untouched(crowd, 2.5 * PATIENCE) == resets
    if resets:
        assert untouched(crowd, 3.5 * PATIENCE)
        # People without any way to go are never impatient.
        assert untouched(crowd, 3.6 * PATIENCE) == math.isinf(by)


def test_steps_too_small_to_count_add_up():
    crowd = people()
    for second in range(60):
        crowd.route[0] = 10.0 - 0.3 * GETTING_NEARER * second
        assert untouched(crowd, float(second))


def test_getting_back_to_where_one_was_is_not_getting_on():
    crowd = people()
    assert untouched(crowd, 0.0)
    for second in range(1, 5):
        crowd.route[0] = 10.0 + (1.0 if second % 2 else 0.0)
        assert untouched(crowd, second * PATIENCE / 5)
    crowd.route[0] = 10.0
    assert not untouched(crowd, PATIENCE + 0.1)


def test_only_the_impatient_among_those_who_decide_are_turned():
    rng = np.random.default_rng(5)
    crowd = people(4)
    look(crowd, 0.0, rng)
    crowd.route[2] -= 2.0 * GETTING_NEARER
    turned = [look(crowd, 2.0 * PATIENCE, rng, rows=[0, 2, 3]) != 0.0 for _ in range(200)]
    assert np.any(turned, axis=0).tolist() == [True, False, False, True]


def test_people_who_wait_are_patient():
    crowd = people()
    crowd.agenda["waits_until"] = 900  # 30 s
    for elapsed in (0.0, 10.0, 29.0, 30.0, 30.0 + PATIENCE - 0.1):
        assert untouched(crowd, elapsed)
    assert not untouched(crowd, 30.0 + PATIENCE + 0.1)


# -- in a model ---------------------------------------------------------------------------------


def drawn(model, before) -> bool:
    return model.rng.bit_generator.state != before


def aim(person) -> tuple[float, float]:
    return tuple((person.target - person.position).tolist())


def test_who_cannot_move_is_turned_in_the_default_preset():
    model = model_of(corridor(), statues(), rng=3)
    person = put(model, 1.0, 2.0, preferred_speeds=1.25)
    before, straight_on = model.rng.bit_generator.state, aim(person)
    advance(model, round(30 * PATIENCE))
    assert (drawn(model, before), aim(person)) == (False, straight_on)
    aims = []
    for _ in range(100):
        advance(model, 12)
        aims.append(aim(person))
        assert math.hypot(*aims[-1]) == pytest.approx(math.hypot(*straight_on))
    assert drawn(model, before)
    assert any(each != straight_on for each in aims)


def test_nobody_is_turned_in_the_papers_preset():
    rooted = make_map([[straight(0.0, 45, to=0)]])
    model = model_of(corridor(), rooted, preset="paper", rng=3)
    person = put(model, 1.0, 2.0, preferred_speeds=1.25)
    before, straight_on = model.rng.bit_generator.state, aim(person)
    advance(model, 900)
    assert (drawn(model, before), aim(person)) == (False, straight_on)


@pytest.mark.parametrize("how", ["at once", "pre-movement", "wait", "wait until"])
def test_a_person_who_makes_progress_after_setting_off_draws_nothing(how):
    model = model_of(corridor(), strider(), rng=3)
    ready = 6.0 * PATIENCE
    waits = {"pre_movement": ready} if how == "pre-movement" else {}
    person = put(model, 1.0, 2.0, preferred_speeds=1.25, **waits)
    before = model.rng.bit_generator.state
    if how == "wait":
        person.wait(ready)
    if how == "wait until":
        person.wait(until=lambda: model.elapsed >= ready)
    model.run(120.0)
    assert model.inside == 0
    assert not drawn(model, before)
    # 19 m at 1.25 m/s, and what it takes to set off.
    late = 0.0 if how == "at once" else ready
    assert model.statistics.last_left - late == pytest.approx(15.2, abs=0.9)
