"""`mesa-mobility map info` and `map coverage`."""

from tests.commands.maps.conftest import last_line


def test_the_map_says_how_it_was_made(command, recordings, map_file):
    answer = last_line(command("map", "info", map_file, "--json"))
    assert answer["command"] == (
        f"mesa-mobility map build {recordings.name} -o able_bodied.npz --type able_bodied "
        "--clusters 12"
    )
    assert {clip["clip"] for clip in answer["provenance"]} == {"slow", "brisk"}


def test_what_people_of_a_map_can_do_is_said(command, recordings, map_file):
    outcome = command("map", "info", map_file, "--json")
    answer = last_line(outcome)
    # The figure only walks straight on.
    assert answer["standing"] == (
        "turning on the spot and steps aside and back borrowed from the map 'able_bodied'"
    )
    assert answer["standing"] in outcome.err
    assert min(answer["abilities"]["turn_on_the_spot_deg"]) >= 30
    assert answer["warnings"] == []
    # It walks at 1 and 1.3 m/s, and starts and stops.
    assert 0.9 < answer["walking_speed_m_s"]["p75"] < 1.35


def test_info_for_people_to_read(command, map_file):
    outcome = command("map", "info", map_file)
    assert outcome.status == 0
    lines = [" ".join(line.split()) for line in outcome.out.splitlines()]
    assert "clusters 12" in lines
    assert "build: durations frames 12, 24, 45" in lines
    assert "provenance 2 entries, see --json" in lines


def test_coverage_of_recordings_the_map_was_built_from(command, recordings, map_file):
    outcome = command("map", "coverage", map_file, recordings, "--json")
    answer = last_line(outcome)
    # 270 - 45 poses of two clips have 45 frames to come.
    assert answer["poses"] == 2 * (270 - 45)
    assert set(answer["endpoint_error_m"]) == {"median", "p90", "p95"}
    # Their own movements are among the options.
    assert answer["endpoint_error_m"]["median"] < 0.05
    assert 0.9 < answer["share_within_15cm_20deg"] <= 1.0


def test_coverage_takes_several_recordings(command, recordings, map_file):
    one = last_line(command("map", "coverage", map_file, recordings / "slow.bvh", "--json"))
    both = last_line(
        command(
            "map", "coverage", map_file, recordings / "slow.bvh", recordings / "brisk.bvh", "--json"
        )
    )
    assert (one["poses"], both["poses"]) == (225, 450)


def test_what_fails_is_said_with_what_helps(command, map_file, monkeypatch):
    from mesa_mobility.examination import Finding

    def door(subject):
        return Finding("door", "alone", {"in_time": 3}, "all 21 in time", False, "add side steps")

    monkeypatch.setattr("mesa_mobility.examination.examining.TESTS", (door,))
    outcome = command("map", "info", map_file, "--json")
    said = "door: alone: in time 3; expected all 21 in time; add side steps"
    assert f"warning: {said}" in outcome.err.splitlines()
    answer = last_line(outcome)
    assert answer["warnings"] == [said]
    assert answer["examination"]["door"] == {
        "what": "alone",
        "in_time": 3,
        "expected": "all 21 in time",
        "passed": False,
        "helps": "add side steps",
    }
