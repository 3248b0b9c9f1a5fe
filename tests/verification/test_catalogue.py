import pytest

from mesa_mobility.errors import ModelError
from mesa_mobility.verification import catalogue, suite


def test_the_catalogue_has_39_tests_of_a_level_floor_12_of_stairs_and_one_of_lifts():
    entries = catalogue()
    standards = [name.partition("-")[0] for name in entries]
    counts = {name: standards.count(name) for name in ("rimea", "imo", "nist", "iso")}
    assert counts == {"rimea": 21, "imo": 12, "nist": 15, "iso": 4}
    stairs = [name for name, entry in entries.items() if entry.applies == "stairs"]
    assert len(stairs) == 12
    assert [name for name, entry in entries.items() if entry.applies == "lifts"] == ["nist-2.7"]
    assert all(entry.applies in ("flat", "flat*", "stairs", "lifts") for entry in entries.values())
    assert [name for name, entry in entries.items() if entry.cap] == ["imo-04"]
    assert all(entry.criterion and entry.source and entry.what for entry in entries.values())


def test_every_test_of_the_catalogue_runs_and_has_one_judge():
    assert list(suite()) == list(catalogue())
    for test in suite().values():
        assert test.cases
        assert (test.judge is None) != (test.pooled is None)


def test_tests_are_chosen_by_id_in_the_order_of_the_catalogue():
    assert list(suite(["imo-01", "rimea-01", "imo-01"])) == ["rimea-01", "imo-01"]


def test_an_unknown_id_is_said_with_what_there_is():
    with pytest.raises(ModelError, match=r"unknown test 'imo-99', did you mean 'imo-0\d'\?.*rimea"):
        suite(["imo-01", "imo-99"])
