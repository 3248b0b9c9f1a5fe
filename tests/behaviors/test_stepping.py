import pytest
from mesa_mobility.behaviors import Stepping

from tests.fixtures.options import Ending, one_option


@pytest.mark.parametrize(
    ("metres", "seconds", "expected"),
    [(0.0, 0.4, 0.0), (0.009, 0.4, 0.0), (0.009, 1.5, 0.0), (0.011, 0.4, 1.0), (0.011, 1.5, 1.0),
     (1.9, 1.5, 1.0)],
)  # fmt: skip
def test_a_step_costs_the_same_however_long(metres, seconds, expected):
    option = one_option(Ending(displacement=metres, duration=seconds), target=(20.0, 0.0))
    assert Stepping().cost(option).tolist() == [expected]
