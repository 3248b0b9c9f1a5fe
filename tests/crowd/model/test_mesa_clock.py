"""Mesa's time is in seconds, and Mesa's other agents live in a model as people do."""

import copy

import mesa
import pytest

from mesa_mobility import Pedestrian, PedestrianModel
from tests.fixtures.maps import strider
from tests.fixtures.scenes import corridor, model_of, put

with_events = pytest.mark.skipif(
    not hasattr(mesa.Model, "run_for"), reason="Mesa has events from 3.5 on"
)


def walker(frames_per_step=3, x=2.0, **keywords):
    """Somebody who leaves the corridor at x = 20 m, at 1.25 m/s."""
    model = model_of(corridor(), strider(), frames_per_step=frames_per_step, **keywords)
    put(model, x, 1.0, preferred_speeds=[1.25])
    return model


class Clock(mesa.Agent):
    """An agent that is nobody; it notes the time, and what people have done."""

    def __init__(self, model):
        super().__init__(model)
        self.seen = []

    def step(self):
        self.seen.append((self.model.time, self.model.frame))


@pytest.mark.parametrize("frames_per_step", [1, 3, 7])
def test_time_is_in_seconds(frames_per_step):
    model = walker(frames_per_step)
    assert model.time == 0.0
    for k in range(1, 31):
        model.step()
        assert model.steps == k
        assert model.time == model.elapsed == pytest.approx(k * frames_per_step / 30)


def test_time_ends_with_the_last_frame_of_a_step_that_ends_early():
    model = walker(30, x=19.0)
    model.step()
    # A metre at 1.25 m/s: 0.8 s.  Without people a step takes its time.
    assert model.inside == 0
    assert model.time == model.elapsed == pytest.approx(0.8, abs=0.05)
    model.step()
    assert model.time == model.elapsed == pytest.approx(1.8, abs=0.05)


def test_frames_of_a_step_may_change():
    model = walker(3)
    model.step()
    model.frames_per_step = 15
    model.step()
    model.step()
    # The step after a change may already have been laid down at its old time.
    assert model.frame == 3 + 15 + 15
    assert model.time == model.elapsed == pytest.approx(1.1)


def test_a_copy_and_a_checkpoint_keep_the_time(tmp_path):
    model = walker()
    for _ in range(7):
        model.step()
    model.save(tmp_path / "model.zip")
    twins = [
        copy.deepcopy(model),
        PedestrianModel.load(tmp_path / "model.zip", pedestrian_types=model.pedestrian_types),
    ]
    for twin in twins:
        assert twin.time == model.time
    for each in (model, *twins):
        each.step()
        assert each.time == each.elapsed == pytest.approx(0.8)


@with_events
@pytest.mark.parametrize("frames_per_step", [1, 3, 7])
def test_mesas_run_for_takes_seconds(frames_per_step):
    model = walker(frames_per_step)
    model.run_for(5)
    assert model.steps == 150 // frames_per_step
    assert model.frame == 150 // frames_per_step * frames_per_step
    assert model.time == 5.0
    model.run_until(7.0)
    assert model.frame == 210 // frames_per_step * frames_per_step


@with_events
def test_tenths_of_seconds_add_up():
    model = walker(3)
    for _ in range(100):
        model.run_for(0.1)
    assert model.frame == 300


@with_events
def test_events_come_at_their_second():
    model, at = walker(3), []

    def note():
        at.append((model.time, model.frame))

    for second in (0.05, 0.25, 1.0):
        model.schedule_event(note, at=second)
    model.run_for(2.0)
    assert at == [(0.05, 0), (0.25, 6), (1.0, 30)]


def test_agents_of_other_classes_are_stepped_before_anybody_moves():
    model = walker(3)
    clock = Clock(model)
    for _ in range(3):
        model.step()
    assert [frame for _, frame in clock.seen] == [0, 3, 6]
    assert [time for time, _ in clock.seen] == pytest.approx([0.0, 0.1, 0.2])


def test_what_other_agents_do_counts_for_people_in_the_same_step():
    order = []

    class Talks(Pedestrian):
        def step(self):
            order.append("person")

    class Alarm(mesa.Agent):
        def step(self):
            order.append("alarm")
            self.remove()

    class Twin(mesa.Agent):
        """Each removes the other, so that one of them is never stepped."""

        def step(self):
            order.append("twin")
            for each in list(self.model.agents_by_type[Twin]):
                each.remove()

    model = walker(pedestrian_class=Talks)
    Alarm(model), Twin(model), Twin(model)
    model.step()
    model.step()
    assert order == ["alarm", "twin", "person", "person"]


def test_other_agents_change_nothing_of_how_people_walk():
    plain, other = walker(), walker()
    Clock(other)
    for model in (plain, other):
        model.step()
    assert plain.agents_by_type[Pedestrian][0].position.tolist() == (
        other.agents_by_type[Pedestrian][0].position.tolist()
    )
