"""Places of measured people: laid out, and refused with the person and the frame."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.errors import ResultsError
from mesa_mobility.estimation.choices.places import Places, places_of
from tests.estimation.tracks import corridor, rows_of, tracks_of, walking


def refused(rows: np.ndarray) -> str:
    with pytest.raises(ResultsError) as caught:
        places_of(tracks_of(rows), corridor(), "run.txt")
    text = str(caught.value)
    assert "\n" not in text
    assert text.startswith("run.txt: ")
    return text


def test_places_between_frames_lie_between():
    found = places_of(walking(), corridor())

    np.testing.assert_allclose(found.at(10.5)[0], [1.0 + 1.2 * 1.05, 0.8])
    assert np.isnan(found.at(60.0)).all()
    assert np.isnan(found.at(-1.0)).all()


def test_velocities_are_means_of_earlier_frames():
    rows = rows_of(walking())
    later = rows[:, 0] > 20
    rows[later, 2] += 0.3  # everybody is elsewhere afterwards
    found = places_of(tracks_of(rows), corridor())

    velocities = found.velocities(20, 0.8)

    np.testing.assert_allclose(velocities[:, 0], [1.2, 1.1, 1.2, 1.1, 1.2, 1.1])
    np.testing.assert_allclose(velocities[:, 1], 0.0, atol=1e-12)


def test_somebody_who_has_just_come_has_the_velocity_since():
    rows = rows_of(walking())
    rows = rows[(rows[:, 1] != 0) | (rows[:, 0] >= 17)]
    rows = rows[(rows[:, 1] != 1) | (rows[:, 0] >= 20)]
    found = places_of(tracks_of(rows), corridor())

    velocities = found.velocities(20, 0.8)

    np.testing.assert_allclose(velocities[0], [1.2, 0.0], atol=1e-12)
    np.testing.assert_allclose(velocities[1], 0.0)


def test_a_single_person_is_refused():
    rows = rows_of(walking())
    text = refused(rows[rows[:, 1] == 3])
    assert "only person 3 (frames 0 to 59)" in text


def test_nobody_is_refused():
    assert "nobody" in refused(rows_of(walking())[:0])


def test_centimetres_are_refused():
    rows = rows_of(walking())
    rows[:, 2:] *= 100.0
    assert re.search(r"people move at 1[12]\d m/s .* expected coordinates in metres", refused(rows))


def test_kilometres_are_refused():
    rows = rows_of(walking())
    rows[:, 2:] /= 1000.0
    assert "expected coordinates in metres" in refused(rows)


def test_a_jump_is_named_by_person_and_frames():
    rows = rows_of(walking())
    rows[(rows[:, 1] == 4) & (rows[:, 0] >= 31), 2] += 3.0
    text = refused(rows)
    assert "person 4 jumps by 3.12 m from frame 30 to frame 31" in text


def test_a_track_off_the_floor_is_named_by_person_and_frame():
    rows = rows_of(walking())
    rows[rows[:, 1] == 2, 3] += 2.0
    assert "person 2 is at (1.60, 5.00) in frame 0, off the floor" in refused(rows)


def test_a_detour_off_the_floor_is_refused_and_heads_over_a_wall_are_not():
    rows = rows_of(walking())
    rows[rows[:, 1] == 0, 3] = 0.3
    own = (rows[:, 1] == 0) & (rows[:, 0] == 30)
    rows[own, 3] = -0.45
    assert places_of(tracks_of(rows), corridor()).at(30)[0, 1] == -0.45
    rows[own, 3] = -0.55
    assert "person 0 is at (4.60, -0.55) in frame 30" in refused(rows)


def test_what_is_off_the_floor_before_and_after_is_left_out():
    rows = rows_of(walking(seconds=20.0))
    rows[:, 2] -= 4.0
    found = places_of(tracks_of(rows), corridor())

    first = np.flatnonzero(~np.isnan(found.places[0, :, 0]))
    assert found.places[0, first[0], 0] == pytest.approx(-0.48)
    assert found.places[0, first[-1], 0] == pytest.approx(20.4)


@given(st.integers(0, 40), st.floats(-3.0, 3.0), st.floats(0.4, 1.6))
def test_velocities_do_not_depend_on_where_the_axes_begin(frame, shift, seconds):
    rng = np.random.default_rng(frame)
    places = np.cumsum(rng.normal(size=(3, 41, 2)), axis=1)
    here = Places(np.arange(3), 0, 10.0, np.zeros(3, int), places)
    there = Places(np.arange(3), 7, 10.0, np.zeros(3, int), places + shift)

    np.testing.assert_allclose(
        here.velocities(frame, seconds), there.velocities(frame + 7, seconds), atol=1e-9
    )
