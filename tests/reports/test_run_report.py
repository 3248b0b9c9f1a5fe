"""The report of a run, from tracks made by hand."""

import re
import shlex
from dataclasses import replace
from html import unescape

import numpy as np
import pandas as pd
import pytest

from mesa_mobility import Exit, FloorPlan, Gate
from mesa_mobility.reports.run.evidence import command_of
from mesa_mobility.reports.run.pictures import _curves
from mesa_mobility.reports.run.report import write_run_report
from mesa_mobility.results import Trajectories, measure
from mesa_mobility.results.run import Run

SUMMARY = {
    "model": "doorway",
    "seed": 7,
    "preset": "default",
    "preset_sha256": "ab" * 32,
    "parameters": {"pedestrians": 3, "door_width": 1.0},
    "set": {"headway.time": "0.6"},
    "egress_s": None,
    "left_inside": 1,
    "simulated_s": 10.0,
    "stalled": True,
    "stall_reason": "every exit is closed",
    "mean_speed_mps": 0.5,
    "overlaps": 0,
    "wall_crossings": 2,
    "off_floor": 0,
    "min_distance_m": 0.4,
    "mesa_mobility": "0.1.0",
    "versions": {"numpy": "2.0"},
    "maps": {"able_bodied": {"file": "able_bodied.npz", "sha256": "cd" * 32}},
    "people": [
        {
            "type": "able_bodied",
            "people": 3,
            "preferred_mps": [1.0, 1.2, 1.4],
            "sets_off_s": [0.0, 0.0, 0.0],
        }
    ],
    "rules": {"name": "default", "terms": {"headway": 5.0}, "settings": {"headway": {"time": 0.6}}},
}


@pytest.fixture(scope="module")
def run():
    """Two people leave 10 m at 1 m/s, 2 s apart; a third one stays where they are."""
    plan = FloorPlan(
        "POLYGON ((0 0, 10 0, 10 4, 0 4, 0 0))",
        exits=[Exit("east", (10, 1), (10, 3))],
        gates=[Gate("middle", (5, 0), (5, 4))],
    )
    rows = []
    for person, (start, y) in enumerate(((4.08, 2.0), (2.08, 2.5), (1.0, 1.0))):
        for frame in range(101):
            x = start + 0.1 * frame if person < 2 else start
            rows.append((frame, person, x, y))
            if x > 10.0:
                break
    frame, person, x, y = np.array(rows).T
    tracks = Trajectories(
        frame.astype(int), person.astype(int), x, y, np.zeros(len(x)), frame_rate=10.0
    )
    return Run(tracks, plan, SUMMARY)


@pytest.fixture(scope="module")
def text(run, tmp_path_factory):
    page = tmp_path_factory.mktemp("report") / "report.html"
    write_run_report(run, measure(run.trajectories, run.plan), page)
    return page.read_text(encoding="utf-8")


def rows_of(text, caption):
    part = text.split(caption, 1)[1].split("</table>")[0]
    return [
        tuple(
            unescape(re.sub("<[^>]+>", "", cell))
            for cell in re.findall(r"<td[^>]*>(.*?)</td>", row)
        )
        for row in re.findall(r"<tr>(<td.*?)</tr>", part)
    ]


def test_the_sections_of_the_page(text):
    names = re.findall(r"<h2 id=\"[^\"]+\">\d+ ([^<]+)", text)
    assert names == [
        "Summary",
        "Plan",
        "People",
        "Assumptions",
        "Results",
        "Doors and exits",
        "Level of service",
        "Checks",
        "Definitions",
        "Versions, inputs and how to repeat the run",
        "Signatures",
    ]
    assert not re.search(r"(?:src|href)=\"(?!data:|#)", text)


def test_what_stands_against_a_run_is_said_first(text):
    summary = text.split("2 Plan</h2>")[0]
    assert "has stalled: 1 person left inside (every exit is closed)" in summary
    assert "has found steps through walls: 2." in summary
    found = dict(rows_of(text, "Main figures of this run"))
    # They cross x = 10 after 5.92 and 7.92 s, and are out in the next frames.
    assert found["time until 50 % of the people are out"] == "8.0 s"
    assert found["time until 95 % of the people are out"] == "> 10.0 s"


def test_doors_and_their_flows(text):
    # (2 - 1) / (7.92 - 5.92) persons/s through 4 m and 2 m.
    assert rows_of(text, "People and flows") == [
        ("middle", "4.00", "2", "0.9", "2.9", "0.50", "0.12"),
        ("east", "2.00", "2", "5.9", "7.9", "0.50", "0.25"),
    ]
    assert rows_of(text, "Doors and exits</caption>") == [
        ("1: middle", "door", "4.00"),
        ("2: east", "exit", "2.00"),
    ]


def test_the_longest_queue_and_its_time(text):
    # Nobody waits but the third person, who passes no door.
    rows = rows_of(text, "Queues and clogs")
    assert [row[:6] for row in rows] == [
        ("middle", "0", "-", "-", "0", "-"),
        ("east", "0", "-", "-", "0", "-"),
    ]


def test_levels_of_service_of_all_of_the_floor(text):
    rows = rows_of(text, "Levels of service for walkways")
    assert [each[0] for each in rows] == ["A", "B", "C", "D", "E", "F"]
    assert sum(float(each[2]) for each in rows) == pytest.approx(40.0, abs=0.3)
    assert rows[0][1] == "up to 0.31"
    assert rows[-1][1] == "more than 2.15"


