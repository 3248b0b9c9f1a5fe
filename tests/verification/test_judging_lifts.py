"""Verdicts on rides in lifts made up by hand, and one ride."""

import pytest

from mesa_mobility.verification import nist
from mesa_mobility.verification.scenarios.buildings.lifts import one_rider

LONE = {"left_inside": 0, "elsewhere": 0, "arrived_s": 12.6, "expected_s": 12.5}
# Down and up in 9.5 s each, and 3 s of open doors: at least 22 s, at most 30 s.
MANY = {"left_inside": 0, "elsewhere": 0, "rides": 3, "most": 4, "between_s": [22.0, 30.0]}


@pytest.mark.parametrize(
    ("lone", "many", "passes"),
    [
        ({}, {}, True),
        ({"arrived_s": 12.1}, {}, False),
        ({"arrived_s": 12.9}, {}, False),
        ({"arrived_s": None}, {}, False),
        ({"elsewhere": 1}, {}, False),
        ({"left_inside": 1}, {}, False),
        ({}, {"rides": 4}, False),
        ({}, {"most": 5}, False),
        ({}, {"between_s": [21.9, 25.0]}, False),
        ({}, {"between_s": [25.0, 30.1]}, False),
        ({}, {"rides": 0, "most": 0, "between_s": []}, False),
    ],
)
def test_rides_take_their_time_and_lead_where_people_have_to_go(lone, many, passes):
    runs = [{**LONE, **lone}, LONE, LONE, {**MANY, **many}]
    assert nist.TESTS["nist-2.7"].judge(runs).passed is passes


@pytest.mark.parametrize(
    ("car", "goal", "seconds"),
    # The person needs less than the 3 s of open doors for 2.1 m to the car.
    [(1, 0, 3.0 + 9.5), (0, 2, 9.5 + 3.0 + 9.5)],
)
def test_one_rider_arrives_when_doors_and_speed_say(car, goal, seconds):
    figures = one_rider(1, car=car, start=1, goal=goal, speed=1.0, door_s=3.0)
    assert figures["expected_s"] == pytest.approx(seconds)
    assert seconds <= figures["arrived_s"] <= seconds + 0.3
    assert (figures["elsewhere"], figures["left_inside"], figures["overlaps"]) == (0, 0, 0)
