import importlib
import os
from pathlib import Path

import pytest

from mesa_mobility.verification import case, run_cases

FOLDER = Path(__file__).parents[1] / "fixtures" / "cases"


@pytest.fixture
def timeless(monkeypatch):
    """Scenarios that processes of their own can import: they get this one's path."""
    monkeypatch.syspath_prepend(str(FOLDER))
    return importlib.import_module("timeless_cases")


def test_equal_cases_are_one_whatever_effort_they_are_said_to_take(timeless):
    product = timeless.product
    assert case(product, factor=2.0, effort=5.0) == case(product, factor=2.0)
    assert case(product, factor=2.0) != case(product, factor=3.0)
    assert str(case(product, factor=2.0)) == "product(factor 2.0)"


def test_each_case_runs_once_a_seed_in_processes_of_one_thread(timeless):
    product = timeless.product
    cases = [case(product, factor=2.0), case(product, factor=3.0), case(product, factor=2.0)]
    reports = []
    results = run_cases(cases, [5, 7], 1, lambda what, done, total: reports.append((done, total)))
    assert {(str(c), seed): figures["product"] for (c, seed), figures in results.items()} == {
        ("product(factor 2.0)", 5): 10.0,
        ("product(factor 2.0)", 7): 14.0,
        ("product(factor 3.0)", 5): 15.0,
        ("product(factor 3.0)", 7): 21.0,
    }
    assert {figures["threads"] for figures in results.values()} == {"1"}
    assert reports == [(0.0, 4.0), (1.0, 4.0), (2.0, 4.0), (3.0, 4.0), (4.0, 4.0)]


def test_a_case_that_breaks_says_so_and_the_others_run(timeless):
    broken, product = timeless.broken, timeless.product
    results = run_cases([case(broken), case(product, factor=1.0)], [3], 1)
    assert results[case(broken), 3] == {"error": "ValueError: no luck with 3"}
    assert results[case(product, factor=1.0), 3]["product"] == 3.0


def test_the_callers_own_number_of_threads_stays(monkeypatch):
    monkeypatch.setenv("NUMBA_NUM_THREADS", "2")
    run_cases([], [], 1)
    assert os.environ["NUMBA_NUM_THREADS"] == "2"
    monkeypatch.delenv("NUMBA_NUM_THREADS")
    run_cases([], [], 1)
    assert "NUMBA_NUM_THREADS" not in os.environ


@pytest.mark.slow
def test_results_do_not_depend_on_the_number_of_processes():
    from mesa_mobility.verification import suite, verify

    tests = suite(["rimea-06", "imo-04"])
    assert verify(tests, [1, 2], 1) == verify(tests, [1, 2], 2)
