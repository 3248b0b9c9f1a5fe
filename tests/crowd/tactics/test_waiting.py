"""People with a waiting time stand until it is over."""

import numpy as np
import pytest

from mesa_mobility import Tactic
from mesa_mobility.crowd.planning.explanation import Watch
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import overlaps, track
from tests.fixtures.scenes import advance, core_of, corridor, model_of, put


def still(model, person):
    """Seconds in which a person does not move, from the first to the last of them."""
    rows = track(model.recorder.arrays(), person.row)
    stands = np.hypot(*np.diff(rows[:, 1:3], axis=0).T) < 1e-9
    frames = rows[1:, 0][stands]
    return (frames[0] - 1) / 30, frames[-1] / 30


def test_waits_for_a_time_and_goes_on():
    model = model_of(corridor(), strider())
    person = put(model, 2.0, 2.0, preferred_speeds=[1.25])
    advance(model, 10)
    person.wait(5.0)
    assert person.waiting
    model.run(max_seconds=30)
    # The movement under way ends after 45 frames; stands of 12 frames from there on.
    first, last = still(model, person)
    assert first == pytest.approx(1.5)
    assert 10 / 30 + 5.0 <= last <= 10 / 30 + 5.0 + 0.4
    assert not person.waiting
    assert model.inside == 0


def test_waits_until_something_is_so():
    model = model_of(corridor(), strider())
    person = put(model, 2.0, 2.0, preferred_speeds=[1.25])
    person.wait(until=lambda: model.elapsed >= 70.0)
    model.run(max_seconds=200)
    assert not model.stalled
    assert person.start_time == 0.0
    assert still(model, person) == pytest.approx((0.0, 70.0), abs=0.41)


def test_the_last_of_several_waits_counts():
    model = model_of(corridor(), strider())
    person = put(model, 2.0, 2.0)
    person.wait(until=lambda: False)
    advance(model, 30)
    person.wait(0.0)
    assert not person.waiting
    advance(model, 45)
    assert person.position[0] > 2.0


class HoldUntil(Tactic):
    """Whoever is beyond x = 3 m waits until 70 s."""

    name = "hold_until"

    def __init__(self, by_index):
        self.by_index = by_index
        self.seen = []

    def apply(self, deciding, desired):
        self.seen.append((deciding.elapsed, deciding.waiting.tolist()))
        beyond = deciding.positions[:, 0] > 3.0
        if not desired.newcomers and deciding.elapsed < 70.0:
            deciding.hold(desired, np.flatnonzero(beyond) if self.by_index else beyond)


@pytest.mark.parametrize("by_index", [False, True])
def test_a_behaviour_may_hold_people(by_index):
    model = model_of(corridor(), strider())
    hold = HoldUntil(by_index)
    model.add_tactic(hold)
    person = put(model, 2.0, 2.0, preferred_speeds=[1.25])
    model.run(max_seconds=30)
    assert person.waiting
    # It is patient: for 28 s it has looked for no way round, nor turned.
    assert person.target.tolist() == pytest.approx(person.position.tolist())
    model.run(max_seconds=200)
    assert not model.stalled
    first, last = still(model, person)
    assert first == pytest.approx(1.5)
    assert last == pytest.approx(70.0, abs=0.41)
    assert model.inside == 0
    # At its next decisions the hold of the last one is over: behaviours hold people anew.
    assert not any(waits for _, [waits] in hold.seen)


class LookBack(Tactic):
    """Everybody waits, and turns to the left end of the corridor."""

    name = "look_back"
    after = "speed_rules"

    def apply(self, deciding, desired):
        everybody = np.arange(len(deciding.pedestrians))
        if not desired.newcomers:
            back = np.column_stack([np.zeros(len(everybody)), deciding.positions[:, 1]])
            deciding.hold(desired, everybody, facing=back)


def test_people_who_are_held_turn_to_what_they_are_to_face():
    model = model_of(corridor(), shipped_map(), frames_per_step=3)
    model.add_tactic(LookBack())
    person = put(model, 5.0, 2.0, heading=np.pi / 2)
    model.run(max_seconds=8)
    # From 90 degrees off to next to nothing, on the spot.
    assert np.cos(person.heading) < np.cos(np.radians(150.0))
    assert np.hypot(*(person.position - (5.0, 2.0))) < 0.5


def test_behaviours_see_who_waits():
    model = model_of(corridor(), strider())
    hold = HoldUntil(by_index=False)
    model.add_tactic(hold)
    person = put(model, 1.0, 2.0, preferred_speeds=[1.25])
    person.wait(3.0)
    model.run(max_seconds=4)
    waits = {round(elapsed, 6): waits for elapsed, [waits] in hold.seen if elapsed > 0.0}
    assert all(waits == (elapsed < 3.0) for elapsed, waits in waits.items())
    assert set(waits.values()) == {True, False}


def test_the_same_whatever_a_step_is():
    ends = []
    for frames_per_step in (1, 4):
        model = model_of(corridor(), shipped_map(), rng=3, frames_per_step=frames_per_step)
        person = put(model, 2.0, 2.0)
        person.wait(until=lambda model=model: model.elapsed > 1.9)
        advance(model, 120)
        ends.append(person.position.tolist())
    assert ends[0] == ends[1]


def test_others_walk_round_somebody_who_waits_and_it_stays_in_its_place():
    model = model_of(corridor(width=2.5), shipped_map(), rng=3, frames_per_step=3)
    (person,) = model.add_pedestrians([(8.0, 1.25)])
    person.wait(40.0)
    model.add_pedestrians([(1.0 + 0.6 * k, 0.6 + 0.6 * j) for k in range(4) for j in range(3)])
    model.run(max_seconds=90)
    assert model.inside == 0
    rows = model.recorder.arrays()
    assert overlaps(rows, core_of(model)) == 0
    path = track(rows, person.row)
    waiting = path[path[:, 0] < 40 * 30]
    assert np.abs(waiting[:, 1:3] - (8.0, 1.25)).max() < 0.25


@pytest.mark.parametrize(
    "keywords",
    [{}, {"seconds": 1.0, "until": bool}, {"seconds": -1.0}, {"seconds": np.inf}, {"until": 5.0}],
)
def test_waits_that_cannot_be(keywords):
    model = model_of(corridor(), strider())
    person = put(model, 2.0, 2.0)
    with pytest.raises(ModelError, match="wait"):
        person.wait(**keywords)
    assert not person.waiting


def test_people_who_wait_do_not_turn_round_and_round():
    # To go nowhere, all ways to face cost the same, and the map has turns on the spot.
    model = model_of(corridor(), shipped_map(), rng=1)
    person = put(model, 2.0, 2.0)
    person.wait(60.0)
    advance(model, 600)
    headings = track(model.recorder.arrays(), person.row)[:, 3]
    assert np.ptp(headings) < np.radians(1.0)
    assert model.explain(person.row).chosen >= 0


def test_the_description_of_a_waiting_person_is_true():
    model = model_of(corridor(), shipped_map(), rng=1)
    person = put(model, 2.0, 2.0)
    person.wait(60.0)
    advance(model, 30)
    model.watch = Watch(person.row)
    advance(model, 60)
    taken = model.watch.decision
    assert taken.taken
    free = np.flatnonzero(taken.totals == taken.totals.min())
    turns = np.abs(taken.paths[free, 2, -1] - taken.candidates.facings[0])
    assert len(free) > 1
    assert taken.chosen in free[turns < turns.min() + 1e-6]