def test_checks_and_people(text):
    rows = {each[0]: each[1:] for each in rows_of(text, "Checks of the run")}
    assert rows["overlaps of two bodies"] == ("0", "0", "pass")
    assert rows["steps through walls"] == ("2", "0", "FAIL")
    assert rows["run ended because nobody made progress"] == ("yes", "no", "FAIL")
    assert rows_of(text, "Types of people") == [("able bodied", "3", "1.00 / 1.20 / 1.40", "0.0")]


def test_versions_digests_and_the_command(text):
    assert ("numpy", "2.0") in rows_of(text, "Versions</caption>")
    assert "cd" * 32 in text
    # The door is as wide as by default, so the command need not say it.
    command = re.search(r'<pre class="command">(.*?)</pre>', text).group(1)
    said = "mesa-mobility run doorway --seed 7 --preset default --set pedestrians=3 --set"
    assert re.sub("<[^>]+>", "", command) == f"{said} headway.time=0.6"


@pytest.mark.parametrize(
    ("changes", "command"),
    [
        (
            {"stalled": False, "set": {}, "parameters": {}},
            "mesa-mobility run doorway --seed 7 --preset default --seconds 10",
        ),
        (
            {
                "model": "not here",
                "set": {},
                "parameters": {"plan": "a b.wkt", "exits": "longest", "rng": 3, "note": None},
                "behaviors": ["signs=2"],
            },
            "mesa-mobility run 'not here' --seed 7 --preset default --set 'plan=a b.wkt' "
            "--exits longest --behavior signs=2",
        ),
    ],
)
def test_the_command_that_repeats_a_run(changes, command):
    assert shlex.join(command_of({**SUMMARY, **changes})) == command


def test_what_parameters_and_behaviours_mean(text):
    assert rows_of(text, "Parameters of the model") == [
        ("pedestrians", "3", "people, all in the room at the start."),
        ("door width", "1", "width of both doors, metres."),
    ]
    [headway] = rows_of(text, "Behaviour of the people")
    does = "Keeps a distance from people ahead that grows with speed."
    assert headway == ("headway", does, "weight\N{NO-BREAK SPACE}5", "time 0.6 s")


def test_figures_by_type_of_people(run, tmp_path):
    tracks = run.trajectories
    own = replace(tracks, person_data={"type": np.array(["adult", "child", "child"])})
    page = tmp_path / "page.html"
    write_run_report(replace(run, trajectories=own), measure(own, run.plan), page)
    text = page.read_text(encoding="utf-8")
    # The adult is out after 6.0 s; one of two children is still there after 10 s.
    assert rows_of(text, "Clearing times by type of people")[0] == (
        "the whole floor",
        "6.0",
        "> 10.0",
    )
    assert rows_of(text, "People of each type who pass a door") == [
        ("middle", "1 (-)", "1 (-)"),
        ("east", "1 (-)", "1 (-)"),
    ]


def test_doors_that_few_pass_have_no_curve():
    people = {"wide": 100, "narrow": 40, "side": 4}
    table = pd.DataFrame(
        [(door, float(n), n) for door, most in people.items() for n in range(1, most + 1)],
        columns=["door", "time_s", "people"],
    )
    assert list(_curves(table)) == ["wide", "narrow"]
    many = pd.DataFrame(
        [(f"door {n}", 1.0, 20 + n) for n in range(12)], columns=["door", "time_s", "people"]
    )
    assert list(_curves(many)) == [f"door {n}" for n in range(4, 12)]


def test_a_run_in_a_building_has_levels_and_stairs(tmp_path):
    from tests.fixtures.buildings import two_storeys
    from tests.results.measures.test_storeys import PEOPLE, tracks_of

    building = two_storeys()
    run = Run(tracks_of(PEOPLE), building, {"model": "floor_plan"})
    page = tmp_path / "page.html"
    write_run_report(run, measure(run.trajectories, building), page)
    text = page.read_text(encoding="utf-8")
    assert f"A building of {len(building.levels)} levels" in text
    assert rows_of(text, "Stairs, ramps and escalators</caption>") == [
        ("south", "stairs", "1", "0", "1.20"),
        ("north", "stairs", "1", "0", "1.20"),
    ]
    places = [row[0] for row in rows_of(text, "Clearing times")]
    assert places[0] == "the whole building"
    assert {f"level {each.number}" for each in building.levels} <= set(places)
    assert "level by level from the top" in text
    # Nothing was counted, so nothing has passed.
    assert rows_of(text, "Checks of the run")[0] == (
        "overlaps of two bodies",
        "-",
        "0",
        "not counted",
    )


def test_a_run_in_a_building_has_waits_for_lifts_and_places_of_overlaps(tmp_path):
    from mesa_mobility.results.engineering.summary import figures_of_storeys
    from tests.results.measures.test_lifts import PEOPLE, three_storeys, tracks_of

    building, tracks = three_storeys(), tracks_of(PEOPLE)
    at = {"x": 1.0, "y": 2.0, "z": 3.0, "on": "level 1"}
    summary = {
        "model": "floor_plan",
        "overlaps": 3,
        "overlapping_pairs": [{"frame": 9, "first": 0, "second": 1, "distance_m": 0.2, "at": at}],
        "lifts": [{"lift": "lift", "trips": 6, "carried": 6}],
        **figures_of_storeys(tracks, building),
    }
    page = tmp_path / "page.html"
    write_run_report(Run(tracks, building, summary), measure(tracks, building), page)
    text = page.read_text(encoding="utf-8")
    assert rows_of(text, "People in lifts") == [
        ("lift", "5", "3", "1", "4", "6", "4.2", "9.0", "4.0", "2"),
        ("goods", "0", "0", "0", "0", "-", "-", "-", "-", "0"),
    ]
    found = "overlaps of bodies: 3, the first in frame 9 on level 1 at (1.00, 2.00, 3.00)."
    assert found in text
