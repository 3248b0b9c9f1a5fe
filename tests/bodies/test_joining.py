"""One bank of several: options are numbered one map after the other, and so are poses."""

import numpy as np
import pytest

from mesa_mobility.bodies import Movements, PoseBank, bank_of_maps
from mesa_mobility.bodies.sequence import pose_sequence
from mesa_mobility.errors import MapError
from tests.bodies.conftest import make_bank


@pytest.fixture
def banks(monkeypatch):
    """A bank of two options and four poses, and one of two options and three poses."""
    of = {
        "abc": make_bank(),
        "stairs": make_bank(
            (40.0, 50.0, 60.0),
            first=1,
            heights=np.full(3, 9000, dtype=np.int16),
            metadata={
                "map_digest": "stairs",
                "pedestrian_type": "up",
                "scale": 1.0,
                "clips": [{"clip": "three"}, {"clip": "four"}],
            },
        ),
    }
    monkeypatch.setattr(PoseBank, "of", lambda digest: of[digest])
    return of


def test_options_of_the_second_map_show_its_poses(banks):
    joint = bank_of_maps([("abc", 1.0), ("stairs", 1.2)])
    assert joint.n_options == 4
    assert joint.metadata["map_digest"] == "abc"
    assert joint.strides.tolist() == [100, 100, 120, 120]
    assert joint.clips.tolist() == [0, 2, 4, 5, 7]
    assert joint.source_of(2 * 5) == ("four", 0, False)
    frames = np.arange(4)
    movements = Movements(np.array([0, 2]), np.array([1, 3]), np.ones(2))
    numbers = pose_sequence(joint, frames, movements).numbers
    own = pose_sequence(banks["abc"], frames[:2], Movements(*(each[:1] for each in movements)))
    stairs = Movements(np.array([0]), np.array([1]), np.ones(1))
    theirs = pose_sequence(banks["stairs"], frames[:2], stairs)
    assert numbers.tolist() == [*own.numbers, *(8 + theirs.numbers)]
    assert joint.pelvis_heights(numbers).tolist() == pytest.approx([0.935, 0.935, 0.9, 0.9])


def test_bodies_keep_their_size_and_take_the_strides_of_the_stairs(banks):
    child = make_bank(metadata={**banks["abc"].metadata, "scale": 0.8})
    joint = bank_of_maps([("abc", 1.0), ("stairs", 1.0)], child)
    assert joint.scale == 0.8
    assert joint.strides.tolist() == [100, 100, 125, 125]


def test_one_map_needs_no_other_bank(banks):
    assert bank_of_maps([("abc", 1.0)]) is banks["abc"]
    maps = [("abc", 1.0), ("stairs", 1.2)]
    assert bank_of_maps(maps) is bank_of_maps(maps)
    with pytest.raises(MapError, match="poses of the map stairs, expected those of the map abc"):
        bank_of_maps(maps, banks["stairs"])
