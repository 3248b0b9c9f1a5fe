"""What people of a map can do, and maps that trap people, on maps made by hand."""

import numpy as np
import pytest

from mesa_mobility.errors import MapError
from mesa_mobility.mobility import abilities_of
from mesa_mobility.mobility.standing.ways_back import check_ways_back
from tests.fixtures.maps import make_map, shipped_map, stand, straight, through

LEFT, RIGHT = (straight(0.1, 45, turn=side * np.deg2rad(40.0), to=0) for side in (1, -1))
STANDER = (stand(), LEFT, RIGHT, straight(1.2, 45, to=1))


def test_turns_steps_and_stops():
    aside = straight(0.25, 45, towards=-np.pi / 2, to=0)
    walker = (straight(1.5, 45, to=1), straight(0.5, 45, to=0))
    able = abilities_of(make_map([(*STANDER, aside), walker, (straight(1.5, 45, to=1),)]))
    assert able["turn_on_the_spot_deg"] == pytest.approx([40.0, 40.0], abs=0.1)
    assert able["first_step_m"] == pytest.approx(1.2)
    assert able["side_step_m"] == pytest.approx([0.0, 0.25])
    # Standing and walking stop at once; the third cluster only by way of the second.
    assert able["clusters_that_stop_at_once"] == pytest.approx(0.667)


def test_abrupt_steps_do_not_count():
    # 1 m to the left in the last 0.3 s of 1.5 s.
    late = through([(0.0, max(0.0, k / 3.0), 0.0) for k in range(-11, 4)], to=0)
    able = abilities_of(make_map([(*STANDER, late), (straight(0.5, 45, to=0),)]))
    assert able["side_step_m"] == [0.0, 0.0]


def test_people_of_the_map_that_ships_turn_on_the_spot():
    assert min(abilities_of(shipped_map())["turn_on_the_spot_deg"]) > 40
    check_ways_back(shipped_map())


def test_a_cluster_that_never_leads_to_standing_is_refused():
    on = (straight(1.5, 45, to=2),)
    trap = make_map([STANDER, (straight(0.5, 45, to=0),), on])
    with pytest.raises(MapError, match="cluster 2 of 3 never leads to standing"):
        check_ways_back(trap)
    check_ways_back(make_map([STANDER, (straight(0.5, 45, to=0),), (straight(1.5, 45, to=1),)]))


@pytest.mark.parametrize(("turns", "side"), [((LEFT,), "right"), ((RIGHT,), "left"), ((), "left")])
def test_standers_who_cannot_turn_both_ways_are_refused(turns, side):
    walker = (straight(0.5, 45, to=0),)
    trap = make_map([(stand(), *turns, straight(1.2, 45, to=1)), walker])
    with pytest.raises(MapError, match=f"turn on the spot to the {side} by 0 degrees"):
        check_ways_back(trap)
