"""The thread of a served model: commands between steps, and its end."""

import threading

import pytest

from mesa_mobility.live.run import Engine, Run
from tests.fixtures.waiting import until
from tests.live.conftest import walkers


@pytest.fixture
def engine():
    """An engine, what it has published, and what has failed."""
    published, failed = [], []
    made = Engine(Run(walkers()), 30, published.append, failed.append)
    made.published, made.failures = published, failed
    made.start()
    yield made
    made.close()
    made.join()


def plays(run):
    run.set_playing(True)
    return {"frame": run.model.frame}


def test_time_stands_still_until_it_is_let_go(engine):
    until(lambda: engine.published)
    assert [each.frame.paused for each in engine.published] == [True]
    assert engine.post(plays).result(20) == {"frame": 0}
    until(lambda: engine.published[-1].frame.frame > 2)


def test_a_command_that_fails_tells_who_gave_it_alone(engine):
    with pytest.raises(ZeroDivisionError):
        engine.post(lambda run: 1 / 0).result(20)
    assert engine.post(plays).result(20) == {"frame": 0}
    assert engine.failures == []


def test_no_number_of_commands_keeps_time_from_going_by(engine):
    engine.post(plays).result(20)
    stop = threading.Event()

    def flood():
        while not stop.is_set():
            engine.post(lambda run: {}).result(20)

    threads = [threading.Thread(target=flood) for _ in range(3)]
    for each in threads:
        each.start()
    try:
        until(lambda: engine.published[-1].frame.frame > 10)
    finally:
        stop.set()
        for each in threads:
            each.join()


def test_nobody_waits_for_an_engine_that_has_ended(engine):
    engine.close()
    engine.join()
    assert engine.post(plays).cancelled()


def test_commands_that_wait_while_a_step_fails_are_cancelled(engine):
    going, fail = threading.Event(), threading.Event()

    def step():
        going.set()
        fail.wait(20)
        raise ZeroDivisionError

    def command(run):
        run.model.step = step
        return plays(run)

    engine.post(command).result(20)
    going.wait(20)
    late = engine.post(plays)
    fail.set()
    engine.join()
    assert late.cancelled()
    assert [type(each) for each in engine.failures] == [ZeroDivisionError]
