"""Arguments of calibrations: what is refused, in one line, before anything is run."""

import math
from functools import partial
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.calibration import Distance, Free, HeldOut, Search, Seeds, calibrate
from mesa_mobility.calibration.names import called, measured, measured_of, name_of
from mesa_mobility.errors import MobilityError, ModelError
from tests.fixtures.engine import ENGINE
from tests.fixtures.experiments import calibrations as fixture

pytest.importorskip("cmaes", reason="needs the extra calibration")

FREE = Free("headway.time", 0.2, 3.0)


def local(seed):
    """Has a name by which it can be found."""


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"scenarios": {}}, "scenarios: got {}, expected functions or models by name"),
        ({"scenarios": {"seen": "doorwy"}}, "unknown model 'doorwy', did you mean 'doorway'?"),
        ({"scenarios": {"seen": lambda seed: 1}}, "<lambda> cannot be found by its name"),
        ({"scenarios": {"seen": partial(local, Path("a"))}}, "is given PosixPath('a'), expected"),
        ({"data": {"sen": 1}}, "data: no scenario 'sen', did you mean 'seen'?"),
        ({"data": {}}, "data: lacks scenario 'seen', expected all scenarios"),
        ({"data": {"seen": HeldOut(1)}}, "data: all are held out, expected some that the search"),
        ({"data": {"seen": {1, 2}}}, "data of seen: got {1, 2}, expected a Path, a function"),
        ({"data": {"seen": math.nan}}, "data of seen: got nan, expected a Path"),
        ({"data": {"seen": [0.5] * 9999}}, "data of seen: has 50006 characters, expected at most"),
        ({"data": {"seen": Path("none.txt")}}, "none.txt: cannot be read: No such file"),
        ({"distances": []}, "distances: got none, expected functions"),
        ({"distances": fixture.relative}, "expected a list of functions"),
        ({"distances": [3]}, "distances: got 3, expected a function"),
        ({"distances": [fixture.relative] * 2}, "distances: two are named 'relative', expected"),
        ({"distances": {"sen": [fixture.relative]}}, "distances: no scenario 'sen', did you mean"),
        ({"free": []}, "free: got [], expected a list such as ['headway.time']"),
        ({"free": "headway.time"}, "free: got 'headway.time', expected a list"),
        ({"free": [FREE, FREE]}, "free: headway.time is there twice"),
        ({"free": ["headwy.time"]}, "free: unknown parameter 'headwy.time', did you mean"),
        ({"free": ["headway.time"]}, "free: headway.time has no high end, expected Free("),
        ({"free": ["headway.weight"]}, "free: headway.weight has no low end, expected Free("),
        ({"free": [Free("headway.time", -1.0, 2.0)]}, "headway.time: -1.0, expected more than 0 s"),
        ({"free": [Free("headway.time", 2.0, 3.0)]}, "headway.time starts at 1.2, not in 2.0 to 3"),
        ({"free": [Free("keep_distance.tim", 1, 3, 2)]}, "unknown parameter 'keep_distance.tim', "),
        ({"search": Search(preset="defalt")}, "preset 'defalt' is unknown, did you mean 'default'"),
        ({"seeds": 0}, "seeds: each is 0, expected a whole number, 1 or more"),
        ({"executor": "threads"}, "executor is 'threads', expected serial, processes, dask"),
    ],
)
def test_what_is_refused(changes, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = {
        "scenarios": {"seen": fixture.rules},
        "data": {"seen": {"time": 1.0}},
        "free": [FREE],
        "distances": [fixture.relative],
        "search": Search(preset=ENGINE),
        "store": tmp_path / "store",
        "executor": "serial",
        **changes,
    }
    with pytest.raises(MobilityError) as no:
        calibrate(**words)
    assert said in str(no.value)
    assert "\n" not in str(no.value)
    assert not (tmp_path / "store" / "preset.toml").exists()


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Free("headway", 1, 2), "free: name 'headway', expected such as 'headway.time'"),
        (lambda: Free("a.b", 2, 1), "free: a.b from 2 to 1, expected a range"),
        (lambda: Free("a.b", 0, math.inf), "free: high of a.b is inf, expected a number"),
        (lambda: Free("a.b", 1, 2, 3), "free: a.b starts at 3, not in 1 to 2"),
        (lambda: Free("a.b", 0, 2, log=True), "a.b from 0 on has no logarithm, expected low > 0"),
        (lambda: Distance(fixture.relative, 0.0), "weight of relative is 0.0, expected more"),
        (lambda: Seeds(held_out=0), "seeds: held_out is 0, expected a whole number, 1 or more"),
        (lambda: Seeds(first=-1), "seeds: first is -1, expected a whole number, 0 or more"),
        (lambda: Search(0), "search: evaluations is 0, expected a whole number, 1 or more"),
        (lambda: Search(candidates=3), "candidates is 3, expected a whole number, 4 or more"),
        (lambda: Search(spread=2.0), "search: spread is 2.0, expected more than 0, at most 1"),
        (lambda: Search(max_seconds=0.0), "search: max_seconds is 0.0, expected seconds, or None"),
    ],
)
def test_settings_out_of_range(make, said):
    with pytest.raises(ModelError) as no:
        make()
    assert said in str(no.value)


