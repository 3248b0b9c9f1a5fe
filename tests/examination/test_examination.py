"""What people of a map cannot do is found, kept in the map, and said before it is used."""

import warnings

import numpy as np
import pytest

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.examination import Finding, examine, examined
from mesa_mobility.examination.examining import COVERAGE, with_findings
from mesa_mobility.examination.gaits import slowly, stop
from mesa_mobility.examination.subject import Subject
from mesa_mobility.examination.ways import corner, door, turn
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.mobility.judging.verdict import failed_tests, with_verdict
from tests.fixtures.maps import make_map, shipped_map, stand, straight

SHARE = "share_within_15cm_20deg"


def marcher():
    """Sets off at once at 1.25 m/s, straight on, and stops; never turns nor steps aside."""
    on = (straight(0.5, 12), straight(1.0, 24), straight(1.875, 45))
    return make_map([(stand(), *on), (*on, stand())], core_radius=0.14)


@pytest.mark.thorough
def test_a_marcher_fails_what_takes_turns_and_walks_straight_on():
    subject = Subject.of(marcher())
    found = {test.__name__: test(subject) for test in (door, corner, turn)}
    assert [name for name, each in found.items() if each.passed] == []
    # Of 21 starts one is straight before the door; the others face its wall or along it.
    assert found["door"].measured == {
        "starts": 21,
        "in_time": 1,
        "slowest_s": pytest.approx(4, abs=1),
    }
    assert found["corner"].measured["in_time"] == 0
    assert "in time 1" in found["door"].warning
    assert "add recordings of people who sidestep" in found["door"].warning


@pytest.mark.thorough
def test_somebody_who_cannot_walk_slowly_is_found():
    # Preferred speeds are those of adults, 1.34 m/s in the median; shares of steps walk slower.
    slow = slowly(Subject.of(marcher()))
    assert slow.measured["slow_m_s"] == 0.5
    assert slow.measured["own_m_s"] == pytest.approx(1.34)


@pytest.mark.thorough
def test_stops_within_reach_of_the_point():
    found = stop(Subject.of(shipped_map()))
    assert found.passed
    assert found.measured["stood_s"] >= 4.0
    assert found.measured["from_the_point_m"] <= 0.5


def test_poor_coverage_fails_and_stays_known_without_the_recordings(monkeypatch):
    monkeypatch.setattr("mesa_mobility.examination.examining.TESTS", ())
    poor = examined(marcher(), {"poses": 699, SHARE: 0.6466, "endpoint_error_m": {}})
    assert failed_tests(poor) == {COVERAGE: {"poses": 699, SHARE: 0.647}}
    (again,) = examine(poor)
    assert not again.passed
    assert failed_tests(examined(marcher(), {"poses": 699, SHARE: 0.9})) == {}
    assert examine(marcher()) == ()


def model_of(map_):
    floor, exits = "POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))", [Exit("door", (6, 1), (6, 3))]
    return PedestrianModel(FloorPlan(floor, exits=exits), mobility_map=map_)


def never_examined():
    map_ = marcher()
    del map_.metadata["examination"]
    return map_


@pytest.mark.parametrize(
    ("map_", "says"),
    [
        (never_examined(), "has never been examined"),
        (
            with_verdict(marcher(), {"door": {}, "crowd": {}}),
            r"failed its examination \(door, crowd\)",
        ),
    ],
)
def test_a_model_warns_before_such_a_map_is_used(map_, says):
    with pytest.warns(UserWarning, match=says) as caught:
        model_of(map_)
    assert len(caught) == 1


def test_models_of_maps_that_passed_say_nothing():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model_of(with_verdict(marcher(), {}))
        model_of(None)


@pytest.mark.parametrize("said", [None, [], {"failed": 3}, {"passed": []}])
def test_what_is_no_verdict_is_none(said):
    map_ = marcher()
    map_.metadata["examination"] = said
    assert failed_tests(map_) is None


def test_the_verdict_goes_into_the_file(tmp_path):
    found = [
        Finding("door", "", {"in_time": 3}, "", False, ""),
        Finding("turn", "", {}, "", True, ""),
    ]
    with_findings(marcher(), found).save(tmp_path / "a.npz")
    assert failed_tests(MobilityMap.load(tmp_path / "a.npz")) == {"door": {"in_time": 3}}


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["able_bodied", "limping_left", "wheelchair_manual"])
def test_maps_that_ship_pass(name):
    assert [each.warning for each in examine(MobilityMap.named(name)) if not each.passed] == []


@pytest.mark.captures
@pytest.mark.slow
def test_runners_get_through_a_door(captures_dir):
    """They set off abruptly and kept no step aside; alone, they stayed beside a door."""
    from mesa_mobility.capture import find_clips
    from mesa_mobility.mobility import build_map, prepare_recordings

    prepared = prepare_recordings(find_clips(captures_dir), "running")
    found = door(Subject.of(build_map(prepared.recordings, type_name="running")))
    assert found.measured["in_time"] == 21
    assert np.isfinite(found.measured["slowest_s"])
