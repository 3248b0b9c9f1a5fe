"""Rooms filled on the command line."""

import json

import pytest
from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan, Gate, Room


@pytest.fixture
def plan(tmp_path, monkeypatch):
    """Two rooms of 5 m x 4 m and 3 m x 4 m with a door between them, as GeoJSON."""
    monkeypatch.chdir(tmp_path)
    one, other = box(0, 0, 5, 4), box(5.2, 0, 8.2, 4)
    FloorPlan(
        union_all([one, box(5, 1, 5.2, 2), other]),
        exits=[Exit("street", (8.2, 1), (8.2, 3))],
        gates=[Gate("door", (5.1, 1), (5.1, 2))],
        rooms=[Room("office", one, use="office"), Room("lobby", other)],
    ).write_geojson("plan.geojson")
    return "plan.geojson"


def test_a_plan_runs_with_its_rooms_filled(command, plan):
    done = command(
        "run",
        plan,
        "--seed",
        1,
        "--fill",
        "office=0.2/m2 after 2",
        "--fill",
        "lobby=3",
        "--json",
        "--out",
        "out",
    )
    assert done.status == 0, done.err
    summary = json.loads(done.out.splitlines()[-1])
    assert (summary["model"], summary["pedestrians"], summary["left_inside"]) == (
        "floor_plan",
        7,
        0,
    )
    assert summary["parameters"]["fill"] == "office=0.2/m2 after 2; lobby=3"
    rooms = summary["rooms"]
    assert (rooms["office"]["people"], rooms["lobby"]["people"]) == (4, 7)
    assert rooms["office"]["first_s"] > 2.0
    assert rooms["lobby"]["last_s"] >= rooms["office"]["last_s"]


@pytest.mark.parametrize(
    ("fill", "said"),
    [
        ("cellar=3", "there is no room 'cellar'; there are office, lobby"),
        ("office=bazaar", "there is no use 'bazaar'"),
        ("office=", "expected ROOM=LOAD"),
        ("office=4000", "room 'office': room for"),
        ("office=3 after soon", "distribution"),
    ],
)
def test_fillings_that_cannot_be_are_one_line(command, plan, fill, said):
    done = command("run", plan, "--seed", 1, "--fill", fill, "--out", "out")
    assert done.status == 2
    [line] = [each for each in done.err.splitlines() if each.strip()][-1:]
    assert said in line
    assert "Traceback" not in done.err


def test_models_without_rooms_to_fill_say_so(command):
    done = command("run", "doorway", "--seed", 1, "--fill", "5")
    assert done.status == 2
    assert "fill" in done.err
