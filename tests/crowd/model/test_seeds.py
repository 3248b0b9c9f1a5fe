"""Seeds as pages and people give them."""

import numpy as np
import pytest

from mesa_mobility.errors import ModelError
from tests.fixtures.scenes import corridor, model_of, statues


def drawn(rng):
    return model_of(corridor(), statues(), rng=rng).rng.random(3).tolist()


@pytest.mark.parametrize("seed", ["42", " 42 ", 42.0])
def test_a_seed_may_come_as_text_or_as_a_whole_float(seed):
    assert drawn(seed) == np.random.default_rng(42).random(3).tolist()


@pytest.mark.parametrize("nothing", ["", "none", None])
def test_no_seed_is_a_random_one(nothing):
    assert drawn(nothing) != drawn(nothing)


@pytest.mark.parametrize("wrong", ["many", "-1", "1.5", -1, 1.5, "²", "9" * 50 + "x"])
def test_what_is_no_seed_is_refused_in_one_line(wrong):
    with pytest.raises(ModelError, match=r"^rng: got .*, expected a whole number from 0 on$"):
        drawn(wrong)
