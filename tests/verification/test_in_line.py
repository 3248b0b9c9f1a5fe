"""The term that keeps people of the single file in line, against distances of shapely."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import LineString, Point

from mesa_mobility.verification.scenarios.tracks.oval import Oval
from mesa_mobility.verification.scenarios.tracks.single_file import InLine
from tests.fixtures.options import Ending, one_option
from tests.fixtures.records import option, options

OVAL = Oval(straight=4.0, radius=3.0, width=0.8)
# The line lies 3 m from the spine of the oval.
LINE = LineString([(-2.0, 0.0), (2.0, 0.0)]).buffer(3.0, quad_segs=4096).exterior


@given(st.floats(-6.0, 6.0), st.floats(-4.0, 4.0))
@settings(deadline=None)  # compiled at the first
def test_an_end_costs_its_metres_from_the_line(x, y):
    ending = one_option(Ending((x, y)), target=(20.0, 0.0))
    assert InLine(OVAL).cost(ending) == pytest.approx([LINE.distance(Point(x, y))], abs=1e-5)


@given(
    st.floats(-6.0, 6.0),
    st.floats(-4.0, 4.0),
    st.floats(0.0, 1.0),
    st.floats(-math.pi, math.pi),
    st.floats(0.0, 1.0),
)
def test_no_option_of_a_group_costs_less_than_its_bound(x, y, radius, angle, out):
    term = InLine(OVAL)
    least = term.bound.function(options(x, y, radius), term)
    place = x + out * radius * math.cos(angle), y + out * radius * math.sin(angle)
    own = term.kernel.function(option(*place), term)
    assert least <= own + 1e-9
    assert least >= 0.0


def test_people_in_a_jam_walk_one_behind_the_other():
    from mesa_mobility.verification.scenarios.tracks.oval import oval_model

    model = oval_model(OVAL, 30, 1, speed=1.2, spacing=0.34, clearance=0.18)
    model.terms.append(InLine(OVAL))
    squares = []
    while model.elapsed < 30.0:
        model.step()
        if model.elapsed >= 15.0:
            places = np.array([person.position for person in model.agents])
            squares.append(OVAL.unroll(places)[1] ** 2)
    # Without the term they use the room on either side, and are 0.16 m off on average.
    assert np.sqrt(np.mean(squares)) < 0.1
