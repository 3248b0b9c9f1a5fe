import math

import pytest
from mesa_mobility.behaviors import Sideways

from mesa_mobility.errors import ModelError
from tests.fixtures.options import Ending, one_option


@pytest.mark.parametrize(
    ("point", "degrees", "seconds", "expected"),
    [
        # Ahead, to the left, back; then at half the duration, which counts twice.
        ((1.2, 0.0), 0.0, 1.5, 0.0),
        ((0.0, 0.5), 0.0, 1.5, 0.5),
        ((-0.5, 0.0), 0.0, 1.5, 0.5),
        ((0.0, -0.5), 0.0, 0.75, 1.0),
        # 1 m straight on, facing 30 degrees to the left in the end: 0.5 m to the right of that.
        ((1.0, 0.0), 30.0, 1.5, 0.5),
        # Facing 135 degrees to the left: 0.7071 m across and 0.7071 m back.
        ((1.0, 0.0), 135.0, 1.5, 1.4142136),
        ((0.0, 0.0), 90.0, 1.5, 0.0),
    ],
)
def test_metres_across_and_against_the_facing_direction(point, degrees, seconds, expected):
    option = one_option(
        Ending(
            point=point,
            heading=math.radians(degrees),
            displacement=math.hypot(*point),
            duration=seconds,
        ),
        target=(20.0, 3.0),
    )
    assert Sideways().cost(option) == pytest.approx([expected], abs=1e-6)


@pytest.mark.parametrize(("backwards", "expected"), [(0.0, 0.0), (1.0, 0.4), (3.0, 1.2)])
def test_steps_back_have_a_price_of_their_own(backwards, expected):
    option = one_option(Ending(point=(-0.4, 0.0), displacement=0.4, duration=1.5))
    assert Sideways(backwards=backwards).cost(option) == pytest.approx([expected], abs=1e-6)


@pytest.mark.parametrize("value", [-0.1, math.nan, math.inf])
def test_prices_out_of_range_are_refused_in_one_line(value):
    with pytest.raises(ModelError, match=r"^sideways: backwards .*expected 0 or more$") as caught:
        Sideways(backwards=value)
    assert "\n" not in str(caught.value)