@pytest.mark.parametrize("change", ["free", "distances", "seeds", "search", "data", "preset"])
def test_a_store_is_of_one_calibration(tmp_path, change):
    words = {
        "scenarios": {"seen": fixture.rules},
        "data": {"seen": {"time": 1.0}},
        "free": [FREE],
        "distances": [fixture.relative],
        "seeds": Seeds(held_out=1),
        "search": Search(evaluations=4, preset=ENGINE),
        "store": tmp_path / "store",
        "executor": "serial",
    }
    calibrate(**words)
    changed = {
        "free": {"free": [Free("headway.time", 0.3, 3.0)]},
        "distances": {"distances": [Distance(fixture.relative, 2.0)]},
        "seeds": {"seeds": Seeds(held_out=2)},
        "search": {"search": Search(evaluations=4, spread=0.3, preset=ENGINE)},
        "data": {"data": {"seen": {"time": 2.0}}},
        "preset": {
            "search": Search(evaluations=4, preset="paper"),
            "free": [Free("headway.time", 0.2, 3.0, start=1.2)],
        },
    }[change]
    names = {"data": "scenarios", "distances": "scenarios"}
    with pytest.raises(ModelError) as no:
        calibrate(**words | changed)
    said = f"holds a calibration with other {names.get(change, change)}, expected another store"
    assert str(no.value) == f"{tmp_path / 'store'}: {said}"
    (tmp_path / "store" / "calibration.json").write_text("{}")
    with pytest.raises(MobilityError, match=r"calibration\.json: damaged: 'format_version'"):
        calibrate(**words)


plain = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text()
NUMBERS = {"allow_nan": False, "allow_infinity": False}


@given(st.lists(plain, max_size=3), st.dictionaries(st.sampled_from("abc"), plain, max_size=2))
def test_functions_are_found_by_their_names_with_their_arguments(arguments, keywords):
    found = called(name_of(partial(fixture.rules, *arguments, **keywords), "any"))
    if not arguments and not keywords:
        assert found is fixture.rules
        return
    assert found.func is fixture.rules
    assert (list(found.args), found.keywords) == (arguments, keywords)


values = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**53), 2**53) | st.floats(**NUMBERS) | st.text(),
    lambda of: st.lists(of, max_size=3) | st.dictionaries(st.text(max_size=5), of, max_size=3),
    max_leaves=10,
)


@given(values)
def test_measured_values_reach_distances_as_they_are(value):
    assert measured(measured_of(value, "any").text) == value


def test_measured_files_reach_distances_as_paths_or_as_what_a_function_reads(tmp_path):
    file = tmp_path / "some.txt"
    file.write_text("time 0.5\n")
    found = measured_of(file, "any")
    assert measured(found.text) == file
    assert list(found.files) == ["some.txt"]
    for reader in (fixture.Reader.read, fixture.read_numbers):
        assert measured(measured_of(partial(reader, str(file)), "any").text) == {"time": 0.5}


@given(st.floats(1e-3, 1e3), st.floats(1e-3, 1e3), st.floats(0.0, 1.0), st.booleans())
def test_places_and_values_of_a_free_number_are_inverse_and_rise(low, width, place, log):
    free = Free("a.b", low, low + width, log=log)
    value = free.value(place)
    assert low <= value <= low + width
    assert (free.value(0.0), free.value(1.0)) == (low, pytest.approx(low + width))
    if width > 1e-2 * low:
        assert free.place(value) == pytest.approx(place, abs=1e-6)
    # Halfway is the mean, or the geometric mean.
    middle = math.sqrt(low * (low + width)) if log else low + width / 2.0
    assert free.value(0.5) == pytest.approx(middle)
    assert free.value(place / 2.0) <= value
