import math

import pytest
from mesa_mobility.behaviors import Stepping

from mesa_mobility.errors import ModelError
from tests.fixtures.options import Chooser, Ending, candidates, one_option


@pytest.mark.parametrize(
    ("metres", "seconds", "expected"),
    # Of 0.4 m: nearly all for the shortest step, half for half of 0.4 m.
    [
        (0.02, 0.4, 0.95),
        (0.1, 0.4, 0.75),
        (0.2, 0.4, 0.5),
        (0.2, 1.5, 0.5),
        (0.4, 0.4, 0.0),
        (0.5, 0.8, 0.0),
        (1.9, 1.5, 0.0),
    ],
)
def test_a_step_costs_what_it_is_short_of_one_that_is_worth_it(metres, seconds, expected):
    option = one_option(Ending(displacement=metres, duration=seconds), target=(20.0, 0.0))
    assert Stepping(length=0.4).cost(option) == pytest.approx([expected], abs=1e-6)


@pytest.mark.parametrize(
    ("speed", "metres", "seconds", "expected"),
    # Who wants 0.1 m/s covers 0.15 m in 1.5 s; 0.2 m/s are 0.3 m, and 0.3 m/s more than 0.4 m.
    [(0.1, 0.15, 1.5, 0.0), (0.1, 0.05, 0.4, 2 / 3), (0.2, 0.15, 0.4, 0.5), (0.3, 0.1, 0.4, 0.75)],
)
def test_slow_people_make_short_steps(speed, metres, seconds, expected):
    option = candidates(
        Chooser(
            [Ending(displacement=metres, duration=seconds)],
            target=(20.0, 0.0),
            preferred_speed=speed,
        )
    )
    assert Stepping(length=0.4).cost(option) == pytest.approx([expected], abs=1e-6)


def test_those_who_want_to_stand_have_no_step_of_their_own():
    option = candidates(
        Chooser([Ending(displacement=0.1)], target=(20.0, 0.0), preferred_speed=0.0)
    )
    assert Stepping(length=0.4).cost(option) == pytest.approx([0.75], abs=1e-6)


@pytest.mark.parametrize(
    ("neighbour", "preferred", "expected"),
    # The target is along x. People wait for somebody within 2 m on that side of them.
    [
        ((1.9, 0.0), 1.0, 0.0),
        ((0.5, 1.8), 1.0, 0.0),
        ((2.1, 0.0), 1.0, 1.0),
        ((-0.5, 0.0), 1.0, 1.0),
        (None, 1.0, 1.0),
        (None, 0.0, 0.0),
        (None, 0.1, 0.375),
    ],
)
@pytest.mark.parametrize("metres", [0.0, 0.009])
def test_standing_is_free_only_where_somebody_makes_room(metres, neighbour, preferred, expected):
    around = [] if neighbour is None else [(neighbour, (0.0, 0.0), (1.0, 0.0), 1.0)]
    option = candidates(
        Chooser(
            [Ending(displacement=metres)],
            target=(20.0, 0.0),
            preferred_speed=preferred,
            neighbours=around,
        )
    )
    assert Stepping().cost(option) == pytest.approx([expected], abs=1e-3)


@pytest.mark.parametrize(
    ("target", "facing", "expected"),
    # From facing x; the cosine between facing and target gains nothing, or so much.
    [
        ((20.0, 0.0), 0.0, 1.0),
        ((20.0, 0.0), math.pi, 1.0),
        ((0.0, 20.0), 0.0, 1.0),
        ((0.0, 20.0), math.pi / 6, 0.5),
        ((0.0, 20.0), math.pi / 2, 0.0),
        ((-20.0, 0.0), math.pi / 3, 0.5),
        ((-20.0, 0.0), math.pi, 0.0),
    ],
)
def test_turning_on_the_spot_costs_less_by_what_it_gains(target, facing, expected):
    option = one_option(Ending(heading=facing, displacement=0.0), target=target)
    assert Stepping().cost(option) == pytest.approx([expected], abs=1e-6)


@pytest.mark.parametrize("value", [0.0, -0.1, math.nan, math.inf])
def test_lengths_out_of_range_are_refused_in_one_line(value):
    with pytest.raises(ModelError, match=r"^stepping: length .*expected more than 0 m$") as caught:
        Stepping(length=value)
    assert "\n" not in str(caught.value)
