"""Conditions of scenes, of crowds small enough to work them out."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility.results import Trajectories
from mesa_mobility.validation.conditions import condition_of, conditions

RATE = 10


def procession() -> Trajectories:
    """For 40 s, somebody starts at x = 0 every second and walks 20 m at 1 m/s."""
    frame, person = np.meshgrid(np.arange(40 * RATE + 1), np.arange(40), indexing="ij")
    x = frame / RATE - person
    on = (x >= 0) & (x <= 20)
    return Trajectories(
        frame[on], person[on], x[on], np.ones(on.sum()), np.zeros(on.sum()), frame_rate=RATE
    )


def test_the_condition_of_a_crowd_is_that_in_its_area_and_time():
    found = condition_of(
        procession(), box(5.05, 0, 15.05, 2), ((10.05, 0.0), (10.05, 2.0)), after=20.0, until=40.0
    )
    # Ten people on 10 m x 2 m; one a second.
    assert found == pytest.approx({"density": 0.5, "speed": 1.0, "flow": 1.0})
    early = condition_of(procession(), box(15, 0, 20, 2), ((16, 0), (16, 2)), until=10.0)
    assert early == {"density": 0.0, "speed": None, "flow": None}


def test_a_condition_is_met_within_a_fifth_and_its_flow_within_an_eighth():
    measured = {"density": 2.0, "speed": 0.5, "flow": 2.0}

    def met(*runs, **ranges) -> dict:
        found = [dict(zip(measured, run, strict=True)) for run in runs]
        checks = conditions("jam", found, measured, **ranges)
        assert all(check.gates for check in checks)
        return {check.figure.removeprefix("condition of jam: "): check.met for check in checks}

    names = ["density 1/m2", "speed m/s", "flow 1/s"]
    assert met((1.61, 0.59, 2.23)) == dict.fromkeys(names, True)
    assert met((1.59, 0.61, 2.25)) == dict.fromkeys(names, False)
    assert met((2.41, 0.39, 1.75)) == dict.fromkeys(names, False)
    # The median of the seeds counts, and a seed without a value is none.
    assert met((2.0, 0.5, 2.0), (2.0, 0.5, 2.0), (9.0, 9.0, 9.0)) == dict.fromkeys(names, True)
    assert met((2.0, 0.5, 2.0), (2.0, 0.5, None))["flow 1/s"] is False
    assert met((1.0, 0.5, 2.0), density=(0.5, 2.0))["density 1/m2"] is True
