"""One way to do many runs: results, errors, deaths and ends."""

import os
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from mesa_mobility.runs.choice import workers_for
from mesa_mobility.runs.jobs import Failed, in_flight, run_jobs
from mesa_mobility.runs.workers import Futures, Processes, Serial


def square(number):
    if number == 3:
        raise ValueError("three\nis too many")
    return number * number


def doomed(number):
    if number == 2:
        os._exit(1)
    return os.getpid()


def napping(seconds):
    time.sleep(seconds)
    return seconds


def threads(count):
    pool = ThreadPoolExecutor(count)
    return Futures(pool.submit, count, own_processes=False)


@pytest.mark.parametrize("make", [Serial, lambda: Processes(2), lambda: threads(3)])
def test_results_are_the_same_whatever_does_the_jobs(make):
    found = dict(run_jobs(square, range(5), make()))
    assert found == {0: 0, 1: 1, 2: 4, 3: Failed("ValueError: three is too many"), 4: 16}


def test_a_process_that_dies_takes_no_other_job_along():
    found = dict(run_jobs(doomed, range(6), Processes(2)))
    assert found.pop(2) == Failed("its process died")
    assert all(isinstance(each, int) for each in found.values())
    assert len(set(found.values())) > 1
    assert os.getpid() not in found.values()


def test_a_job_is_taken_when_a_worker_is_free_and_told_as_soon_as_it_has_ended():
    taken = []

    def jobs():
        for seconds in (1.0, 0.0, 0.1, 0.2):
            taken.append(seconds)
            yield seconds

    found = []
    for job, _ in run_jobs(napping, jobs(), threads(2)):
        found.append(job)
        # One is done, and one more is being done by the other worker.
        assert len(taken) <= len(found) + 1
    assert found == [0.0, 0.1, 0.2, 1.0]


def test_whoever_stops_taking_results_ends_the_processes():
    workers = Processes(2)
    began = time.monotonic()
    for _ in run_jobs(napping, [0.0, 60.0, 60.0], workers):
        break
    assert time.monotonic() - began < 30.0
    for pool in workers._pools:
        assert not pool._processes


def test_a_caller_is_told_while_nothing_ends(monkeypatch):
    monkeypatch.setattr("mesa_mobility.runs.jobs.POLL_S", 0.05)
    jobs = iter([0.4])
    told = list(in_flight(napping, lambda: next(jobs, None), threads(1)))
    assert told[-1] == [(0.4, 0.4)]
    assert told[:-1] == [[]] * (len(told) - 1)
    assert len(told) > 2


def test_jobs_may_come_back_where_one_has_ended():
    jobs, done = [3, 1], []
    for ended in in_flight(square, lambda: jobs.pop() if jobs else None, Serial(), each=2):
        for job, answer in ended:
            done.append(job)
            if isinstance(answer, ValueError):
                jobs.append(2)
    assert done == [1, 3, 2]


def test_no_jobs_start_no_process():
    workers, closing = workers_for("processes", 2)
    with closing:
        assert list(run_jobs(square, [], workers)) == []
        assert all(not pool._processes for pool in workers._pools)
